"""Recorded interactions: written and read back, replayed, and refused where they cannot be one."""

from __future__ import annotations

import dataclasses
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.observation import Observation, sample
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.planners.baselines.searches import PaperNeverAsk
from fetch_pomdp.core.planners.catalogue import DEFAULT
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.ports import Outcome, Word
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.core.turns import StepChances
from fetch_pomdp.errors import BeliefError, EventError, InputError
from fetch_pomdp.files.events import event_from_json, event_to_json
from fetch_pomdp.files.header import Header, header_from_json, header_to_json
from fetch_pomdp.files.recordings import EventLog, read_recording

SCENE = Scene.load("ambiguous")
SPEAKS = StepChances(words=0.95, points=0.1, desired=0.9, other=0.9)
TABLE = Scene(
    items=(
        Item(id="Tasse à thé", position=(0.0, 2.0, 0.75), vocabulary=("cup",)),
        Item(id="pot", position=(0.5, 2.0, 0.75), vocabulary=("pot", "tea")),
    ),
    head=(0.1, 0.0, 1.7),
)

# Round trips.

times = st.none() | st.integers(0, 100_000).map(lambda ms: ms / 1000)
items = st.integers(0, 5)
actions: st.SearchStrategy[Action] = st.just(Wait()) | st.builds(Point, items) | st.builds(Pick, items)
texts = st.lists(st.sampled_from(["marker", "yes", "löffel", "it's", "left", "7"]), max_size=4).map(tuple)
coordinates = st.floats(-10, 10)
points = st.tuples(coordinates, coordinates, coordinates)
rays = st.none() | st.tuples(points, points).filter(
    lambda pair: sum(abs(a - b) for a, b in zip(*pair, strict=True)) > 0.1
).map(lambda pair: Ray(*pair))
words = st.lists(
    st.builds(Word, st.sampled_from(["marker", "uh"]), coordinates, coordinates, st.floats(0, 1)), max_size=3
)
uncertain = st.lists(st.tuples(texts, st.floats(0.01, 1)), min_size=2, max_size=4, unique_by=lambda one: one[0]).map(
    lambda readings: Observation(
        readings[0][0],
        None,
        tuple(Alternative(said, weight / sum(one[1] for one in readings)) for said, weight in readings),
    )
)
events: st.SearchStrategy[Event] = st.builds(
    Observed,
    st.builds(Observation, texts, rays) | uncertain,
    words.map(tuple),
    times,
    early=st.booleans(),
    anew=st.booleans(),
) | st.builds(Acted, actions, st.sampled_from(Outcome), st.none(), times, st.none() | st.integers(1, 99))


@given(event=events)
def test_events_survive_a_round_trip(event: Event) -> None:
    line = json.dumps(event_to_json(event, SCENE))
    found = event_from_json(json.loads(line), SCENE)
    if isinstance(event, Observed) and event.words and not (event.observation.words or event.observation.alternatives):
        assert isinstance(found, Observed)
        assert found.words == event.words, "an utterance of null is that of its words"
    else:
        assert found == event


def test_a_reason_is_kept_with_a_failure() -> None:
    event = Acted(Pick(2), Outcome.FAILED, time=2.0, reason="blocked by bowl-1")
    line = event_to_json(event, SCENE)
    assert line == {
        "action": "pick", "item": "marker-1", "outcome": "failed", "reason": "blocked by bowl-1", "t": 2.0,
    }  # fmt: skip
    assert event_from_json(line, SCENE) == event


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ({"action": "wait", "reason": "tired"}, "reason: found 'tired', expected none: this action did not fail"),
        ({"action": "pick", "item": "bowl-1", "outcome": "failed", "reason": 3}, "reason: found 3, expected text"),
    ],
)
def test_a_reason_that_is_none_is_refused(line: dict[str, object], message: str) -> None:
    with pytest.raises(EventError, match=message):
        event_from_json(line, SCENE)


headers = [
    Header(scene=SCENE, scene_name="ambiguous"),
    Header(scene=TABLE, planner="sparse", parameters={"depth": 3}, seed=7, target="pot"),
    Header(scene=TABLE, reader="table:german"),
    Header(scene=TABLE, reader="openai:model@https://example.org/v1"),
    Header(
        scene=dataclasses.replace(
            TABLE, model=Model(sigma=0.2, gesture_likelihood="exact"), rewards=Rewards(wait=-0.5, point=-5.0)
        )
    ),
]


