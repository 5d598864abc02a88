"""What a planner of questions is: it chooses among a wait, the questions of a problem, and picks.

Where decisions are many an action is its number (`questions.numbering`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import AnyAction, Pick, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.history import History
from fetch_pomdp.core.questions.numbering import number_of
from fetch_pomdp.errors import PlannerError


@dataclass(frozen=True, slots=True, eq=False)
class AskingDecision:
    """An action, and the expected return of every action, NaN where the planner does not value it."""

    action: AnyAction
    number: int  # of the action
    wait: float
    ask: Vector  # (n_questions,)
    pick: Vector  # (n_items,)

    @classmethod
    def of(cls, action: AnyAction, problem: Problem, values: tuple[float, Vector, Vector]) -> AskingDecision:
        """Return a decision for an action. values: of the wait, the questions and the picks."""
        return cls(action, number_of(action, problem), *values)

    @property
    def value(self) -> float:
        """The expected return of the chosen action."""
        if isinstance(self.action, Wait):
            return self.wait
        if isinstance(self.action, Pick):
            return float(self.pick[self.action.item])
        return float(self.ask[self.number - 1])


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """Histories side by side, as compiled code reads them."""

    last: Integers  # (m,), the question asked last, or -1
    answers: Integers  # (m, n_questions), the last answer of each, or -1


class AskingPlanner(Protocol):
    """Decides about questions of all kinds. It keeps no state between calls."""

    def decide_asking(self, problem: Problem, belief: Belief, history: History, *, rng: Generator) -> AskingDecision:
        """Choose an action for a belief and what was asked and answered."""
        ...

    def decide_many_asking(self, problem: Problem, beliefs: Vector, asked: Asked, *, rng: Generator) -> Integers:
        """Choose an action for every belief, (m, n_items); return their numbers, (m,)."""
        ...


def asked_of(history: History) -> Asked:
    """Return one history as compiled code reads it."""
    return Asked(np.array([-1 if history.last is None else history.last]), np.array([history.answers]))


def checked(problem: Problem, probabilities: Vector, history: History) -> None:
    """Raise PlannerError for a belief or a history of another problem."""
    sizes = len(probabilities), len(history.answers)
    if sizes != (problem.n_items, problem.n_questions):
        found = f"found {sizes[0]} items and {sizes[1]} questions"
        expected = f"expected {problem.n_items} and {problem.n_questions}, as the problem has"
        raise PlannerError(f"{found}, {expected}", field="belief")
