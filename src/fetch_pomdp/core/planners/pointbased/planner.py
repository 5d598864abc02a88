"""PointBased: our planner of questions of all kinds."""

from __future__ import annotations

import weakref
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector, on_all_cores
from fetch_pomdp.core.planners.asking import Asked, AskingDecision, asked_of, checked
from fetch_pomdp.core.planners.base import pick_values, whole_number
from fetch_pomdp.core.planners.fitted.rehearsal import sharpened
from fetch_pomdp.core.planners.pointbased.ahead import Solved, step_ahead, step_ahead_many
from fetch_pomdp.core.planners.pointbased.rehearsal import power_of
from fetch_pomdp.core.planners.pointbased.solve import solved
from fetch_pomdp.core.planners.pointbased.steps import steps_of
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.history import History
from fetch_pomdp.core.questions.numbering import action_at
from fetch_pomdp.core.questions.rows import rows_of


class Solution(NamedTuple):
    """What a problem is solved to: plans, and the power of a belief that is read."""

    plans: Solved
    power: float


@dataclass(frozen=True, slots=True)
class PointBased:
    """One exact step ahead of plans that are made for a problem when first asked about it (`pointbased.solve`).

    A plan holds what it earns for each desired item, so that the planner knows which items are left and which questions
    tell them apart; a value over the leading pair and the entropy does not. With Eq. 7's likelihood it reads a
    sharpened belief (`pointbased.rehearsal`), and its values are those of that belief. Plans are kept for a problem's
    lifetime.

    Raises PlannerError for a seed out of range; a problem with live people raises ModelError.
    """

    seed: int = 0  # of the beliefs that plans are made for

    def __post_init__(self) -> None:
        whole_number(self.seed, 0, 2**63 - 1, "seed")

    def prepare(self, problem: Problem) -> None:
        """Make the plans and load what is compiled now, so that the first decision is as fast as the others."""
        self.decide_asking(
            problem, Belief.uniform(problem.n_items), History.none(problem), rng=np.random.default_rng(0)
        )

    def decide_asking(
        self,
        problem: Problem,
        belief: Belief,
        history: History,
        *,
        rng: Generator,  # noqa: ARG002
    ) -> AskingDecision:
        """Choose the action with the highest value."""
        probabilities = belief.probabilities
        checked(problem, probabilities, history)
        asked, known = asked_of(history), solution(problem, self.seed)
        probabilities = sharpened(probabilities, known.power)
        wait, ask, number = step_ahead(probabilities, int(asked.last[0]), asked.answers[0], known.plans)
        return AskingDecision(action_at(number, problem), number, wait, ask, pick_values(probabilities, problem))

    def decide_many_asking(
        self,
        problem: Problem,
        beliefs: Vector,
        asked: Asked,
        *,
        rng: Generator,  # noqa: ARG002
    ) -> Integers:
        """Choose an action for every belief, on all cores."""
        known, actions = solution(problem, self.seed), np.empty(len(beliefs), dtype=np.int64)
        read = beliefs
        if known.power != 1.0:
            read = beliefs**known.power
            read = read / read.sum(axis=1, keepdims=True)

        def share(begin: int, end: int) -> None:
            part = slice(begin, end)
            step_ahead_many(read[part], asked.last[part], asked.answers[part], known.plans, actions[part])

        on_all_cores(share, len(beliefs))
        return actions


_solutions: weakref.WeakKeyDictionary[Problem, dict[int, Solution]] = weakref.WeakKeyDictionary()


def solution(problem: Problem, seed: int) -> Solution:
    """Return what a problem is solved to, made when first asked for."""
    known = _solutions.setdefault(problem, {})
    if seed not in known:
        rows = rows_of(problem)
        steps = steps_of(problem, rows)
        plans = Solved(steps, solved(steps, seed), rows)
        known[seed] = Solution(plans, power_of(plans, problem, seed))
    return known[seed]
