"""OneShot: a Bayes filter and one pick, after the lab's own work of 2016."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.base import Decision, is_uniform
from fetch_pomdp.core.planners.baselines.rule import decided
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import PlannerError


@dataclass(frozen=True, slots=True)
class OneShot:
    """Picks the likeliest item after the first observation that sets any item apart; it never asks.

    With a `confidence` above 0 it waits until its belief has reached that. Source: [22], the paper's "previous work",
    taken to be Whitney, Eldon, Oberlin and Tellex, "Interpreting multimodal referring expressions in real time", ICRA
    2016: a Bayes filter over words and pointing, without a plan. Paradigm one (NeverAsk), "an improved version of the
    model from our previous work" (Section IV), has the same filter and plans when to pick. Left out: their context of
    the task, and their own likelihoods; the filter is ours (Eq. 1-7).

    Choice: the paper does not say when the robot of [22] picks. The first observation makes it the fast and careless
    end of the robots that never ask.

    It values picks alone. Where not pointing tells items apart (`gesture_likelihood` "exact") that is an observation,
    too. Raises PlannerError for a confidence that is no probability.
    """

    confidence: float = 0.0

    def __post_init__(self) -> None:
        value = checks.within(self.confidence, 0.0, 1.0, "confidence", "a probability from 0 to 1", PlannerError)
        object.__setattr__(self, "confidence", value)

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:  # noqa: ARG002
        """Wait, or pick the likeliest item."""
        return decided(self._actions, problem, belief, asked)

    def decide_many(self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator) -> Integers:  # noqa: ARG002
        """Choose an action for every belief; see `batch.decide_many`."""
        return self._actions(beliefs)

    def _actions(self, beliefs: Vector) -> Integers:
        waits = is_uniform(beliefs) | (beliefs.max(axis=1) < self.confidence)
        return np.where(waits, NOBODY, beliefs.shape[1] + beliefs.argmax(axis=1))