@pytest.mark.parametrize("header", headers)
def test_headers_survive_a_round_trip(header: Header) -> None:
    assert header_from_json(json.loads(json.dumps(header_to_json(header)))) == header


def test_a_header_says_only_what_is_not_by_default() -> None:
    header = Header(scene=dataclasses.replace(SCENE, model=Model(sigma=0.2)), scene_name="ambiguous")
    assert header_to_json(header) == {
        "scene": "ambiguous", "version": 4, "model": {"sigma": 0.2}, "planner": DEFAULT, "seed": 0,
    }  # fmt: skip


class CountingStream(io.StringIO):
    flushed = 0

    def flush(self) -> None:
        self.flushed += 1


def test_every_line_of_a_log_is_flushed() -> None:
    stream = CountingStream()
    log = EventLog.begin(stream, headers[0])
    log.write(Acted(Wait()))
    log.write(Acted(Pick(2), Outcome.FAILED, None, 1.23456))
    assert stream.flushed == 3
    assert [json.loads(line) for line in stream.getvalue().splitlines()][1:] == [
        {"action": "wait"},
        {"action": "pick", "item": "marker-1", "outcome": "failed", "t": 1.235},
    ]


def test_a_log_on_disk_is_read_back(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    log = EventLog.create(path, headers[1])
    written: list[Event] = [
        Acted(Wait(), time=0.0),
        Observed(Observation(("the", "tea", "löffel"), Ray((0.0, 0.0, 1.6), (0.0, 1.0, 1.3))), (), 1.0),
        Acted(Point(0), Outcome.FAILED),
        Acted(Pick(1)),
    ]
    for event in written:
        log.write(event)
    recording = read_recording(path)
    assert recording.header == headers[1]
    assert list(recording.events) == written
    assert recording.over
    with pytest.raises(EventError, match="found an existing file, expected a new one"):
        EventLog.create(path, headers[1])
    with pytest.raises(EventError, match=r"cannot be written: .*, expected a folder for it"):
        EventLog.create(tmp_path / "none" / "log.jsonl", headers[1])


def test_a_replay_is_the_life_of_the_agent(tmp_path: Path) -> None:
    lines: list[dict[str, Any]] = [
        {"scene": "ambiguous", "planner": {"name": "sparse", "depth": 3, "width": 2}, "seed": 5},
        {"action": "wait"},
        {"observation": {"utterance": "The marker!"}},
        {"action": "point", "item": "marker-1"},
        {"observation": {"utterance": "no", "head": [0, 0, 1.6], "wrist": [0, 1, 1.3]}},
        {"action": "pick", "item": "marker-2", "outcome": "stopped"},
        {"observation": {"utterance": None}},
    ]
    recording = read_recording(written(tmp_path, lines))
    agent = recording.header.agent()
    assert agent.planner == SparseSampling(3, 2)
    assert agent.seed == 5
    assert list(recording.replay(agent)) == list(recording.events)
    live = Agent("ambiguous", SparseSampling(3, 2), seed=5)
    live.did(Wait())
    live.observe("the marker")
    live.did(Point(2))
    live.observe("no", head=(0, 0, 1.6), wrist=(0, 1, 1.3))
    live.did(Point(3))  # what a pick that was stopped counts as
    live.observe()
    assert agent.belief == pytest.approx(live.belief)
    assert agent.asked == live.asked == 3
    assert agent.decide().action == live.decide().action
    assert agent.decide().wait == live.decide().wait
    assert not recording.over


@pytest.mark.slow
def test_decisions_under_a_budget_are_repeated_from_their_log(tmp_path: Path) -> None:
    """The clock decided how many passes there were; the log says how many, and they give the same values."""
    refined = 0
    for seed in range(8):
        path = tmp_path / f"log-{seed}.jsonl"
        decided = logged(path, Agent("ambiguous", FittedValue(budget_ms=30.0), seed=seed))
        refined += sum((decision.passes or 0) > 1 for decision in decided)
        recording = read_recording(path)
        agent = recording.header.agent()
        earlier = iter(decided)
        for event in recording.events:
            if isinstance(event, Acted):
                again, then = agent.decide(passes=event.passes), next(earlier)
                assert (again.action, again.wait) == (then.action, then.wait)
            agent.take(event)
    assert refined


def logged(path: Path, agent: Agent) -> list[Decision]:
    """Let an agent do as it decides with a person who wants the fourth item, log it, and return its decisions."""
    header = Header(scene=agent.scene, scene_name="ambiguous", parameters={"budget_ms": 30.0}, seed=agent.seed)
    decided: list[Decision] = []
    rng = np.random.default_rng(agent.seed)
    with EventLog.create(path, header) as log:
        for _ in range(8):
            decision = agent.decide()
            decided.append(decision)
            action = Wait() if isinstance(decision.action, Pick) else decision.action
            for event in (Acted(action, passes=decision.passes), None):
                happened = event or Observed(sample(3, agent.asked, agent.problem, SPEAKS, rng))
                agent.take(happened)
                log.write(happened)
    return decided


def test_an_impossible_event_is_named_by_its_line(tmp_path: Path) -> None:
    lines = [
        {"scene": "ambiguous", "model": {"p_truth": 1.0}},
        {"action": "point", "item": "bowl-1"},
        {"observation": {"utterance": "yes"}},
        {"observation": {"utterance": "no"}},
    ]
    path = written(tmp_path, lines)
    recording = read_recording(path)
    with pytest.raises(BeliefError) as caught:
        list(recording.replay(recording.header.agent()))
    assert str(caught.value).startswith(f"{path}:4: observation: found")
    assert "bowl-1" in str(caught.value)


def test_what_is_given_replaces_the_recorded_planner() -> None:
    header = headers[1]  # sparse, depth 3, seed 7
    assert header.agent().planner == SparseSampling(3)
    assert header.agent(width=4, depth=None).planner == SparseSampling(3, 4)
    assert header.agent(planner="paper-never").planner == PaperNeverAsk(), (
        "another planner's parameters are not its own"
    )
    assert header.agent(planner="exact", depth=2).planner == ExactAnswers(2)
    assert header.agent(seed=0).seed == 0
    assert header.agent().seed == 7


def test_words_speak_where_there_is_no_utterance() -> None:
    timed = [{"text": "Marker", "start": 0, "end": 0.5}, {"text": "please", "start": 0.5, "end": 1, "posterior": 0.4}]
    found = event_from_json({"observation": {"words": timed}, "t": 1}, SCENE)
    assert found == Observed(
        Observation(("marker", "please")), (Word("Marker", 0.0, 0.5), Word("please", 0.5, 1.0, 0.4)), 1.0
    )
    both = event_from_json({"observation": {"utterance": "bowl", "words": timed}}, SCENE)
    assert isinstance(both, Observed)
    assert both.observation.words == ("bowl",)


# What cannot be a recording.


def written(tmp_path: Path, lines: Sequence[object]) -> Path:
    path = tmp_path / "events.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return path


ONE_ITEM = {"id": "cup", "position": [0, 1, 0], "vocabulary": ["cup"]}


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "scene: found no such field"),
        ({"scene": "ambigous"}, "scene: found 'ambigous', expected one of ambiguous, unambiguous, or an object"),
        ({"scene": "table.toml"}, "scene: found 'table.toml', expected one of"),
        ({"scene": 3}, "scene: found 3, expected a table of named fields"),
        ({"scene": {"head": [0, 0, 1]}}, "scene.items: found no such field"),
        ({"scene": {"head": [0, 0, 1], "items": []}}, "scene.items: found no items"),
        ({"scene": {"head": [0, 0, 1], "items": [ONE_ITEM], "model": {}}}, "scene.model: unknown field"),
        ({"scene": {"head": [0, 0, float("nan")], "items": [ONE_ITEM]}}, "scene.head: found nan"),
        (
            {"scene": {"head": [0, 0, 1], "items": [ONE_ITEM, ONE_ITEM]}},
            "scene.items[1].id: found 'cup', which items[0]",
        ),
        ({"scene": {"head": [0, 0, 1], "items": [{**ONE_ITEM, "id": "\ud800"}]}}, "scene.items[0].id: found '\\ud800'"),
        (
            {"scene": {"head": [0, 0, 1], "items": [{**ONE_ITEM, "vocabulary": []}]}},
            "scene.items[0].vocabulary: found []",
        ),
        ({"scene": "ambiguous", "version": 5}, "version: found 5, expected one of 1, 2, 3, 4"),
        ({"scene": "ambiguous", "version": True}, "version: found True, expected one of 1, 2, 3, 4"),
        ({"scene": "ambiguous", "version": None}, "version: found None, expected one of 1, 2, 3, 4"),
        ({"scene": "ambiguous", "model": {"sigma": -1}}, "model.sigma: found -1, expected an angle above 0"),
        ({"scene": "ambiguous", "model": {"sigma": float("inf")}}, "model.sigma: found inf"),
        ({"scene": "ambiguous", "model": {"sgma": 1}}, "model.sgma: unknown parameter"),
        ({"scene": "ambiguous", "model": [1]}, "model: found [1], expected a table"),
        ({"scene": "ambiguous", "rewards": {"wait": 1}}, "rewards.wait: found 1"),
        (
            {"scene": "ambiguous", "planner": "exakt"},
            "planner: found 'exakt', expected one of fitted, exact, sparse, threshold, never, always",
        ),
        ({"scene": "ambiguous", "planner": {"name": "exact", "dept": 2}}, "planner.dept: unknown parameter of planner"),
        ({"scene": "ambiguous", "planner": {"name": "exact", "depth": 0}}, "planner.depth: found 0"),
        ({"scene": "ambiguous", "planner": {"name": 3}}, "planner: found 3, expected a planner's name"),
        ({"scene": "ambiguous", "planner": None}, "planner: found None"),
        ({"scene": "ambiguous", "seed": -1}, "seed: found -1, expected a whole number from 0"),
        ({"scene": "ambiguous", "seed": 1.0}, "seed: found 1.0"),
        ({"scene": "ambiguous", "seed": 2**63}, "seed: found 9223372036854775808"),
        ({"scene": "ambiguous", "target": "cup"}, "target: found 'cup', expected one of bowl-1, bowl-2"),
        ({"scene": "ambiguous", "target": 0}, "target: found 0, expected the id of an item"),
        ({"scene": "ambiguous", "sead": 1}, "sead: unknown field, expected one of scene, model"),
        ({"scene": "ambiguous", "version": 3, "reader": "table"}, "reader: unknown field"),
        ({"scene": "ambiguous", "reader": "table:klingon"}, "reader: found 'table:klingon', expected words, table"),
        ({"scene": "ambiguous", "reader": 1}, "reader: found 1, expected a reader's name"),
    ],
)
def test_headers_that_are_none(tmp_path: Path, fields: dict[str, Any], message: str) -> None:
    path = written(tmp_path, [fields])
    with pytest.raises(InputError) as caught:
        read_recording(path)
    assert str(caught.value).startswith(f"{path}:1: {message}")
    assert "expected" in str(caught.value)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "observation: found no such field"),
        ({"t": 1}, "observation: found no such field"),
        (
            {"action": "wait", "observation": {}},
            "action: found an action and an observation, expected one line for each",
        ),
        ({"action": "grab"}, "action: found 'grab', expected one of wait, point, pick"),
        ({"action": None}, "action: found None"),
        ({"action": ["wait"]}, "action: found ['wait']"),
        ({"action": "wait", "item": "bowl-1"}, "item: found 'bowl-1', expected none: a wait is about no item"),
        ({"action": "point"}, "item: found no such field"),
        ({"action": "point", "item": "cup"}, "item: found 'cup', expected one of bowl-1"),
        ({"action": "pick", "item": 0}, "item: found 0, expected the id of an item"),
        (
            {"action": "pick", "item": "bowl-1", "outcome": "lost"},
            "outcome: found 'lost', expected one of done, failed, stopped, returned",
        ),
        ({"action": "pick", "item": "bowl-1", "outcome": None}, "outcome: found None"),
        ({"action": "wait", "passes": 0}, "passes: found 0, expected a whole number from 1"),
        ({"action": "wait", "t": "now"}, "t: found 'now', expected a time in seconds"),
        ({"action": "wait", "t": float("nan")}, "t: found nan"),
        ({"action": "wait", "utterance": "x"}, "utterance: unknown field"),
        ({"observation": None}, "observation: found None, expected a table"),
        ({"observation": {"utterence": "x"}}, "observation.utterence: unknown field"),
        ({"observation": {"utterance": 3}}, "observation.utterance: found 3, expected text or null"),
        ({"observation": {"head": [0, 0, 1]}}, "observation.wrist: found none, expected head and wrist, or neither"),
        ({"observation": {"wrist": [0, 0, 1]}}, "observation.head: found none"),
        ({"observation": {"head": [0, 0, 1], "wrist": [0, 0, 1]}}, "observation.wrist: found the position of the head"),
        ({"observation": {"head": [0, 0, 1], "wrist": [0, float("nan"), 1]}}, "observation.wrist: found nan"),
        ({"observation": {"head": [0, 0], "wrist": [0, 1, 1]}}, "observation.head: found [0, 0]"),
        ({"observation": {"words": "marker"}}, "observation.words: found 'marker', expected a list of words"),
        ({"observation": {"words": [3]}}, "observation.words[0]: found 3"),
        ({"observation": {"words": [{"text": "a", "start": 0}]}}, "observation.words[0].end: found no such field"),
        ({"observation": {"words": [{"text": "", "start": 0, "end": 1}]}}, "observation.words[0].text: found ''"),
        (
            {"observation": {"words": [{"text": "a", "start": 0, "end": 1, "posterior": 2}]}},
            "observation.words[0].posterior: found 2, expected a probability",
        ),
        (
            {"observation": {"utterance": "no", "read": [0, 0]}},
            "observation.read: found [0, 0], expected a list for each of 1",
        ),
        (
            {"observation": {"utterance": "no", "read": [[0]]}},
            "observation.read[0]: found [0], expected a number for each",
        ),
        (
            {"observation": {"utterance": "no", "read": [[0, 0, 0, "x", 0, 0]]}},
            "observation.read[0]: found 'x', expected a log-likelihood",
        ),
        ({"observation": {"alternatives": "no"}}, "observation.alternatives: found 'no', expected a list"),
        (
            {"observation": {"utterance": "no", "alternatives": [{"utterance": "no", "weight": 0}]}},
            "observation.alternatives[0].weight: found 0",
        ),
        (
            {"observation": {"utterance": "no", "alternatives": [{"utterance": "no", "weight": 0.5}]}},
            "observation.alternatives: found weights that sum to 0.5, expected 1",
        ),
        (
            {"observation": {"alternatives": [{"utterance": "no", "weight": 1}]}},
            "observation.alternatives: found none with (), expected the words among them",
        ),
        ({"observation": {}, "time": 3}, "time: unknown field"),
        ({"observation": {}, "early": 1}, "early: found 1, expected true or false"),
        ({"observation": {}, "anew": "yes"}, "anew: found 'yes', expected true or false"),
        ({"action": "wait", "anew": True}, "anew: unknown field"),
        ({"observation": {}, "anew": True}, "anew: found true, expected a pick that was done before another request"),
        (
            {"action": "pick", "item": "bowl-1", "outcome": "returned"},
            "outcome: found 'returned', expected the same pick, done, before it",
        ),
        ({"action": "wait", "outcome": "returned"}, "outcome: found 'returned', expected the same pick, done, before"),
    ],
)
def test_events_that_are_none(tmp_path: Path, fields: dict[str, Any], message: str) -> None:
    path = written(tmp_path, [{"scene": "ambiguous"}, {"action": "wait"}, fields])
    with pytest.raises(InputError) as caught:
        read_recording(path)
    assert str(caught.value).startswith(f"{path}:3: {message}")
    assert "expected" in str(caught.value)


