"""What planners that follow a rule share: one rule decides for one belief and for many."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.base import Decision, is_uniform, pick_values, unvalued
from fetch_pomdp.core.planners.batch import action_of
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.planners.root import checked_asked
from fetch_pomdp.core.problem import Problem

Rule = Callable[[Vector], Integers]  # beliefs (k, n_items) to actions (k,), as in `planners.batch`


def decided(rule: Rule, problem: Problem, belief: Belief, asked: int | None) -> Decision:
    """Return the decision of a rule, which values picks alone. Raises PlannerError for a belief of another table."""
    probabilities = belief.probabilities
    checked_asked(probabilities, asked, problem)
    action = action_of(int(rule(probabilities[np.newaxis])[0]), problem)
    return Decision(action, np.nan, unvalued(problem), pick_values(probabilities, problem))


def question_or_pick(beliefs: Vector, item: Integers, asks: Vector) -> Integers:
    """Return actions (k,): a question about an item (k,) where `asks` (k,) holds, else the pick of the likeliest.

    A wait where the belief is uniform.
    """
    actions = np.where(asks, item, beliefs.shape[1] + beliefs.argmax(axis=1))
    actions[is_uniform(beliefs)] = NOBODY
    return actions
