"""From what a search or a leaf knows at the root to a decision."""

from __future__ import annotations

import logging
from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.planners.base import Decision, best_action, pick_values, unvalued
from fetch_pomdp.core.planners.kernels import NOBODY, RootValues, Search
from fetch_pomdp.core.planners.leaf import leading, leaf_of
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.errors import PlannerError

Kernel = Callable[[Vector, int, Search, int, Tables], RootValues]

_log = logging.getLogger(__name__)
_compiled: set[Kernel] = set()  # searches that this process has told its user about


def searched(
    kernel: Kernel, problem: Problem, belief: Belief, asked: int | None, search: Search, rng: Generator
) -> Decision:
    """Return the decision of a search of two actions or more; questions that it may not ask are worth NaN."""
    if kernel not in _compiled:
        _compiled.add(kernel)
        _log.info("loading the compiled planner; the first time after installation it is compiled, for some seconds")
    probabilities = belief.probabilities
    about = checked_asked(probabilities, asked, problem)
    seed = int(rng.random() * 2.0**53)
    wait, point, pick, wait_error, point_errors = kernel(probabilities, about, search, seed, problem.tables)
    if search.questions == 0:
        point = unvalued(problem)
        return Decision(best_action(wait, point, pick), wait, point, pick, wait_error)
    return Decision(best_action(wait, point, pick), wait, point, pick, wait_error, point_errors)


def checked_asked(probabilities: Vector, asked: int | None, problem: Problem) -> int:
    """Return i_r for compiled code, which checks no index. Raises PlannerError for a belief or i_r of another table."""
    about = NOBODY if asked is None else asked
    if len(probabilities) != problem.n_items or not NOBODY <= about < problem.n_items:
        found = f"found a belief over {len(probabilities)} items and a question about item {asked}"
        raise PlannerError(f"{found}, expected the {problem.n_items} items of the problem", field="belief")
    return about


def last_action(problem: Problem, belief: Belief) -> Decision:
    """Return the decision with one action left: the best pick, or a wait where even that is better (leaf `pick`)."""
    pick = pick_values(belief.probabilities, problem)
    wait, point = problem.rewards.wait, np.full(problem.n_items, problem.rewards.point)
    return Decision(best_action(wait, point, pick), wait, point, pick)


def patient_last_action(problem: Problem, belief: Belief, asked: int | None) -> Decision:
    """Return the decision of leaf `question` itself: ask and wait the answer out, wait out the one asked for, or
    pick.
    """
    tables, probabilities = problem.tables, belief.probabilities
    leaf, top = leaf_of(True, tables), leading(probabilities)
    pick = pick_values(probabilities, problem)
    pairs = probabilities + np.where(np.arange(problem.n_items) == top.first, top.b2, top.b1)
    settled = leaf.gain * leaf.p_truth * pairs + leaf.wrong
    later = np.maximum(settled + leaf.patience, pick.max())
    point = leaf.point + leaf.p_l * settled + (1.0 - leaf.p_l) * later
    wait = leaf.wait if asked is None else max(leaf.wait, float(settled[asked]) + leaf.patience)
    return Decision(best_action(wait, point, pick), wait, point, pick)
