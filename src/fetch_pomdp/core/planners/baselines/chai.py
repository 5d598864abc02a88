"""ChaiRule: a fixed asking rule, after Chai et al."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.planners.baselines.rule import decided, question_or_pick
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import PlannerError


@dataclass(frozen=True, slots=True)
class ChaiRule:
    """Asks about the likeliest item while there is more than one candidate, and picks the one that is left.

    A candidate is an item whose belief is at least `ratio` times that of the likeliest. Source: Chai et al. [4], whose
    "question asking policy, mapping state to action, is fixed" (Section II); the work is taken to be "Collaborative
    effort towards common ground in situated human-robot dialogue", HRI 2014. Left out: their matching of a graph of
    what is said with a graph of what is seen, questions that describe an item, and learning of words.

    Choice: a ratio of 0.2, so that one word sets its items apart from the others: with the paper's alpha these keep
    1/6 of the likeliest one's belief.

    It values picks alone. Raises PlannerError for a ratio that is no number above 0 and up to 1.
    """

    ratio: float = 0.2

    def __post_init__(self) -> None:
        expected = "a share of the largest belief, above 0 and at most 1"
        object.__setattr__(self, "ratio", checks.within(self.ratio, 1e-9, 1.0, "ratio", expected, PlannerError))

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:  # noqa: ARG002
        """Choose by rule."""
        return decided(self._actions, problem, belief, asked)

    def decide_many(self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator) -> Integers:  # noqa: ARG002
        """Choose an action for every belief; see `batch.decide_many`."""
        return self._actions(beliefs)

    def _actions(self, beliefs: Vector) -> Integers:
        candidates = (beliefs >= self.ratio * beliefs.max(axis=1, keepdims=True)).sum(axis=1)
        return question_or_pick(beliefs, beliefs.argmax(axis=1), candidates > 1)
