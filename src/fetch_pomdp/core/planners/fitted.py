"""FittedValue: our planner, the default of everything."""

from __future__ import annotations

import functools
import weakref
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled
from fetch_pomdp.core.planners.afterstate import ValueTable, answered_value, classes_of, with_other
from fetch_pomdp.core.planners.base import Decision, pick_values, whole_number
from fetch_pomdp.core.planners.batch import action_of, code_of, on_all_cores
from fetch_pomdp.core.planners.exact import ExactAnswers
from fetch_pomdp.core.planners.fitting import fitted
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.planners.leaf import leading
from fetch_pomdp.core.planners.outlook import DistinctWords, distinct_words, look, outlook_size, smoothed_mass
from fetch_pomdp.core.planners.root import checked_asked
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.scene import Scene

MOST_FITTED = 2_000  # items: more are left to ExactAnswers
MOST_ASKED = 6  # leading items whose questions are valued
FIT_RAYS = 4  # rays of an outlook while fitting
MOST_BELIEFS, MOST_RAYS = 1_000_000, 10_000


class Solution(NamedTuple):
    """What a problem is solved to."""

    table: ValueTable
    distinct: DistinctWords  # with the rays of a decision


@dataclass(frozen=True, slots=True)
class FittedValue:
    """One exact step ahead of a value that is fitted to the problem when first asked about it.

    The value is a table over the leading pair (`planners.afterstate`), fitted by value iteration on `beliefs` beliefs a
    round (`planners.fitting`); the step sums words and answers and samples `rays` gestures, the same for all actions.
    The table is kept for a problem's lifetime, and the last tables for their scenes, so a scene is solved once.

    The leading MOST_ASKED items' questions are valued, others are NaN. Raises PlannerError for a parameter that is no
    whole number in range.

    Choice: tables of more than MOST_FITTED items are left to ExactAnswers(): there its closed form decides in
    milliseconds, and a fit would take seconds.
    """

    beliefs: int = 8_000
    rays: int = 8
    seed: int = 0  # of the fit

    def __post_init__(self) -> None:
        whole_number(self.beliefs, 100, MOST_BELIEFS, "beliefs")
        whole_number(self.rays, 1, MOST_RAYS, "rays")
        whole_number(self.seed, 0, 2**63 - 1, "seed")

    def prepare(self, problem: Problem) -> None:
        """Solve the problem now, so that the first decision is as fast as the others."""
        if problem.n_items <= MOST_FITTED:
            solution(problem, self)

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:
        """Choose the action with the highest value."""
        if problem.n_items > MOST_FITTED:
            return ExactAnswers().decide(problem, belief, asked, rng=rng)
        probabilities = belief.probabilities
        about = checked_asked(probabilities, asked, problem)
        solved = solution(problem, self)
        seed = int(rng.random() * 2.0**53)
        wait, point, wait_error, errors, action = step_ahead(
            probabilities, about, solved.table, solved.distinct, seed, problem.tables
        )
        pick = pick_values(probabilities, problem)
        return Decision(action_of(action, problem), wait, point, pick, wait_error, errors)

    def decide_many(self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator) -> Integers:
        """Choose an action for every belief, on all cores; see `batch.decide_many`."""
        actions = np.empty(len(beliefs), dtype=np.int64)
        if problem.n_items > MOST_FITTED:
            for index, belief in enumerate(beliefs):
                about = None if asked[index] == NOBODY else int(asked[index])
                actions[index] = code_of(self.decide(problem, Belief(belief), about, rng=rng).action, problem)
            return actions
        solved = solution(problem, self)
        seeds = (rng.random(len(beliefs)) * 2.0**53).astype(np.uint64)

        def share(begin: int, end: int) -> None:
            part = slice(begin, end)
            step_ahead_many(
                beliefs[part], asked[part], solved.table, solved.distinct, seeds[part], actions[part], problem.tables
            )

        on_all_cores(share, len(beliefs))
        return actions


_solutions: weakref.WeakKeyDictionary[Problem, dict[FittedValue, Solution]] = weakref.WeakKeyDictionary()


