"""The commands on logs, and the fit of a model to them, as a user calls them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.interaction import Timing, interact
from fetch_pomdp.core.planners.thresholds import Threshold
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.models import with_model
from fetch_pomdp.files.recordings import EventLog
from tests.cli.conftest import ASKED, Run
from tests.core.staged import Arm, Ears
from tests.study.calibrate.people import TRUTH, logs


def written(path: Path, *lines: object) -> Path:
    path.write_text("".join((line if isinstance(line, str) else json.dumps(line)) + "\n" for line in lines))
    return path


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Logs of two people, one at each table."""
    folder = tmp_path_factory.mktemp("study")
    found = []
    for number, one in enumerate(logs(TRUTH, 2, 6, 4)):
        path = folder / f"{number}.jsonl"
        name = ("ambiguous", "unambiguous")[int(one.person) % 2]
        target = one.scene.items[one.desired].id
        header = Header(
            scene=one.scene,
            scene_name=name,
            planner="threshold",
            seed=number % 6,
            target=target,
            person=int(one.person),
        )
        with EventLog.create(path, header) as log:
            for event in one.events:
                log.write(event)
        found.append(path)
    return found


def test_check_says_what_is_right_and_all_that_is_wrong(run: Run, tmp_path: Path) -> None:
    good = written(tmp_path / "good.jsonl", *ASKED)
    bad = written(tmp_path / "bad.jsonl", {"scene": "ambiguous", "seed": -1}, {"action": "grab"}, "[1]")
    code, out, err = run("log", "check", good, bad, tmp_path / "none.jsonl")
    assert (code, out) == (2, f"{good}: ok, 4 events\n")
    assert err.splitlines() == [
        f"{bad}:1: seed: found -1, expected a whole number from 0",
        f"{bad}:2: action: found 'grab', expected one of wait, point, pick",
        f"{bad}:3: found [1], expected a JSON object",
        f"{tmp_path / 'none.jsonl'}: cannot be read: No such file or directory, expected a readable file",
        "2 of 3 files had faults",
    ]
    assert run("log", "check", good)[0] == 0


def test_a_half_written_end_is_told_and_no_fault(run: Run, tmp_path: Path) -> None:
    path = written(tmp_path / "log.jsonl", *ASKED)
    path.write_text(path.read_text() + '{"action": "pi')
    code, out, err = run("log", "check", path)
    assert (code, out, err) == (0, f"{path}: ok, 4 events; line 6 is incomplete and was left out\n", "")
    assert run("filter", path, "--json")[0] == 0


def test_replay_compares_decisions(run: Run, study: list[Path], tmp_path: Path) -> None:
    code, out, _ = run("log", "replay", study[0])
    steps = [json.loads(line) for line in out.splitlines()]
    assert code == 0
    assert all(step["same"] for step in steps if "done" in step)
    assert [step["line"] for step in steps] == list(range(2, len(steps) + 2))
    assert sum(steps[1]["belief"].values()) == pytest.approx(1)
    assert run("log", "check", "--replay", *study)[0] == 0
    led = written(
        tmp_path / "led.jsonl", {"scene": "ambiguous", "planner": "paper-never"}, {"action": "point", "item": "bowl-1"}
    )
    code, out, err = run("log", "check", "--replay", led)
    assert (code, out) == (2, "")
    assert "2: action: found point bowl-1, expected wait" in err
    assert run("log", "replay", led)[0] == 2


def test_trials_are_rows(run: Run, study: list[Path]) -> None:
    code, out, _ = run("log", "trials", *study)
    first, *rows = out.splitlines()
    assert code == 0
    assert first == "person,layout,paradigm,desired,order,time,correct,picked,questions,waits"
    assert [row.split(",")[:5] for row in rows[:2]] == [
        ["0", "ambiguous", "threshold", "bowl-1", "0"], ["0", "ambiguous", "threshold", "bowl-2", "1"],
    ]  # fmt: skip
    assert len(rows) == 12
    as_json = [json.loads(line) for line in run("log", "trials", "--json", *study)[1].splitlines()]
    assert [row["person"] for row in as_json] == [0] * 6 + [1] * 6


