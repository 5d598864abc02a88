"""Thresholds: the rule, and its tuning."""

from __future__ import annotations

import pytest
from numpy.random import default_rng

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.thresholds import Threshold, tuned
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import simulate
from tests.tables import twins


@pytest.mark.parametrize(
    ("belief", "asked", "expected"),
    [
        ([0.8, 0.1, 0.1], None, Pick(0)),
        ([0.75, 0.2, 0.05], None, Point(0)),  # the leading two have .95
        ([0.1, 0.45, 0.45], None, Point(1)),
        ([0.1, 0.45, 0.45], 2, Wait()),  # its answer is out
        ([0.45, 0.45, 0.1], 2, Point(0)),  # that one was answered
        ([0.4, 0.4, 0.2], None, Wait()),
    ],
)
def test_the_rule(belief: list[float], asked: int | None, expected: Action) -> None:
    decision = Threshold().decide(twins(3), Belief(belief), asked, rng=default_rng(0))
    assert decision.action == expected
    assert decision.pick == pytest.approx([22.5 * b - 12.5 for b in belief])


@pytest.mark.slow
def test_tuning_finds_what_was_found_before() -> None:
    """Tuned by others on 300,000 fetches, the ambiguous scene: pick .722, pair .836, and a return of -.342 +- .018."""
    problem = Problem(Scene.load("ambiguous"))
    found = tuned(problem, 0)
    played = simulate(problem, found, 100_000, 9)
    assert played.mean_return >= -0.342 - 0.1 - 3 * played.standard_error
    assert played.mean_return <= -0.342 + 0.04 + 3 * played.standard_error
    assert found.pick == pytest.approx(0.722, abs=0.06)


@pytest.mark.slow
def test_tuning_is_repeatable_and_may_pick_at_once() -> None:
    problem = twins(3, p_truth=0.5)  # answers tell nothing
    found = tuned(problem, 3)
    assert found == tuned(problem, 3)
    assert simulate(problem, found, 300, 0).mean_steps == 0.0