HANDED: list[dict[str, Any]] = [{"scene": "ambiguous"}, {"action": "pick", "item": "bowl-1"}]
RETURNED: dict[str, Any] = {"action": "pick", "item": "bowl-1", "outcome": "returned"}
ANEW: dict[str, Any] = {"observation": {"utterance": "the marker"}, "anew": True}


@pytest.mark.parametrize(
    "following",
    [
        {"observation": {"utterance": "no"}},
        {"observation": {"utterance": "no"}, "anew": False},
        {"observation": {"utterance": "no"}, "early": True},
        {"action": "wait"},
        {"action": "point", "item": "bowl-1", "outcome": "returned"},
        {"action": "pick", "item": "bowl-1"},
        {"action": "pick", "item": "bowl-1", "outcome": "stopped"},
        {"action": "pick", "item": "bowl-2", "outcome": "returned"},
        {"action": "wait", "outcome": "returned"},
    ],
)
def test_only_its_return_and_another_request_follow_a_pick_that_was_done(
    tmp_path: Path, following: dict[str, Any]
) -> None:
    path = written(tmp_path, [*HANDED, following])
    with pytest.raises(EventError) as caught:
        read_recording(path)
    assert str(caught.value) == (
        f"{path}:3: found an event after the hand-over, expected the end, its return, or a request anew"
    )
    again = written(tmp_path, [*HANDED, RETURNED, {"action": "wait"}, *HANDED[1:], ANEW, *HANDED[1:], following])
    with pytest.raises(EventError, match=r"events.jsonl:8: found an event after the hand-over"):
        read_recording(again)
    if following.get("outcome") != "returned":
        refused: dict[str, Any] = {"action": "pick", "item": "bowl-1", "outcome": "failed"}
        assert len(read_recording(written(tmp_path, [HANDED[0], refused, following])).events) == 2


