"""Recorded interactions checked whole: every fault by its line, half-written ends, killed writers, and the schema."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.observation import Observation, sample
from fetch_pomdp.core.planners.search.planner import SparseSampling
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EventError
from fetch_pomdp.files.checking import checked, differences, relived, schema
from fetch_pomdp.files.events import event_to_json
from fetch_pomdp.files.header import FIELDS, READ, READER, STUDY_FIELDS, Header, header_from_json, header_to_json
from fetch_pomdp.files.recordings import EventLog, read_recording
from tests.files.test_recordings import SPEAKS, events, headers

SCENE = Scene.load("ambiguous")
TRIAL = Header(
    scene=SCENE, scene_name="ambiguous", planner="sparse", seed=3, target="bowl-1",
    person=4, layout="near", paradigm="fetch", order=7, begun=0.25,
)  # fmt: skip


def written(path: Path, lines: Sequence[object]) -> Path:
    text = (line if isinstance(line, str) else json.dumps(line) for line in lines)
    path.write_text("".join(line + "\n" for line in text))
    return path


def test_every_fault_of_a_file_is_named_by_line_and_field(tmp_path: Path) -> None:
    path = written(
        tmp_path / "log.jsonl",
        [
            {"scene": "ambiguous", "seed": -1, "target": "cup", "model": {"sigma": 9}, "colour": "red"},
            {"action": "grab"},
            "not JSON",
            {"action": "point", "item": "cup", "outcome": "lost", "t": "soon"},
            {"observation": {"utterance": 7, "words": [{"text": "", "start": 0, "end": 1}]}, "t": 2.0},
            {"action": "wait", "t": 5.0},
            {"observation": {"head": [0, 0, 1.6]}},
            {"action": "wait", "t": 1.5},
            {"action": "pick", "item": "bowl-1"},
            {"observation": {}},
        ],
    )
    found = [str(fault) for fault in checked(path).faults]
    beginnings = [
        "1: colour: unknown field", "1: model.sigma: found 9", "1: target: found 'cup'", "1: seed: found -1",
        "2: action: found 'grab'", "3: broken JSON", "4: outcome: found 'lost'", "4: item: found 'cup'",
        "4: t: found 'soon'", "5: observation.utterance: found 7", "5: observation.words[0].text: found ''",
        "7: observation.wrist: found none", "8: t: found 1.5 after 5", "10: found an event after the hand-over",
    ]  # fmt: skip
    assert len(found) == len(beginnings), found
    for message, beginning in zip(found, beginnings, strict=True):
        assert message.startswith(f"{path}:{beginning}"), message


def test_a_scene_that_is_none_hides_no_other_fault(tmp_path: Path) -> None:
    path = written(
        tmp_path / "log.jsonl",
        [
            {"scene": "kitchen", "seed": "x"},
            {"action": "point", "item": "mug"},
            {"action": "wait", "t": []},
        ],
    )
    found = [str(fault).removeprefix(f"{path}:") for fault in checked(path).faults]
    assert [message.split(": found")[0] for message in found] == ["1: scene", "1: seed", "3: t"]


def test_a_good_file_has_no_fault(tmp_path: Path) -> None:
    path = written(tmp_path / "log.jsonl", [{"scene": "ambiguous", "version": 1}, {"action": "wait", "t": 1}])
    found = checked(path)
    assert (found.faults, found.torn, len(found.events)) == ((), None, 1)


def test_a_file_without_lines_is_a_fault(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    path.write_text("\n\n")
    assert "found an empty file" in str(checked(path).faults[0])
    with pytest.raises(EventError, match="cannot be read"):
        checked(tmp_path / "missing.jsonl")


LOGGED: list[Event] = [Acted(Wait(), time=1.0), Observed(Observation(("löffel",)), time=2.0), Acted(Pick(2), time=2.5)]


@pytest.mark.parametrize("kept", [1, 2, 3])
def test_a_log_cut_off_anywhere_loses_the_last_event_at_most(tmp_path: Path, kept: int) -> None:
    path = tmp_path / "log.jsonl"
    with EventLog.create(path, TRIAL) as log:
        for event in LOGGED:
            log.write(event)
    lines = path.read_bytes().splitlines(keepends=True)
    whole = b"".join(lines[: 1 + kept])
    for cut in range(len(whole) - len(lines[kept]), len(whole) + 1):
        path.write_bytes(whole[:cut])
        missing = len(whole) - cut
        recording = read_recording(path)
        assert list(recording.events) == LOGGED[: kept - (missing > 1)]
        torn = 1 < missing < len(lines[kept])
        assert recording.torn == (kept + 1 if torn else None)
        assert not checked(path).faults


def test_a_half_written_header_is_no_recording(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    path.write_text('{"scene": "ambig')
    with pytest.raises(EventError, match=r"log.jsonl:1: broken JSON"):
        read_recording(path)


def test_a_broken_line_that_was_ended_is_a_fault(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    path.write_text('{"scene": "ambiguous"}\n{"action": "wa\n')
    with pytest.raises(EventError, match=r"log.jsonl:2: broken JSON"):
        read_recording(path)


WRITER = """
import sys
from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.recordings import EventLog
log = EventLog.create(sys.argv[1], Header(scene=Scene.load("ambiguous"), scene_name="ambiguous"))
for number in range(10**9):
    log.write(Acted(Wait(), time=float(number)))
    print(number, flush=True)
