"""Robots that follow a rule: Section IV's that always asks, and three after earlier work.

Those after earlier work are what the paper's Section II says of it, put into the actions of Section III-B: no question
but "this one?", about one item. None is the system of its authors. All wait as long as their belief is uniform: in this
task the person speaks first.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.base import (
    Decision,
    action_of,
    checked_asked,
    is_uniform,
    pick_values,
    unvalued,
)
from fetch_pomdp.core.planners.kernels import ASKED, NOBODY, WAITED
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.turns import POINTS, WORDS, answered_at_all
from fetch_pomdp.errors import PlannerError


class Standing(NamedTuple):
    """How the talk stands with each of k beliefs."""

    asked: Integers  # (k,), i_r or NOBODY
    phases: Integers  # (k,), see `turns`


class RulePlanner(ABC):
    """A planner whose choice is a rule over beliefs, and over how the talk stands; it values picks alone."""

    __slots__ = ()

    @abstractmethod
    def actions(self, beliefs: Vector, standing: Standing, problem: Problem) -> Integers:
        """Return an action (k,), as in `planners.base`, for each belief (k, n_items)."""

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose by rule. Raises PlannerError for a belief of another table."""
        probabilities = belief.probabilities
        checked_asked(probabilities, asked, problem)
        standing = Standing(np.array([NOBODY if asked is None else asked]), np.array([phase]))
        action = action_of(int(self.actions(probabilities[np.newaxis], standing, problem)[0]), problem)
        return Decision(action, np.nan, unvalued(problem), pick_values(probabilities, problem))

    def decide_many(
        self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator, phases: Integers | None = None
    ) -> Integers:
        """Choose an action for every belief; see `base.decide_many`."""
        standing = Standing(asked, np.zeros_like(asked) if phases is None else phases)
        return self.actions(beliefs, standing, problem)


def question_or_pick(beliefs: Vector, item: Integers, asks: Vector) -> Integers:
    """Return actions (k,): a question about an item (k,) where `asks` (k,) holds, else the pick of the likeliest.

    A wait where the belief is uniform.
    """
    actions = np.where(asks, item, beliefs.shape[1] + beliefs.argmax(axis=1))
    actions[is_uniform(beliefs)] = NOBODY
    return actions


@dataclass(frozen=True, slots=True)
class ChaiRule(RulePlanner):
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

    def actions(self, beliefs: Vector, standing: Standing, problem: Problem) -> Integers:
        """Ask while there is more than one candidate."""
        candidates = (beliefs >= self.ratio * beliefs.max(axis=1, keepdims=True)).sum(axis=1)
        return question_or_pick(beliefs, beliefs.argmax(axis=1), candidates > 1)


@dataclass(frozen=True, slots=True)
class InformationGain(RulePlanner):
    """Asks the question that is expected to take most entropy from the belief, while that is worth its price; else
    picks the likeliest item if that is worth a wait or more, and waits if not.

    A bit is worth `worth` times what a right pick earns over a wrong one; a question's price is what it costs more than
    a wait. Greedy: it looks no further than the answer. Source: the greedy choice of questions by entropy of Deits,
    Tellex, Thaker, Simeonov, Kollar and Roy, "Clarifying commands with information-theoretic human-robot dialog",
    Journal of Human-Robot Interaction 2013. Left out: their choice among kinds of questions and their grounding graphs.

    Choice: only the answer counts as gained, for words and pointing come after a wait, too.

    Choice: a worth of 1/2. A bit that decides between two items alike makes a sure pick of an even chance, and so earns
    half of what a right pick earns over a wrong one.

    Choice: live people answer a question once, in its own step or a later one. So before them an answer counts with the
    chance that it comes at all; what an open question will still tell comes after a wait, too, so that the wait is
    worth that much more; and a wait for something else costs as many as it takes until something comes.

    It values picks alone. Raises PlannerError for a worth that is no number from 0 to 1000.
    """

    worth: float = 0.5

    def __post_init__(self) -> None:
        value = checks.within(self.worth, 0.0, 1e3, "worth", "a number from 0 to 1000", PlannerError)
        object.__setattr__(self, "worth", value)

    def actions(self, beliefs: Vector, standing: Standing, problem: Problem) -> Integers:
        """Ask what is worth its price, wait for what is not sure or still to come, pick the rest."""
        tables, due = problem.tables, expected_of(problem)
        per_bit = self.worth * (tables.pick_correct - tables.pick_wrong)
        bits = answer_information(beliefs, problem)
        by_asking = bits.max(axis=1) * due.if_asked[standing.phases]
        by_waiting = bits[np.arange(len(beliefs)), standing.asked] * due.if_awaited[standing.phases]
        asks = per_bit * (by_asking - by_waiting) > tables.wait - tables.point
        actions = question_or_pick(beliefs, bits.argmax(axis=1), asks)
        poor = pick_values(beliefs, problem).max(axis=1) < tables.wait / due.in_a_wait[standing.phases]
        waits = ~asks & (poor | (per_bit * by_waiting > -tables.wait))
        return np.where(waits, NOBODY, actions)