@pytest.mark.parametrize("version", [1, 2])
def test_older_versions_end_with_the_first_hand_over_and_are_read(tmp_path: Path, version: int) -> None:
    recording = read_recording(written(tmp_path, [{**HANDED[0], "version": version}, HANDED[1]]))
    assert recording.over
    assert recording.events == (Acted(Pick(0)),)


def test_a_return_and_another_request_may_follow_a_pick_that_was_done(tmp_path: Path) -> None:
    lines = [*HANDED, RETURNED, {"observation": {"utterance": "no"}}]
    recording = read_recording(written(tmp_path, lines))
    assert [event.outcome for event in recording.events if isinstance(event, Acted)] == [Outcome.DONE, Outcome.RETURNED]
    assert not recording.over, "it goes on"
    both = read_recording(written(tmp_path, [*HANDED, ANEW, *HANDED[1:]]))
    assert both.over
    assert [event.anew for event in both.events if isinstance(event, Observed)] == [True]
    assert not read_recording(written(tmp_path, [*HANDED, ANEW])).over


@pytest.mark.parametrize("following", [RETURNED, ANEW])
def test_what_follows_a_hand_over_comes_once(tmp_path: Path, following: dict[str, Any]) -> None:
    path = written(tmp_path, [*HANDED, following, following])
    field = "outcome" if following is RETURNED else "anew"
    with pytest.raises(EventError, match=rf"events.jsonl:4: {field}: found"):
        read_recording(path)


