"""FittedValue: our planner, the default of everything."""

from __future__ import annotations

import dataclasses
import functools
import math
import time
import weakref
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector, on_all_cores
from fetch_pomdp.core.planners.asking import Asked, AskingDecision, AskingPlanner
from fetch_pomdp.core.planners.base import Decision, action_of, checked_asked, one_by_one, pick_values, whole_number
from fetch_pomdp.core.planners.fitted.ahead import (
    Ahead,
    Lookahead,
    Root,
    add_passes,
    chosen,
    no_sums,
    step_ahead,
    step_ahead_many,
)
from fetch_pomdp.core.planners.fitted.outlook import distinct_words, rays_of
from fetch_pomdp.core.planners.fitted.rehearsal import Policy, sharpened
from fetch_pomdp.core.planners.fitted.selection import selected
from fetch_pomdp.core.planners.fitted.table import ValueTable
from fetch_pomdp.core.planners.kernels import pick_value
from fetch_pomdp.core.planners.search.planner import ExactAnswers
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.history import History
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import PlannerError

MOST_FITTED = 2_000  # items: more are left to ExactAnswers
MOST_BELIEFS, MOST_RAYS, MOST_PASSES = 1_000_000, 10_000, 1_000_000
CAUTION = 0.7  # share of a budget after which no pass may be expected to end


class Solution(NamedTuple):
    """What a problem is solved to: the power of a belief that is read, and what to look ahead with."""

    power: float
    ahead: Lookahead  # with the rays of a decision

    @property
    def table(self) -> ValueTable:
        """The value of having acted."""
        return self.ahead.table


