"""InformationGain: asks what is expected to tell it most, as long as that is worth the question's price."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.planners.baselines.rule import decided, question_or_pick
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import PlannerError


@dataclass(frozen=True, slots=True)
class InformationGain:
    """Asks the question that is expected to take most entropy from the belief, while that is worth its price; else
    picks the likeliest item if that is worth a wait or more, and waits if not.

    A bit is worth `worth` times what a right pick earns over a wrong one; a question's price is what it costs more than
    a wait. Greedy: it looks no further than the answer. Source: the greedy choice of questions by entropy of Deits,
    Tellex, Thaker, Simeonov, Kollar and Roy, "Clarifying commands with information-theoretic human-robot dialog",
    Journal of Human-Robot Interaction 2013. Left out: their choice among kinds of questions and their grounding graphs.

    Choice: only the answer counts as gained, for words and pointing come after a wait, too.

    Choice: a worth of 1/2. A bit that decides between two items alike makes a sure pick of an even chance, and so earns
    half of what a right pick earns over a wrong one.

    It values picks alone. Raises PlannerError for a worth that is no number from 0 to 1000.
    """

    worth: float = 0.5

    def __post_init__(self) -> None:
        value = checks.within(self.worth, 0.0, 1e3, "worth", "a number from 0 to 1000", PlannerError)
        object.__setattr__(self, "worth", value)

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:  # noqa: ARG002
        """Choose by rule."""
        return decided(lambda beliefs: self._actions(beliefs, problem), problem, belief, asked)

    def decide_many(self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator) -> Integers:  # noqa: ARG002
        """Choose an action for every belief; see `batch.decide_many`."""
        return self._actions(beliefs, problem)

    def _actions(self, beliefs: Vector, problem: Problem) -> Integers:
        tables = problem.tables
        earned = tables.pick_correct - tables.pick_wrong
        gains = answer_information(beliefs, problem)
        asks = self.worth * earned * gains.max(axis=1) > tables.wait - tables.point
        actions = question_or_pick(beliefs, gains.argmax(axis=1), asks)
        waits = ~asks & (earned * beliefs.max(axis=1) + tables.pick_wrong < tables.wait)
        return np.where(waits, NOBODY, actions)


def answer_information(beliefs: Vector, problem: Problem) -> Vector:
    """Return the bits that the answer to a question about each item is expected to take from the entropy of a belief.

    That is the mutual information of item and answer (Eq. 6, Table I), whatever else is heard left out:
    p_l (H(yes) - H(p_truth)), with H(p) = -p log2 p - (1 - p) log2 (1 - p). beliefs, and the result: (..., n_items).
    """
    p_truth = problem.model.p_truth
    yes = p_truth * beliefs + (1.0 - p_truth) * (1.0 - beliefs)
    return problem.model.p_l * (binary_entropy(yes) - binary_entropy(np.array(p_truth)))


def binary_entropy(chance: Vector) -> Vector:
    """Return the entropy of a yes or no in bits; chance: of either, of any shape."""
    safe = np.clip(chance, 1e-300, 1.0)
    other = np.clip(1.0 - chance, 1e-300, 1.0)
    return np.asarray(-safe * np.log2(safe) - other * np.log2(other))
