"""The command gap, as a user calls it."""

from __future__ import annotations

import json
import math

import pytest

from tests.cli.conftest import Run


@pytest.mark.slow
def test_gap_prints_one_object(run: Run) -> None:
    numbers = ("--episodes", 400, "--scenarios", 60, "--seed", 3, "--json")
    code, out, _ = run("gap", "unambiguous", "--planner", "paper-never", "--planner", "exact", *numbers)
    found = json.loads(out)
    assert code == 0
    assert list(found) == ["scene", "episodes", "bound", "planners"]
    bound, (never, exact) = found["bound"], found["planners"]
    assert set(bound) == {"mean", "standard_error", "scenarios", "kind", "seconds"}
    assert (found["scene"], found["episodes"], bound["scenarios"], bound["kind"]) == (
        "unambiguous", 400, 60, "relaxation",
    )  # fmt: skip
    assert [never["planner"], exact["planner"]] == ["paper-never", "exact"]
    for planner in (never, exact):
        assert planner["gap"] == pytest.approx(bound["mean"] - planner["mean_return"])
        assert planner["gap_error"] == pytest.approx(math.hypot(bound["standard_error"], planner["standard_error"]))
        assert planner["solving_seconds"] >= 0
        assert planner["decision_seconds"] > 0
    assert never["gap"] > exact["gap"] + 1.0
    code, out, _ = run("simulate", "unambiguous", "--planner", "paper-never", "--episodes", 400, "--seed", 3, "--json")
    assert json.loads(out)["mean_return"] == never["mean_return"]


def test_gap_refuses_what_does_not_exist(run: Run) -> None:
    assert run("gap", "nowhere")[0] == 2
    assert "found 'best'" in run("gap", "ambiguous", "--planner", "best")[2]
    assert run("gap", "ambiguous", "--scenarios", 1)[0] == 2