class Expected(NamedTuple):
    """What a greedy robot expects of people in each phase, (phases,): chances."""

    if_asked: Vector  # of an answer to a question asked now
    if_awaited: Vector  # of an answer to the open question
    in_a_wait: Vector  # of anything at all in the step after a wait


def expected_of(problem: Problem) -> Expected:
    """Return what to expect; under the paper's constant chances an answer in the question's step, words in a wait."""
    tables, turns = problem.tables, problem.model.turns
    if turns is None:
        return Expected(np.array([problem.model.p_l]), np.zeros(1), np.ones(1))
    at_all, chances = answered_at_all(turns), tables.chances[:, WAITED]
    silent = (1.0 - chances[:, WORDS]) * (1.0 - chances[:, POINTS]) * (1.0 - at_all[:, WAITED])
    return Expected(at_all[:, ASKED], at_all[:, WAITED], 1.0 - silent)


def answer_information(beliefs: Vector, problem: Problem) -> Vector:
    """Return the bits that an answer about each item is expected to take from the entropy of a belief.

    That is the mutual information of item and answer (Table I), whatever else is heard left out: H(yes) - H(p_truth),
    with H(p) = -p log2 p - (1 - p) log2 (1 - p). beliefs, and the result: (..., n_items).
    """
    p_truth = problem.model.p_truth
    yes = p_truth * beliefs + (1.0 - p_truth) * (1.0 - beliefs)
    return binary_entropy(yes) - binary_entropy(np.array(p_truth))


def binary_entropy(chance: Vector) -> Vector:
    """Return the entropy of a yes or no in bits; chance: of either, of any shape."""
    safe = np.clip(chance, 1e-300, 1.0)
    other = np.clip(1.0 - chance, 1e-300, 1.0)
    return np.asarray(-safe * np.log2(safe) - other * np.log2(other))


@dataclass(frozen=True, slots=True)
class OneShot(RulePlanner):
    """Picks the likeliest item after the first observation that sets any item apart; it never asks.

    With a `confidence` above 0 it waits until its belief has reached that. Source: [22], the paper's "previous work",
    taken to be Whitney, Eldon, Oberlin and Tellex, "Interpreting multimodal referring expressions in real time", ICRA
    2016: a Bayes filter over words and pointing, without a plan. Paradigm one (PaperNeverAsk), "an improved version of
    the model from our previous work" (Section IV), has the same filter and plans when to pick. Left out: their context
    of the task, and their own likelihoods; the filter is ours (Eq. 1-7).

    Choice: the paper does not say when the robot of [22] picks. The first observation makes it the fast and careless
    end of the robots that never ask.

    It values picks alone. Where not pointing tells items apart (`gesture_likelihood` "exact") that is an observation,
    too. Raises PlannerError for a confidence that is no probability.
    """

    confidence: float = 0.0

    def __post_init__(self) -> None:
        value = checks.within(self.confidence, 0.0, 1.0, "confidence", "a probability from 0 to 1", PlannerError)
        object.__setattr__(self, "confidence", value)

    def actions(self, beliefs: Vector, standing: Standing, problem: Problem) -> Integers:
        """Wait, or pick the likeliest item."""
        waits = is_uniform(beliefs) | (beliefs.max(axis=1) < self.confidence)
        return np.where(waits, NOBODY, beliefs.shape[1] + beliefs.argmax(axis=1))


@dataclass(frozen=True, slots=True)
class PaperAlwaysAsk:
    """Paradigm two as the paper has it: asks about the likeliest item, at least once, until it is `confidence` sure.

    It asks again while the answer is on its way: a robot that always asks can do better (`AlwaysAsk`).

    Choice: it waits as long as its belief is uniform, for there is no likeliest item to ask about.

    It values picks alone. Raises PlannerError for a confidence that is no probability above 0.
    """

    confidence: float = 0.95

    def __post_init__(self) -> None:
        checks.within(self.confidence, 1e-9, 1.0, "confidence", "a probability above 0 and at most 1", PlannerError)

    def decide(
        self,
        problem: Problem,
        belief: Belief,
        asked: int | None,
        *,
        rng: Generator,
        phase: int = 0,
    ) -> Decision:
        """Wait, ask about the likeliest item, or pick it, by rule."""
        probabilities = belief.probabilities
        item = int(probabilities.argmax())
        action: Action = Point(item)
        if is_uniform(probabilities):
            action = Wait()
        elif asked is not None and probabilities[item] >= self.confidence:
            action = Pick(item)
        return Decision(action, np.nan, unvalued(problem), pick_values(probabilities, problem))