def solution(problem: Problem, planner: FittedValue) -> Solution:
    """Return what the planner knows of a problem, solved when first asked for."""
    known = _solutions.setdefault(problem, {})
    if planner not in known:
        known[planner] = _solved(problem.scene, planner)
    return known[planner]


@functools.lru_cache(maxsize=32)
def _solved(scene: Scene, planner: FittedValue) -> Solution:
    problem = Problem(scene)
    table = fitted(problem, distinct_words(problem, FIT_RAYS), planner.beliefs, planner.seed)
    return Solution(table, distinct_words(problem, planner.rays))


@compiled
def step_ahead(
    belief: Vector, asked: int, table: ValueTable, distinct: DistinctWords, seed: int, tables: Tables
) -> tuple[float, Vector, float, Vector, int]:
    """Return the values of a wait and of questions, their standard errors, and the best action (see `table_action`)."""
    count = len(belief)
    state, heard = np.empty(1, dtype=np.uint64), np.empty(count)
    state[0] = seed
    asks = candidates(belief)
    sums, squares, before = np.zeros(len(asks) + 1), np.zeros(len(asks) + 1), np.zeros(len(asks) + 1)
    errors = np.zeros(len(asks) + 1)
    smoothed = smoothed_mass(belief, tables)
    size = outlook_size(distinct, tables)
    rays = distinct.rays if tables.p_g > 0.0 else 0
    for number in range(size):
        if number == size - rays:
            before[:] = sums
        chance = look(number, belief, smoothed, heard, state, distinct, tables)
        top = leading(heard)
        classes = classes_of(top, table.breaks, tables)
        for index in range(len(asks) + 1):
            about, rate = (asked, tables.p_again) if index == len(asks) else (asks[index], tables.p_l)
            pairs = with_other(classes, about, top, table.breaks, tables)
            own = heard[about] if about != NOBODY else 0.0
            value = answered_value(table.values, pairs, top, about, own, rate, tables)
            sums[index] += chance * value
            if number >= size - rays:
                squares[index] += chance * value * value
    if rays > 1:
        for index in range(len(asks) + 1):
            mean = (sums[index] - before[index]) / tables.p_g
            spread = max(squares[index] / tables.p_g - mean * mean, 0.0)
            errors[index] = tables.p_g * np.sqrt(spread / (rays - 1))
    return chosen(belief, asks, sums, errors, tables)


@compiled
def candidates(belief: Vector) -> Vector:
    """Return the leading items, at most MOST_ASKED, the likeliest first; of equals the first in the scene."""
    found = np.full(min(MOST_ASKED, len(belief)), NOBODY)
    for item in range(len(belief)):
        place = len(found)
        while place > 0 and (found[place - 1] == NOBODY or belief[item] > belief[found[place - 1]]):
            place -= 1
            if place + 1 < len(found):
                found[place + 1] = found[place]
        if place < len(found):
            found[place] = item
    return found


@compiled
def chosen(
    belief: Vector, asks: Vector, sums: Vector, errors: Vector, tables: Tables
) -> tuple[float, Vector, float, Vector, int]:
    """Return the values of all actions and the best: equal values go to the pick, then the wait, then the question."""
    count = len(belief)
    point, point_errors = np.full(count, np.nan), np.full(count, np.nan)
    wait = tables.wait + sums[-1]
    best, action = tables.pick_wrong + (tables.pick_correct - tables.pick_wrong) * belief[asks[0]], count + asks[0]
    if wait > best:
        best, action = wait, NOBODY
    for index in range(len(asks)):
        value = tables.point + sums[index]
        point[asks[index]], point_errors[asks[index]] = value, errors[index]
        if value > best:
            best, action = value, asks[index]
    return wait, point, errors[-1], point_errors, action


@compiled
def step_ahead_many(
    beliefs: Vector,
    asked: Integers,
    table: ValueTable,
    distinct: DistinctWords,
    seeds: RandomState,
    actions: Integers,
    tables: Tables,
) -> None:
    """Fill in the best action for every belief."""
    for index in range(len(beliefs)):
        found = step_ahead(beliefs[index], asked[index], table, distinct, seeds[index], tables)
        actions[index] = found[4]