"""


def test_a_killed_writer_loses_at_most_the_event_being_written(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    writer = subprocess.Popen([sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE, text=True)
    assert writer.stdout is not None
    for _ in range(300):
        acknowledged = int(writer.stdout.readline())
    writer.send_signal(signal.SIGKILL)
    acknowledged = max([acknowledged, *map(int, writer.stdout.read().split("\n")[:-1])])
    writer.wait()
    times = [event.time for event in read_recording(path).events]
    assert times == list(map(float, range(len(times))))
    assert len(times) - (acknowledged + 1) in {0, 1}, "at most an event that was written but not yet told of"


def lived(path: Path, seed: int) -> tuple[list[np.ndarray[Any, Any]], Agent]:
    """Log a short interaction as it is lived, and return the belief after each event."""
    agent = Agent("ambiguous", SparseSampling(), seed=seed)
    rng, beliefs = np.random.default_rng(seed), []
    header = Header(scene=agent.scene, scene_name="ambiguous", planner="sparse", seed=seed)
    with EventLog.create(path, header) as log:
        for _ in range(5):
            action = agent.decide().action
            happened: list[Event] = [Acted(action)]
            if not isinstance(action, Pick):
                happened.append(Observed(sample(3, agent.asked, agent.problem, SPEAKS, rng)))
            for event in happened:
                agent.take(event)
                log.write(event)
                beliefs.append(agent.belief)
            if isinstance(action, Pick):
                break
    return beliefs, agent


def test_a_log_lived_through_again_gives_the_same_beliefs_and_decisions(tmp_path: Path) -> None:
    acted = 0
    for seed in range(6):
        path = tmp_path / f"{seed}.jsonl"
        beliefs, agent = lived(path, seed)
        steps = list(relived(read_recording(path)))
        for step, belief in zip(steps, beliefs, strict=True):
            assert np.array_equal(step.belief, belief), "bit by bit"
            if isinstance(step.event, Acted):
                assert step.decided == step.event.action
                acted += 1
        assert steps[-1].asked == agent.asked
        assert not list(differences(read_recording(path)))
    assert acted > 12


def test_what_the_person_gave_back_is_no_decision(tmp_path: Path) -> None:
    """A robot that picks what it holds likeliest and never asks; a return between is the person's."""
    path = written(
        tmp_path / "log.jsonl",
        [
            {"scene": "ambiguous", "planner": {"name": "threshold", "pick": 0.4}, "seed": 3},
            {"action": "wait", "t": 0.0},
            {"observation": {"utterance": "green marker"}, "t": 1.0},
            {"action": "pick", "item": "marker-1", "t": 3.0},
            {"action": "pick", "item": "marker-1", "outcome": "returned", "t": 4.0},
            {"observation": {"utterance": "no"}, "t": 4.0},
            {"action": "pick", "item": "marker-2", "t": 6.0},
            {"observation": {"utterance": "the bowl"}, "t": 8.0, "anew": True},
            {"action": "wait", "t": 8.0},
        ],
    )
    assert checked(path).faults == ()
    steps = list(relived(read_recording(path)))
    decided = [step.decided for step in steps if isinstance(step.event, Acted)]
    assert decided[2] is None
    assert None not in decided[:2] + decided[3:]
    assert [step.asked for step in steps] == [None, None, None, 2, 2, 2, None, None]
    assert steps[6].belief == pytest.approx(Agent("ambiguous").posterior.updated(
        Observation(("the", "bowl")), None, Agent("ambiguous").problem).probabilities)  # fmt: skip