def test_a_replay_takes_back_and_begins_anew(tmp_path: Path) -> None:
    """After each event, beside an agent that is told by hand what it came to."""
    lines = [
        {"scene": "ambiguous", "model": {"turns": {}}},
        {"observation": {"utterance": "marker"}},
        {"action": "pick", "item": "marker-1"},
        {"action": "pick", "item": "marker-1", "outcome": "returned"},
        {"observation": {"utterance": "no"}},
        {"action": "pick", "item": "marker-2"},
        {"observation": {"utterance": "the bowl"}, "anew": True},
        {"action": "point", "item": "bowl-2"},
    ]
    recording = read_recording(written(tmp_path, lines))
    agent = recording.header.agent()
    first, second = (Agent("ambiguous", model={"turns": {}}) for _ in range(2))
    first.observe("marker")
    first.did(Point(2))
    first.observe("no")
    second.observe("the bowl")
    told = list[tuple[int | None, int | None]]()
    for number, _ in enumerate(recording.replay(agent), start=2):
        told.append((agent.asked, agent.handed))
        if number == 5:
            assert agent.belief == pytest.approx(first.belief)
            assert agent.phase == first.phase
        if number == 7:
            assert agent.belief == pytest.approx(second.belief)
            assert agent.phase == second.phase
    assert told == [(None, None), (None, 2), (2, None), (2, None), (2, 3), (None, None), (1, None)]


def test_an_empty_file(tmp_path: Path) -> None:
    path = written(tmp_path, [])
    with pytest.raises(EventError, match="found an empty file, expected a first line with the scene"):
        read_recording(path)


def test_a_file_with_a_header_alone(tmp_path: Path) -> None:
    recording = read_recording(written(tmp_path, [{"scene": "unambiguous"}]))
    assert recording.events == ()
    assert recording.header.agent().belief == pytest.approx([1 / 6] * 6)


def test_a_log_is_resumed_after_a_kill_without_the_line_cut_short(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    first = Observed(Observation(("marker",)), time=1.0)
    with EventLog.create(path, Header(scene=Scene.load("ambiguous"), scene_name="ambiguous")) as log:
        log.write(first)
    with path.open("ab") as file:
        file.write(b'{"action": "po')
    recording, resumed = EventLog.resume(path)
    assert recording.events == (first,)
    with resumed:
        resumed.write(Acted(Point(2), time=3.0))
    assert [event.time for event in read_recording(path).events] == [1.0, 3.0]
