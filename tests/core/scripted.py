"""A planner for tests that does as it is told."""

from __future__ import annotations

from numpy.random import Generator

from fetch_pomdp.core.action import Action, Pick
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.planners.base import Decision, pick_values, unvalued
from fetch_pomdp.core.problem import Problem


class Script:
    """A planner that follows a list of actions and picks item 0 after it; it notes when i_r was what."""

    def __init__(self, *actions: Action) -> None:
        self.actions, self.asked = list(actions), list[int | None]()

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        del rng
        self.asked.append(asked)
        action = self.actions[len(self.asked) - 1] if len(self.asked) <= len(self.actions) else Pick(0)
        return Decision(action, 0.0, unvalued(problem), pick_values(belief.probabilities, problem))