def test_the_schema_is_printed(run: Run) -> None:
    assert json.loads(run("log", "schema")[1])["$defs"]["word"]["required"] == ["text", "start", "end"]


def test_calibrate_writes_a_model_that_commands_take(run: Run, study: list[Path], tmp_path: Path) -> None:
    model = tmp_path / "model.toml"
    code, out, _ = run("calibrate", *study, "--out", model, "--episodes", 0, "--json")
    found = json.loads(out)
    assert code == 0
    assert (found["interactions"], found["people"], sorted(found["each"])) == (12, 2, ["0", "1"])
    changes = {name: one["value"] for name, one in found["estimates"].items() if one["known"] != "none"}
    assert with_model(Scene.load("ambiguous"), model).model == Scene.load("ambiguous").model.with_changes(changes)
    lines = model.read_text().splitlines()
    assert lines[0].startswith("# Fitted to 12 interactions with 2 people; 90 % intervals")
    assert sum(line.startswith("# bias_") for line in lines) == 2
    assert run("calibrate", *study, "--out", model, "--episodes", 0)[0] == 2, "no file is overwritten"
    recorded = written(tmp_path / "e.jsonl", *ASKED)
    for command in (
        ("simulate", "ambiguous", "--planner", "paper-never", "--episodes", 20),
        ("filter", recorded),
        ("decide", recorded, "--planner", "paper-never"),
        ("export", "ambiguous", tmp_path / "scene.pomdp"),
    ):
        assert run(*command, "--model", model)[0] == 0, command
    plain, fitted = (run("filter", recorded, *options)[1] for options in ((), ("--model", model)))
    assert plain != fitted
    code, _, err = run("simulate", "ambiguous", "--model", tmp_path / "none.toml")
    assert code == 2
    assert "none.toml: cannot be read" in err


@pytest.mark.slow
@pytest.mark.long
def test_calibrate_says_what_limits_accuracy(run: Run, study: list[Path]) -> None:
    found = json.loads(run("calibrate", *study, "--episodes", 2_000, "--json")[1])["limits"]
    assert list(found) == ["ambiguous", "unambiguous"]
    for one in found.values():
        gains = [limit["accuracy"] for limit in one["ideal"]]
        assert gains == sorted(gains, reverse=True)
        assert {limit["name"] for limit in one["ideal"]} == {"sigma", "p_g", "p_l", "alpha", "p_truth"}
    near = {limit["name"]: limit["accuracy"] for limit in found["ambiguous"]["ideal"]}
    assert near["sigma"] > 0, "the items stand side by side"


def test_calibrate_needs_to_know_what_was_desired(run: Run, tmp_path: Path) -> None:
    path = written(tmp_path / "e.jsonl", *ASKED)
    code, out, err = run("calibrate", path)
    assert (code, out) == (2, "")
    assert f"{path}:1: target: found none, expected the id of the item that was desired" in err


def test_a_log_with_a_return_and_a_second_request_is_checked_and_replayed(run: Run, tmp_path: Path) -> None:
    """As it was lived: by a planner that decides from the belief alone, so that each decision comes out again."""
    path = tmp_path / "log.jsonl"
    agent = Agent("ambiguous", Threshold(pick=0.4))
    ears = Ears(
        ("green", 0.4), ("marker", 0.5), ("no", 1.5), ("thanks", 3.4), ("the", 3.5), ("black", 3.6), ("bowl", 3.7)
    )
    header = Header(scene=agent.scene, scene_name="ambiguous", planner="threshold", parameters={"pick": 0.4})
    kinds = list[str]()
    with EventLog.create(path, header) as log:
        for event in interact(agent, Arm(), ears, None, timing=Timing(after=3.0)):
            log.write(event)
            kinds.append(event.outcome.value if isinstance(event, Acted) else "anew" if event.anew else "heard")
    assert kinds.count("returned") == 1
    assert kinds.count("anew") == 1
    assert kinds.count("done") > 3
    code, out, err = run("log", "check", path, "--replay")
    assert (code, err) == (0, "")
    assert str(path) in out
