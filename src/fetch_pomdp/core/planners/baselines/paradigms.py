"""Paradigms one and two at their best: the robots to say with what asking, or not asking, is worth.

Those of Section IV are in `baselines.searches` and `baselines.rules`, for its cells. They lose points that have nothing
to do with questions: the search of paradigm one sees two steps and picks where listening on pays, and the rule of
paradigm two asks again while an answer is on its way. Beside them any planner looks good. Here both are planned by
`FittedValue`, with people of the model, under their paradigm's one constraint.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.model import LARGEST_REWARD
from fetch_pomdp.core.planners.base import Decision, Planner, decide_many, is_uniform, unvalued, whole_number
from fetch_pomdp.core.planners.baselines.rules import OneShot
from fetch_pomdp.core.planners.fitted.planner import MOST_BELIEFS, FittedValue
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import Interactions, played_out

LIMITS = (0.3, 0.4, *(0.5 + 0.02 * step for step in range(25)))  # beliefs from which on to pick
OPENINGS = (0.0, 0.3, 0.5, 0.7, 0.9, 1.1)  # beliefs from which on to ask first
MOST_PLAYED, NUMBERS_PLAYED = 2_000, 50_000  # interactions, and beliefs' entries in one step of all
CLEARLY = 2.0  # standard errors


@dataclass(frozen=True, slots=True)
class _Fitted:
    """What both are planned with: parameters of the fit of `FittedValue`."""

    beliefs: int = 8_000
    seed: int = 0

    def __post_init__(self) -> None:
        whole_number(self.beliefs, 100, MOST_BELIEFS, "beliefs")
        whole_number(self.seed, 0, 2**63 - 1, "seed")


@dataclass(frozen=True, slots=True)
class NeverAsk(_Fitted):
    """Paradigm one, the best robot that never asks: it waits or picks.

    The plan is `FittedValue`'s for a table on which no question can be worth its price. Where a limit on the belief
    (`OneShot`) earns clearly more with people of the model, that is followed; of LIMITS it is the one that earns most.
    A problem is solved when first asked about, its scene's plan is kept.

    Choice: the paper's robot is the search `PaperNeverAsk`. In the unambiguous layout it earns 0.6 points less than
    this one, and nothing of that is due to questions.

    It values no question; where a limit is followed, picks alone. Raises PlannerError for a parameter out of range.
    """

    def prepare(self, problem: Problem) -> None:
        """Solve the problem now, so that the first decision is as fast as the others."""
        self.decide(problem, Belief.uniform(problem.n_items), None, rng=np.random.default_rng(0))

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose to wait, or the likeliest item."""
        silent, planner = _without_questions(problem.scene, self.beliefs, self.seed)
        found = planner.decide(silent, belief, asked, rng=rng, phase=phase)
        return Decision(found.action, found.wait, unvalued(problem), found.pick, found.wait_error)

    def decide_many(
        self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator, phases: Integers | None = None
    ) -> Integers:
        """Choose an action for every belief; see `base.decide_many`."""
        silent, planner = _without_questions(problem.scene, self.beliefs, self.seed)
        return decide_many(planner, silent, beliefs, asked, rng=rng, phases=phases)


@functools.lru_cache(maxsize=32)
def _without_questions(scene: Scene, beliefs: int, seed: int) -> tuple[Problem, Planner]:
    """Return a scene whose questions have no price that anybody would pay, and the best planner for it."""
    silent = Problem(dataclasses.replace(scene, rewards=scene.rewards.with_changes({"point": -LARGEST_REWARD})))
    planned, limits = FittedValue(beliefs, seed=seed), [OneShot(limit) for limit in LIMITS]
    tuning = [earned(silent, one, seed).mean() for one in limits]
    limit = limits[int(np.argmax(tuning))]
    ahead = earned(silent, limit, seed + 1) - earned(silent, planned, seed + 1)
    return silent, limit if is_clear(ahead) else planned


