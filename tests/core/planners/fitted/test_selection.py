"""Which plan a problem gets."""

from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.core.planners.fitted.planner import FittedValue, solution
from fetch_pomdp.core.planners.fitted.selection import selected
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import simulate
from planning.drawn import random_scene
from tests.tables import table

CUPS = [["cup", "red"], ["cup"], ["pot"]]


def test_beliefs_under_the_rays_own_density_are_read_as_they_are() -> None:
    for problem in (table(CUPS, gesture_likelihood="exact"), table(CUPS, p_g=0.0)):
        policy = selected(problem, 400, 0)
        assert policy.power == 1.0
        assert policy.plan is problem.tables


def test_beliefs_under_eq7_are_never_read_as_less_than_they_are() -> None:
    policy = selected(table(CUPS, p_g=0.4), 400, 0)
    assert policy.power >= 1.0


def test_same_seed_same_policy() -> None:
    problem = table(CUPS, p_g=0.4)
    one, again = selected(problem, 400, 5), selected(problem, 400, 5)
    assert one.power == again.power
    assert np.array_equal(one.table.values, again.table.values)


@pytest.mark.slow
def test_where_eq7_sees_no_use_in_listening_the_plan_that_listens_is_kept() -> None:
    """A random scene on which the plan under Eq. 7 picks at once, right once in eleven times, for -7.6."""
    problem = Problem(random_scene(41))
    assert problem.n_items == 11
    played = simulate(problem, FittedValue(), 6_000, 2)
    assert played.mean_steps > 4
    assert played.mean_return > -7.6 + 2 * played.standard_error


@pytest.mark.slow
def test_where_waiting_for_ever_would_be_best_the_end_is_foreseen() -> None:
    """A random scene of 45 items and cheap waits: a policy that knows no end is cut short three times of ten."""
    problem = Problem(random_scene(68))
    assert solution(problem, FittedValue()).table.ends > 0.01
    played = simulate(problem, FittedValue(), 4_000, 2)
    assert played.mean_return > -1.5 - 3 * played.standard_error  # -3.7 without
