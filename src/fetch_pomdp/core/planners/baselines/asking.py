"""Robots that choose among questions of all kinds by a rule, or one step ahead, for the planner to be compared with."""

from __future__ import annotations

import math
import weakref
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector, compiled
from fetch_pomdp.core.planners.asking import Asked, AskingDecision, asked_of, checked
from fetch_pomdp.core.planners.base import pick_values
from fetch_pomdp.core.planners.pointbased.ahead import Solved, step_ahead_many
from fetch_pomdp.core.planners.pointbased.solve import no_vectors
from fetch_pomdp.core.planners.pointbased.steps import steps_of
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.questions.history import History
from fetch_pomdp.core.questions.numbering import action_at
from fetch_pomdp.core.questions.rows import Rows, chances_after, information, rows_of
from fetch_pomdp.core.questions.simulation import simulate_asking
from fetch_pomdp.errors import PlannerError

PICKS = (0.0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 0.98)
ENTROPIES = (0.7, 1.0, 1.5, 2.0, 3.0, 99.0)  # bits
HALVINGS = ((150, 16), (800, 5), (3_000, 1))  # episodes, and settings kept


class AskingRule(ABC):
    """A planner of questions whose choice is one of many at once; it values picks alone."""

    __slots__ = ()

    @abstractmethod
    def decide_many_asking(self, problem: Problem, beliefs: Vector, asked: Asked, *, rng: Generator) -> Integers:
        """Choose an action for every belief, (m, n_items); return their numbers, (m,)."""

    def decide_asking(self, problem: Problem, belief: Belief, history: History, *, rng: Generator) -> AskingDecision:
        """Choose an action. Raises PlannerError for a belief or a history of another problem."""
        probabilities = belief.probabilities
        checked(problem, probabilities, history)
        number = int(self.decide_many_asking(problem, probabilities[None], asked_of(history), rng=rng)[0])
        unvalued = np.full(problem.n_questions, np.nan)
        return AskingDecision(action_at(number, problem), number, np.nan, unvalued, pick_values(probabilities, problem))


@dataclass(frozen=True, slots=True)
class OneStepAsking(AskingRule):
    """Looks one exact step ahead and then picks: a question is worth what the pick after its answer is."""

    def decide_many_asking(
        self,
        problem: Problem,
        beliefs: Vector,
        asked: Asked,
        *,
        rng: Generator,  # noqa: ARG002
    ) -> Integers:
        """Choose an action for every belief, (m,)."""
        if problem not in _picks:
            rows = rows_of(problem)
            steps = steps_of(problem, rows)
            _picks[problem] = Solved(steps, no_vectors(steps), rows)
        actions = np.empty(len(beliefs), dtype=np.int64)
        step_ahead_many(np.ascontiguousarray(beliefs), asked.last, asked.answers, _picks[problem], actions)
        return actions


_picks: weakref.WeakKeyDictionary[Problem, Solved] = weakref.WeakKeyDictionary()


@dataclass(frozen=True, slots=True)
class ThresholdAsking(AskingRule):
    """Picks from a belief of `pick` on; else asks what tells most for its price once the entropy is at most `entropy`
    bits; else waits. Raises PlannerError for a limit that is no number from 0 to 100.
    """

    pick: float = 0.8
    entropy: float = 2.0

    def __post_init__(self) -> None:
        for name in ("pick", "entropy"):
            value = checks.within(getattr(self, name), 0.0, 100.0, name, "a number from 0 to 100", PlannerError)
            object.__setattr__(self, name, value)

    def decide_many_asking(
        self,
        problem: Problem,
        beliefs: Vector,
        asked: Asked,
        *,
        rng: Generator,  # noqa: ARG002
    ) -> Integers:
        """Choose an action for every belief, (m,)."""
        questions, _ = most_telling(np.ascontiguousarray(beliefs), asked.answers, rows_of(problem))
        logs = np.log2(np.maximum(beliefs, 1e-300))
        asks = -(beliefs * logs).sum(axis=1) <= self.entropy
        picks = beliefs.max(axis=1) >= self.pick
        pick = 1 + problem.n_questions + beliefs.argmax(axis=1)
        return np.where(picks, pick, np.where(asks, 1 + questions, 0))


def tuned(problem: Problem, seed: int) -> ThresholdAsking:
    """Return the best limits of a grid by simulated return, by successive halving: all play with the same people."""
    settings: Sequence[ThresholdAsking] = [ThresholdAsking(pick, entropy) for pick in PICKS for entropy in ENTROPIES]
    for episodes, kept in HALVINGS:
        earned = [simulate_asking(problem, setting, episodes, seed).mean_return for setting in settings]
        settings = [settings[index] for index in np.argsort(-np.array(earned), kind="stable")[:kept]]
    return settings[0]


@dataclass(frozen=True, slots=True)
class InformationGainAsking(AskingRule):
    """Asks what tells most for its price while that is worth it; else picks the likeliest item if that is worth a wait
    or more, and waits if not.

    A bit is worth `worth` times what a right pick earns over a wrong one, and a question costs what it costs more than
    a wait, as in `rules.InformationGain`. Raises PlannerError for a worth that is no number from 0 to 1000.
    """

    worth: float = 0.5

    def __post_init__(self) -> None:
        value = checks.within(self.worth, 0.0, 1e3, "worth", "a number from 0 to 1000", PlannerError)
        object.__setattr__(self, "worth", value)

    def decide_many_asking(
        self,
        problem: Problem,
        beliefs: Vector,
        asked: Asked,
        *,
        rng: Generator,  # noqa: ARG002
    ) -> Integers:
        """Choose an action for every belief, (m,)."""
        tables, rows = problem.tables, rows_of(problem)
        questions, bits = most_telling(np.ascontiguousarray(beliefs), asked.answers, rows)
        earned = self.worth * (tables.pick_correct - tables.pick_wrong) * tables.p_answer * bits
        asks = earned > tables.wait - rows.prices[questions]
        picks = pick_values(beliefs, problem).max(axis=1) >= tables.wait
        pick = 1 + problem.n_questions + beliefs.argmax(axis=1)
        return np.where(asks, 1 + questions, np.where(picks, pick, 0))


@compiled
def most_telling(beliefs: Vector, answers: Integers, rows: Rows) -> tuple[Integers, Vector]:
    """Return, for every belief, the question that tells most for its price, and how many bits that is, (m,) each."""
    best, bits = np.zeros(len(beliefs), dtype=np.int64), np.zeros(len(beliefs))
    for index in range(len(beliefs)):
        chances, most = chances_after(answers[index], rows), -1.0
        for question in range(len(rows.prices)):
            told = information(question, beliefs[index], chances, rows.starts) / math.log(2.0)
            price = max(-rows.prices[question], 1e-9)
            if told > most * price:
                most, best[index], bits[index] = told / price, question, told
    return best, bits
