"""Rehearsals: powers against beliefs of known power, ends by hand, returns against other code."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.core.model import Rewards
from fetch_pomdp.core.planners.base import Decision, action_of, pick_values, unvalued
from fetch_pomdp.core.planners.fitted.rehearsal import MOST_ENDS, Policy, likeliest_power, rehearse, sharpened
from fetch_pomdp.core.planners.fitted.table import COLUMNS, KINDS, ROWS, UNASKED, ValueTable, table_action
from fetch_pomdp.core.planners.kernels import leading
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import MOST_STEPS, run_episode
from tests.tables import table, twins

WAITS = ValueTable(np.full((1, ROWS, COLUMNS, KINDS), -50.0), np.empty(0))
WAITS.values[..., UNASKED] = 50.0  # a wait is worth more than any pick


@pytest.mark.parametrize("power", [1.0, 0.5, 2.0])
def test_the_power_that_people_were_drawn_with_is_found(power: float) -> None:
    rng = default_rng(3)
    beliefs = rng.dirichlet(np.full(5, 0.7), 20_000)
    truth = beliefs**power / (beliefs**power).sum(axis=1, keepdims=True)
    desired = (truth.cumsum(axis=1) < rng.random((len(truth), 1))).sum(axis=1)
    assert likeliest_power(beliefs, desired) == pytest.approx(power, abs=0.04)


def test_where_beliefs_tell_nothing_the_power_is_one_and_it_is_bounded() -> None:
    assert likeliest_power(np.full((10, 4), 0.25), np.zeros(10, dtype=np.int64)) == 1.0
    assert likeliest_power(np.empty((0, 4)), np.zeros(0, dtype=np.int64)) == 1.0
    always_right = np.tile([0.6, 0.4], (50, 1))
    assert likeliest_power(always_right, np.zeros(50, dtype=np.int64)) == 4.0
    assert likeliest_power(always_right, np.ones(50, dtype=np.int64)) == 0.25


def test_a_sharpened_belief_by_hand() -> None:
    assert sharpened(np.array([0.6, 0.3, 0.1]), 2.0) == pytest.approx([36 / 46, 9 / 46, 1 / 46])
    assert sharpened(np.array([0.6, 0.4, 0.0]), 1.0).tolist() == [0.6, 0.4, 0.0]


def test_a_table_that_waits_for_ever_is_cut_short_and_earns_what_it_waited() -> None:
    problem = twins(2)
    found = rehearse(Policy(WAITS, 1.0, problem.tables), 6, 0, problem)
    assert found.steps.tolist() == [MOST_STEPS] * 6
    # Twins say the same, so the first is picked at the end: right every other time.
    assert found.earned == pytest.approx([-MOST_STEPS + 10.0, -MOST_STEPS - 12.5] * 3)
    assert found.ends == MOST_ENDS
    assert found.power == 1.0


class Greedy:
    """The planner that a table alone is, in plain Python."""

    def __init__(self, fixed: ValueTable) -> None:
        self.table = fixed

    def decide(self, problem: Problem, belief: object, asked: int | None, *, rng: object, phase: int = 0) -> Decision:
        chances = belief.probabilities  # type: ignore[attr-defined]
        about = -1 if asked is None else asked
        action = table_action(chances, about, phase, leading(chances), self.table, problem.tables)
        return Decision(action_of(action, problem), 0.0, unvalued(problem), pick_values(chances, problem))


@pytest.mark.slow
def test_rehearsed_returns_are_those_of_plain_episodes() -> None:
    problem = table([["cup", "red"], ["cup"], ["pot"]], p_g=0.3)
    problem = Problem(dataclasses.replace(problem.scene, rewards=Rewards(point=-2.0)))
    rng = default_rng(8)
    fixed = ValueTable(rng.uniform(4.0, 7.5, (1, ROWS, COLUMNS, KINDS)), np.empty(0))
    ours = rehearse(Policy(fixed, 1.0, problem.tables), 6_000, 1, problem).earned
    theirs = np.array([
        run_episode(problem, Greedy(fixed), k % 3, default_rng((4, k)), default_rng(k)).earned for k in range(3_000)
    ])  # fmt: skip
    error = np.hypot(ours.std() / len(ours) ** 0.5, theirs.std() / len(theirs) ** 0.5)
    assert ours.mean() == pytest.approx(theirs.mean(), abs=4 * error)
    assert error < 0.2
