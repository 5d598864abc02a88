"""The commands filter, decide and simulate, as a user calls them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import ASKED, Run


def events(path: Path, *lines: object) -> Path:
    path.write_text("\n".join(line if isinstance(line, str) else json.dumps(line) for line in lines) + "\n")
    return path


def test_filter_prints_a_belief_for_each_observation(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("filter", events(tmp_path / "e.jsonl", *ASKED), "--json")
    first, second = map(json.loads, out.splitlines())
    assert code == 0
    # "marker" is 1.2 / 0.2 = 6 times as likely for a marker: 6 / (2 * 6 + 4) and 1 / 16.
    assert first["belief"]["marker-1"] == pytest.approx(6 / 16)
    assert first["belief"]["bowl-2"] == pytest.approx(1 / 16)
    assert first["asked"] is None
    # "no" is 99 times as likely for any other item than marker-1.
    assert second["belief"]["marker-2"] == pytest.approx(6 * 99 / (6 + 10 * 99))
    assert second["asked"] == "marker-1"
    assert sum(second["belief"].values()) == pytest.approx(1)


def test_decide_prints_the_action_and_every_value(run: Run, tmp_path: Path) -> None:
    path = events(tmp_path / "e.jsonl", *ASKED)
    code, out, _ = run("decide", path, "--planner", "sparse", "--depth", 2, "--width", 50, "--seed", 3)
    decision = json.loads(out)
    assert code == 0
    assert list(decision) == ["action", "item", "values", "errors", "explanation"]
    assert set(decision["values"]["point"]) == set(decision["values"]["pick"])
    chance = 6 * 99 / (6 + 10 * 99)
    assert decision["values"]["pick"]["marker-2"] == pytest.approx(22.5 * chance - 12.5)
    assert decision["action"] == "wait"
    assert decision["item"] is None
    assert decision["values"]["wait"] > decision["values"]["pick"]["marker-2"]
    assert run("decide", path, "--planner", "sparse", "--width", 50, "--seed", 3)[1] == out


def test_decide_gives_null_where_a_planner_values_nothing(run: Run, tmp_path: Path) -> None:
    _, out, _ = run("decide", events(tmp_path / "e.jsonl", *ASKED), "--planner", "paper-always")
    decision = json.loads(out)
    assert decision["action"] == "point"
    assert decision["item"] == "marker-2"
    assert decision["values"]["wait"] is None


@pytest.mark.parametrize("command", ["filter", "decide"])
def test_a_half_written_last_line_is_told_beside_the_output(run: Run, tmp_path: Path, command: str) -> None:
    whole = events(tmp_path / "whole.jsonl", *ASKED)
    torn = tmp_path / "torn.jsonl"
    torn.write_text(whole.read_text() + '{"observation": {"utter')
    code, out, err = run(command, torn, "--json")
    assert (code, out) == (0, run(command, whole, "--json")[1])
    said = f"fetch-pomdp: {torn}:{len(ASKED) + 1}: this last line is incomplete and was left out"
    assert err.splitlines().count(said) == 1
    assert "left out" not in run(command, whole, "--json")[2]


def test_decide_refuses_an_interaction_that_is_over(run: Run, tmp_path: Path) -> None:
    path = events(tmp_path / "e.jsonl", *ASKED, {"action": "pick", "item": "marker-2"})
    code, out, err = run("decide", path)
    assert (code, out) == (2, "")
    assert "found an interaction that is over" in err


def test_a_second_request_is_filtered_and_decided_anew(run: Run, tmp_path: Path) -> None:
    """After a return and another hand-over: as if nothing had been before the request that began anew."""
    returned = {"action": "pick", "item": "marker-2", "outcome": "returned"}
    before = [
        *ASKED, {"action": "pick", "item": "marker-2"}, returned, {"observation": {"utterance": "no"}},
        {"action": "pick", "item": "marker-1"},
    ]  # fmt: skip
    request = {"observation": {"utterance": "spoon"}}
    path = events(tmp_path / "both.jsonl", *before, {**request, "anew": True})
    alone = events(tmp_path / "alone.jsonl", ASKED[0], request)
    code, out, _ = run("filter", path, "--json")
    beliefs = [json.loads(line) for line in out.splitlines()]
    assert code == 0
    # Two noes, each 99 times as likely for another item than the one asked about: the other items share the rest.
    assert beliefs[2]["belief"]["marker-2"] == pytest.approx(6 * 99 / (2 * 6 * 99 + 4 * 99**2))
    assert beliefs[2]["asked"] == "marker-2"
    assert beliefs[3] == json.loads(run("filter", alone, "--json")[1])
    assert beliefs[3]["asked"] is None
    threshold = ("--planner", "threshold")
    assert run("decide", path, *threshold)[1] == run("decide", alone, *threshold)[1]


def test_a_failed_pick_can_be_followed_by_an_observation(run: Run, tmp_path: Path) -> None:
    failed = {"action": "pick", "item": "marker-2", "outcome": "failed"}
    path = events(tmp_path / "e.jsonl", *ASKED, failed, {"observation": {"utterance": "marker"}})
    assert run("filter", path)[0] == 0


def test_simulate_prints_one_line_of_json(run: Run) -> None:
    arguments = ("simulate", "unambiguous", "--planner", "paper-never", "--episodes", 300, "--seed", 5, "--json")
    code, out, _ = run(*arguments)
    summary = json.loads(out)
    assert code == 0
    keys = {"episodes", "mean_return", "standard_error", "accuracy", "mean_steps", "mean_questions"}
    assert set(summary) == keys
    assert summary["mean_questions"] == 0
    paid = 10 * summary["accuracy"] - summary["mean_steps"]
    assert paid - 12.5 * (1 - summary["accuracy"]) <= summary["mean_return"] + 1e-9 <= paid + 1e-6
    assert run(*arguments)[1] == out


BAD_EVENTS: dict[str, tuple[int, list[object]]] = {
    "broken JSON": (1, ['{"scene": "ambiguous"']),
    "not an object": (1, ["[1]"]),
    "no scene": (1, ["{}"]),
    "unknown scene": (1, [{"scene": "kitchen"}]),
    "unknown field": (1, [{"scene": "ambiguous", "colour": 1}]),
    "unknown parameter": (1, [{"scene": "ambiguous", "model": {"sigme": 1}}]),
    "negative sigma": (1, [{"scene": "ambiguous", "model": {"sigma": -0.1}}]),
    "infinite reward": (1, ['{"scene": "ambiguous", "rewards": {"wait": -Infinity}}']),
    "no items": (1, [{"scene": {"head": [0, 0, 1], "items": []}}]),
    "unknown target": (1, [{"scene": "ambiguous", "target": "cup"}]),
    "unknown planner": (1, [{"scene": "ambiguous", "planner": "best"}]),
    "future version": (1, [{"scene": "ambiguous", "version": 5}]),
    "unknown action": (2, [{"scene": "ambiguous"}, {"action": "grab"}]),
    "unknown item": (2, [{"scene": "ambiguous"}, {"action": "pick", "item": "cup"}]),
    "no item": (2, [{"scene": "ambiguous"}, {"action": "point"}]),
    "unknown outcome": (2, [{"scene": "ambiguous"}, {"action": "pick", "item": "bowl-1", "outcome": "lost"}]),
    "head alone": (2, [{"scene": "ambiguous"}, {"observation": {"head": [0, 0, 1.6]}}]),
    "NaN": (2, ['{"scene": "ambiguous"}', '{"observation": {"head": [0, 0, NaN], "wrist": [0, 1, 1]}}']),
    "no ray": (2, [{"scene": "ambiguous"}, {"observation": {"head": [0, 0, 1], "wrist": [0, 0, 1]}}]),
    "number spoken": (2, [{"scene": "ambiguous"}, {"observation": {"utterance": 7}}]),
    "after a pick": (3, [{"scene": "ambiguous"}, {"action": "pick", "item": "bowl-1"}, {"observation": {}}]),
}


@pytest.mark.parametrize("name", BAD_EVENTS)
def test_bad_events_are_one_line_with_file_and_line(run: Run, tmp_path: Path, name: str) -> None:
    line, lines = BAD_EVENTS[name]
    path = events(tmp_path / "bad.jsonl", *lines)
    for command in ("filter", "decide"):
        code, out, err = run(command, path)
        assert code == 2
        assert len(err.splitlines()) == 1
        assert f"{path}:{line}: " in err
        assert "found" in err or "unknown" in err or "broken" in err
        assert "expected" in err
        assert out == ""


@pytest.mark.parametrize(
    ("text", "line", "field"),
    [
        ("head = [0, 0]\n[[items]]\nid = 'a'\nposition = [0, 1, 1]\nvocabulary = ['cup']\n", 1, "head"),
        ("head = [0, 0, 1]\n\n[[items]]\nid = 'a'\nposition = [0, 1]\nvocabulary = ['cup']\n", 5, "items[0].position"),
        ("head = [0, 0, 1]\n[[items]]\nid = 'a'\nposition = [0, 1, 1]\nvocabulary = []\n", 5, "items[0].vocabulary"),
        ("head = [0, 0, 1]\n[[items]]\nid = 'a'\nposition = [0, nan, 1]\nvocabulary = ['c']\n", 4, "items[0].position"),
        ("head = [0, 0, 1]\n[[items]]\nid = 'a'\nposition = [0, 1, 1]\nvocabulary = ['yes']\n", 5, "vocabulary[0]"),
        ("head = [0, 0, 1]\n[[items]]\nid = 'a'\ncolour = 1\n", 4, "items[0].colour"),
        ("head = [0, 0, 1]\nitems = []\n", 2, "items"),
        ("head = [0, 0, 1\n[[items]]\n", 2, "broken TOML"),
    ],
)
def test_bad_scenes_are_one_line_with_file_and_line(run: Run, tmp_path: Path, text: str, line: int, field: str) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text)
    code, _, err = run("simulate", path, "--episodes", 1)
    assert code == 2
    assert len(err.splitlines()) == 1
    assert f"{path}:{line}: " in err
    assert field in err


def test_bad_arguments_end_with_code_2(run: Run, tmp_path: Path) -> None:
    assert run("simulate", "nowhere")[0] == 2
    assert run("simulate", "ambiguous", "--planner", "best")[0] == 2
    assert run("simulate", "ambiguous", "--depth", 0)[0] == 2
    assert run("simulate", "ambiguous", "--planner", "paper-always", "--depth", 3)[0] == 2
    assert run("filter", tmp_path / "missing.jsonl")[0] == 2
    (tmp_path / "latin.jsonl").write_bytes(b'{"scene": "caf\xe9"}\n')
    code, _, err = run("filter", tmp_path / "latin.jsonl")
    assert code == 2
    assert "latin.jsonl:1: found byte 0xe9, expected UTF-8 text" in err
