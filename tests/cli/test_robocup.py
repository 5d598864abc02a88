"""The command robocup."""

from __future__ import annotations

import json

from tests.cli.conftest import Run


def test_planners_are_scored_and_repeat_by_seed(run: Run) -> None:
    arguments = (
        "robocup",
        "--games",
        5,
        "--planner",
        "paper-never",
        "--planner",
        "paper-always",
        "--seed",
        2,
        "--json",
    )
    code, out, _ = run(*arguments)
    result = json.loads(out)
    assert code == 0
    assert (result["games"], result["seed"], result["rules"]["question"]) == (5, 2, -150)
    never, always = result["planners"]
    assert (never["planner"], always["planner"]) == ("paper-never", "paper-always")
    assert never["questions"] == 0
    assert always["questions"] >= 1
    assert run(*arguments)[1] == out


def test_bad_input_is_one_line(run: Run) -> None:
    code, _, error = run("robocup", "--planner", "nobody")
    assert (code, error.count("\n")) == (2, 1)
    assert error.startswith("fetch-pomdp: planner: found 'nobody', expected one of fitted")
    code, _, error = run("robocup", "--unknown", 2)
    assert (code, error) == (2, "fetch-pomdp: unknown: found 2.0, expected a probability from 0 to 1\n")
