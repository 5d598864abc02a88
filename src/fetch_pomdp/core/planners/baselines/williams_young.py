"""WilliamsYoung: always asks first, about what a plan chooses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Action, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import (
    MOST_DEPTH,
    MOST_WIDTH,
    Decision,
    best_action,
    is_uniform,
    unvalued,
    whole_number,
)
from fetch_pomdp.core.planners.exact import ExactAnswers
from fetch_pomdp.core.problem import Problem


@dataclass(frozen=True, slots=True)
class WilliamsYoung:
    """Opens with a question whatever it believes, then asks or picks; the plan chooses about what, and when to end.

    Source: Williams and Young [24], who "always ask questions, regardless of context, and use the POMDP to have a
    policy on which questions to ask" (Section II); the work is taken to be "Partially observable Markov decision
    processes for spoken dialog systems", Computer Speech and Language 2007. Their machine speaks and listens in turns:
    it asks or submits, and never waits. The plan is the search of `ExactAnswers`. Left out: slots, their record of
    what was grounded, confidence scores, and the fixed routine of the questions themselves.

    Choice: where the belief is uniform it waits: their opening, "how may I help you?", is about no item, and who makes
    a request has answered it.

    Choice: looking ahead, the search allows waits, as that of `ExactAnswers` does; the action taken is never one.

    Waits are worth NaN. Raises PlannerError for a depth or width that is no whole number in range.
    """

    depth: int = 2
    width: int = 0

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 0, MOST_WIDTH, "width")

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:
        """Choose the best question, or from the second decision on the best pick if that is better."""
        found = ExactAnswers(self.depth, self.width).decide(problem, belief, asked, rng=rng)
        probabilities = belief.probabilities
        if is_uniform(probabilities):
            return Decision(Wait(), np.nan, unvalued(problem), found.pick)
        action: Action = Point(int(found.point.argmax()))
        if asked is not None:
            action = best_action(np.nan, found.point, found.pick)
        return Decision(action, np.nan, found.point, found.pick, point_error=found.point_error)