def test_an_action_that_its_planner_would_not_take_is_named(tmp_path: Path) -> None:
    lines = [{"scene": "ambiguous", "planner": "paper-never"}, {"action": "point", "item": "bowl-1"}]
    path = written(tmp_path / "log.jsonl", lines)
    (found,) = differences(read_recording(path))
    assert str(found) == (
        f"{path}:2: action: found point bowl-1, expected wait, as the recorded planner decides with the recorded seed"
    )


def test_a_trial_of_a_study_survives_a_round_trip() -> None:
    assert header_from_json(json.loads(json.dumps(header_to_json(TRIAL)))) == TRIAL
    first = {name: value for name, value in header_to_json(TRIAL).items() if name not in STUDY_FIELDS}
    assert header_from_json({**first, "version": 1}).target == "bowl-1"
    with pytest.raises(EventError, match="person: unknown field"):
        header_from_json({**first, "version": 1, "person": 1})


@pytest.mark.parametrize(
    ("field", "value"),
    [("person", -1), ("person", 1.5), ("order", True), ("layout", ""), ("paradigm", 3), ("begun", float("nan"))],
)
def test_a_trial_that_is_none(field: str, value: object) -> None:
    with pytest.raises(EventError, match=f"^{field}: found"):
        header_from_json({"scene": "ambiguous", field: value})


def test_what_was_said_is_kept_beside_what_was_heard() -> None:
    event = Observed(Observation(("hand",)), (), 1.0, ("yes",))
    line = event_to_json(event, SCENE)
    assert line["observation"]["spoken"] == "yes"
    agent, deaf = Agent("ambiguous"), Agent("ambiguous")
    agent.take(event)
    deaf.take(Observed(Observation(("hand",))))
    assert np.array_equal(agent.belief, deaf.belief), "no belief reads it"


# The schema says what the reader takes.


def test_the_schema_names_the_fields_of_the_reader() -> None:
    kinds = schema()["$defs"]
    assert set(kinds["header"]["properties"]) == {*FIELDS, *STUDY_FIELDS, READER}
    assert tuple(kinds["header"]["properties"]["version"]["enum"]) == READ
    line = event_to_json(Observed(Observation(("a",)), (), 1.0, ("b",), early=True, anew=True), SCENE)
    assert set(line) == set(kinds["observed"]["properties"])
    assert kinds["acted"]["properties"]["outcome"]["enum"] == [outcome.value for outcome in Outcome]
    assert set(line["observation"]) <= set(kinds["observed"]["properties"]["observation"]["properties"])


@given(event=events)
@settings(max_examples=60)
def test_every_event_that_is_written_fits_the_schema(event: Event) -> None:
    validator = jsonschema.Draft202012Validator(schema())
    assert validator.is_valid(json.loads(json.dumps(event_to_json(event, SCENE))))


@pytest.mark.parametrize("header", [*headers, TRIAL])
def test_every_header_that_is_written_fits_the_schema(header: Header) -> None:
    validator = jsonschema.Draft202012Validator(schema())
    assert validator.is_valid(json.loads(json.dumps(header_to_json(header))))


VALID: list[dict[str, Any]] = [
    {"scene": "ambiguous", "version": 3, "seed": 1, "person": 1, "layout": "near"},
    {"action": "point", "item": "bowl-1", "outcome": "done", "t": 1.0, "passes": 3},
    {"observation": {"utterance": "yes", "head": [0, 0, 1.6], "wrist": [0, 1, 1], "spoken": "yes"}, "t": 2.0,
     "early": True, "anew": False},
]  # fmt: skip
values = st.sampled_from([None, 0, -1, 1.5, "", "wait", "bowl-1", True, [], {}, [0, 0, 1], {"id": "x"}])


@given(line=st.sampled_from(range(3)), data=st.data())
@settings(max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_what_the_schema_refuses_the_reader_refuses(tmp_path: Path, line: int, data: st.DataObject) -> None:
    validator = jsonschema.Draft202012Validator(schema())
    changed = json.loads(json.dumps(VALID))
    fields = changed[line]["observation"] if line == 2 and data.draw(st.booleans()) else changed[line]
    fields[data.draw(st.sampled_from([*fields, "colour"]))] = data.draw(values)
    if not validator.is_valid(changed[line]):
        assert checked(written(tmp_path / "log.jsonl", changed)).faults, changed[line]


def test_a_point_is_about_an_item_by_the_schema_too() -> None:
    validator = jsonschema.Draft202012Validator(schema())
    assert not validator.is_valid({"action": "point"})
    assert not validator.is_valid({"action": "wait", "item": "bowl-1"})
    assert validator.is_valid(event_to_json(Acted(Point(0)), SCENE))
