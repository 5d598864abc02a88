"""The baselines of Section IV: a robot that never asks, and one that always does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import (
    MOST_DEPTH,
    MOST_WIDTH,
    Decision,
    is_uniform,
    pick_values,
    unvalued,
    whole_number,
)
from fetch_pomdp.core.planners.exact import plan_exact
from fetch_pomdp.core.planners.kernels import Search
from fetch_pomdp.core.planners.root import last_action, searched
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import PlannerError


@dataclass(frozen=True, slots=True)
class NeverAsk:
    """Paradigm one: the search of the paper's depth and width without questions; it waits or picks.

    Raises PlannerError for a depth or width that is no whole number in range.
    """

    depth: int = 2
    width: int = 10

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 1, MOST_WIDTH, "width")

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:
        """Choose to wait, or the likeliest item."""
        if self.depth == 1:
            return last_action(problem, belief)
        search = Search(self.depth, self.width, questions=0, patient=False)
        return searched(plan_exact, problem, belief, asked, search, rng)


@dataclass(frozen=True, slots=True)
class AlwaysAsk:
    """Paradigm two: asks about the likeliest item, at least once, until it is `confidence` sure of it.

    Choice: it waits as long as its belief is uniform, for there is no likeliest item to ask about.

    It values picks alone. Raises PlannerError for a confidence that is no probability above 0.
    """

    confidence: float = 0.95

    def __post_init__(self) -> None:
        checks.within(self.confidence, 1e-9, 1.0, "confidence", "a probability above 0 and at most 1", PlannerError)

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:  # noqa: ARG002
        """Wait, ask about the likeliest item, or pick it, by rule."""
        probabilities = belief.probabilities
        item = int(probabilities.argmax())
        action: Action = Point(item)
        if is_uniform(probabilities):
            action = Wait()
        elif asked is not None and probabilities[item] >= self.confidence:
            action = Pick(item)
        return Decision(action, np.nan, unvalued(problem), pick_values(probabilities, problem))