@dataclass(frozen=True, slots=True)
class FittedValue:
    """One exact step ahead of a value that is fitted to the problem when first asked about it.

    The value is a table over the leading pair (`fitted.table`), fitted by value iteration on `beliefs` beliefs a
    round (`fitted.fit`); the step sums words and answers and samples `rays` gestures, the same for all actions,
    `passes` times. With Eq. 7's likelihood it reads a sharpened belief (`fitted.selection`), and its values are those
    of that belief. The table is kept for a problem's lifetime, and the last tables for their scenes, so a scene is
    solved once.

    With `budget_ms` a decision goes on with further passes while its best two kinds of action are within two standard
    errors and time is left; `Decision.passes` says how many there were, and `with_passes` decides so again without a
    clock. One pass there always is: 10 us at 6 items.

    The leading `ahead.MOST_ASKED` items' questions are valued, others are NaN. Raises PlannerError for a parameter out
    of range.

    Where there is more to ask than "this one?" (`decide_asking`), its plans are those of `pointbased.PointBased`: a
    value over the leading pair does not know which items are left, and so not what a question that halves them tells.

    Choice: tables of more than MOST_FITTED items are left to ExactAnswers(), which no budget changes: its closed form
    decides in milliseconds, and a fit would take seconds.
    """

    beliefs: int = 8_000
    rays: int = 8
    seed: int = 0  # of the fit
    passes: int = 1
    budget_ms: float | None = None

    def __post_init__(self) -> None:
        whole_number(self.beliefs, 100, MOST_BELIEFS, "beliefs")
        whole_number(self.rays, 1, MOST_RAYS, "rays")
        whole_number(self.seed, 0, 2**63 - 1, "seed")
        whole_number(self.passes, 1, MOST_PASSES, "passes")
        if self.budget_ms is not None:
            checks.within(self.budget_ms, 0.0, 1e6, "budget_ms", "a time from 0 to 1e6 ms, or none", PlannerError)

    def with_passes(self, passes: int) -> Self:
        """Return a planner that makes so many passes whatever the time."""
        return dataclasses.replace(self, passes=passes, budget_ms=None)

    def prepare(self, problem: Problem) -> None:
        """Solve the problem and load what is compiled now, so that the first decision is as fast as the others."""
        self.decide(problem, Belief.uniform(problem.n_items), None, rng=np.random.default_rng(0))

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose the action with the highest value."""
        started = time.perf_counter()
        if problem.n_items > MOST_FITTED:
            return ExactAnswers().decide(problem, belief, asked, rng=rng, phase=phase)
        about = checked_asked(belief.probabilities, asked, problem, phase)
        known = solution(problem, self)
        probabilities = sharpened(belief.probabilities, known.power)
        pick = pick_values(probabilities, problem)
        seed, passes = int(rng.random() * 2.0**53), None
        if self.budget_ms is None:
            table, distinct, tables = known.ahead
            found = step_ahead(probabilities, about, phase, table, distinct, seed, self.passes, tables)
        else:
            ends = started + CAUTION * self.budget_ms / 1e3
            found, passes = self._refined(Root(probabilities, about, phase), known.ahead, seed, ends)
        wait, point, wait_error, errors, action = found
        return Decision(action_of(action, problem), wait, point, pick, wait_error, errors, passes=passes)

    def _refined(self, root: Root, ahead: Lookahead, seed: int, ends: float) -> tuple[Ahead, int]:
        """Return what passes find until the best action is clear or the time is up, and how many they were."""
        sums, done, more = no_sums(root.belief), 0, self.passes
        pick = pick_value(float(root.belief.max()), ahead.tables)
        while True:
            before = time.perf_counter()
            add_passes(root, sums, ahead, seed, done, done + more)
            done += more
            found = chosen(root, sums, done, ahead.tables)
            now = time.perf_counter()
            more = done  # doubled, as long as twice the time that half of it took is left
            if now + 2.0 * (now - before) > ends or done + more > MOST_PASSES or not is_close(found, pick):
                return found, done

    def decide_many(
        self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator, phases: Integers | None = None
    ) -> Integers:
        """Choose an action for every belief, on all cores and with no budget; see `base.decide_many`."""
        if problem.n_items > MOST_FITTED:
            return one_by_one(self, problem, beliefs, asked, rng, phases)
        actions = np.empty(len(beliefs), dtype=np.int64)
        known, begun = solution(problem, self), np.zeros(len(beliefs), dtype=np.int64) if phases is None else phases
        seeds = (rng.random(len(beliefs)) * 2.0**53).astype(np.uint64)

        def share(begin: int, end: int) -> None:
            part = slice(begin, end)
            step_ahead_many(
                beliefs[part],
                asked[part],
                begun[part],
                known.power,
                known.ahead,
                seeds[part],
                self.passes,
                actions[part],
            )

        on_all_cores(share, len(beliefs))
        return actions

    def decide_asking(self, problem: Problem, belief: Belief, history: History, *, rng: Generator) -> AskingDecision:
        """Choose among questions of all kinds; where they are the paper's, as `decide` does."""
        if not problem.asks_points:
            return self._of_all_kinds().decide_asking(problem, belief, history, rng=rng)
        found = self.decide(problem, belief, history.last, rng=rng)
        return AskingDecision.of(found.action, problem, (found.wait, found.point, found.pick))

    def decide_many_asking(self, problem: Problem, beliefs: Vector, asked: Asked, *, rng: Generator) -> Integers:
        """Choose among questions of all kinds for every belief; where they are the paper's, as `decide_many` does."""
        if not problem.asks_points:
            return self._of_all_kinds().decide_many_asking(problem, beliefs, asked, rng=rng)
        return 1 + self.decide_many(problem, np.ascontiguousarray(beliefs), asked.last, rng=rng)

    def _of_all_kinds(self) -> AskingPlanner:
        from fetch_pomdp.core.planners.pointbased.planner import PointBased  # where it is used: it loads the reader

        return PointBased(self.seed)


def is_close(found: Ahead, pick: float) -> bool:
    """Whether the best two of a wait, the best question and the best pick are within two standard errors."""
    wait, point, wait_error, errors, _ = found
    question = int(np.nanargmax(point))
    ranked = sorted([(wait, wait_error), (float(point[question]), float(errors[question])), (pick, 0.0)])
    (second, second_error), (best, best_error) = ranked[-2:]
    return best - second < 2.0 * math.hypot(best_error, second_error)


_solutions: weakref.WeakKeyDictionary[Problem, dict[tuple[int, int, int], Solution]] = weakref.WeakKeyDictionary()


def solution(problem: Problem, planner: FittedValue) -> Solution:
    """Return what the planner knows of a problem, solved when first asked for."""
    known, key = _solutions.setdefault(problem, {}), (planner.beliefs, planner.seed, planner.rays)
    if key not in known:
        policy = _policy(problem.scene, planner.beliefs, planner.seed)
        ahead = Lookahead(policy.table, distinct_words(problem, rays_of(problem, planner.rays)), policy.plan)
        known[key] = Solution(policy.power, ahead)
    return known[key]


@functools.lru_cache(maxsize=32)
def _policy(scene: Scene, beliefs: int, seed: int) -> Policy:
    return selected(Problem(scene), beliefs, seed)