@dataclass(frozen=True, slots=True)
class AlwaysAsk(_Fitted):
    """Paradigm two, the best robot that asks at least one question about the item it holds likeliest before it picks.

    It asks as soon as that item's belief has reached a limit, or where `FittedValue` asks or picks; from then on it
    acts by the plan of `FittedValue`. Of OPENINGS the limit is the one that earns most with people of the model. A
    problem is solved when first asked about, its scene's limit is kept.

    Choice: the paper's robot is the rule `PaperAlwaysAsk`, which asks until it is 95 % sure and asks again while an
    answer is on its way. It loses two to three points in the study's layouts to this one.

    Choice: before it has asked it waits while its belief is uniform, for there is no likeliest item to ask about,
    unless the plan would pick.

    The values are the plan's, which need not ask. Raises PlannerError for a parameter out of range.
    """

    def prepare(self, problem: Problem) -> None:
        """Solve the problem now, so that the first decision is as fast as the others."""
        self.decide(problem, Belief.uniform(problem.n_items), None, rng=np.random.default_rng(0))

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose by the plan, but for the first question."""
        opening = _opening(problem.scene, self.beliefs, self.seed)
        return opening.decide(problem, belief, asked, rng=rng, phase=phase)

    def decide_many(
        self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator, phases: Integers | None = None
    ) -> Integers:
        """Choose an action for every belief; see `base.decide_many`."""
        opening = _opening(problem.scene, self.beliefs, self.seed)
        return opening.decide_many(problem, beliefs, asked, rng=rng, phases=phases)


@dataclass(frozen=True, slots=True)
class AsksFirst:
    """A plan whose first question comes from a belief of `limit` on, and before a pick."""

    plan: FittedValue
    limit: float

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose by the plan, but for the first question."""
        found = self.plan.decide(problem, belief, asked, rng=rng, phase=phase)
        likeliest = int(belief.probabilities.argmax())
        opens = asked is None and (
            isinstance(found.action, Pick)
            or (problem.tables.begun[phase] != 0 and self.opens(belief.probabilities[None])[0])
        )
        return dataclasses.replace(found, action=Point(likeliest)) if opens else found

    def decide_many(
        self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator, phases: Integers | None = None
    ) -> Integers:
        """Choose an action for every belief; see `base.decide_many`."""
        actions = decide_many(self.plan, problem, beliefs, asked, rng=rng, phases=phases)
        begun = problem.tables.begun[np.zeros_like(asked) if phases is None else phases] != 0
        opens = (asked == NOBODY) & ((actions >= problem.n_items) | (begun & self.opens(beliefs)))
        return np.where(opens, beliefs.argmax(axis=1), actions)

    def opens(self, beliefs: Vector) -> Vector:
        """Return whether a first question is due, (k,); beliefs: (k, n_items)."""
        return np.asarray((beliefs.max(axis=1) >= self.limit) & ~is_uniform(beliefs))


@functools.lru_cache(maxsize=32)
def _opening(scene: Scene, beliefs: int, seed: int) -> AsksFirst:
    """Return the best of OPENINGS on a scene."""
    problem, plan = Problem(scene), FittedValue(beliefs, seed=seed)
    tried = [AsksFirst(plan, limit) for limit in OPENINGS]
    return tried[int(np.argmax([earned(problem, one, seed).mean() for one in tried]))]


def earned(problem: Problem, planner: Planner, seed: int) -> Vector:
    """Return what a planner earns with people of the model, (k,); same seed, same people. Items are desired equally."""
    count = min(MOST_PLAYED, max(1, NUMBERS_PLAYED // problem.n_items))
    people = np.random.default_rng((seed, 2)).integers(2**63, size=count, dtype=np.uint64)
    begun = Interactions.begin(np.arange(count) % problem.n_items, people, problem.n_items)
    return played_out(problem, planner, begun, np.random.default_rng(seed)).earned


def is_clear(ahead: Vector) -> bool:
    """Whether a mean is above 0 by more than chance gives; ahead: differences, (k,)."""
    return float(ahead.mean()) > CLEARLY * float(ahead.std()) / math.sqrt(len(ahead))
