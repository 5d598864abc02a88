"""Many decisions in one call.

An action is a whole number here: -1 for a wait, an item's index for a question about it, n_items + index for its pick.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.planners.base import Planner
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import PlannerError

_SHARE = 256  # decisions, below which a second thread does not pay


@runtime_checkable
class BatchPlanner(Protocol):
    """A planner that decides for many beliefs faster than one by one."""

    def decide_many(self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator) -> Integers:
        """Choose an action for every belief; see `decide_many`."""
        ...


def decide_many(planner: Planner, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator) -> Integers:
    """Return an action for every belief, (k,): the same as deciding one by one in this order.

    beliefs: (k, n_items), rows that sum to 1. asked: (k,), i_r as an index, -1 for None. Raises PlannerError for arrays
    of other shapes or an index out of range.
    """
    shapes = (beliefs.shape, asked.shape)
    if shapes != ((len(asked), problem.n_items), (len(asked),)):
        raise PlannerError(f"found shapes {shapes}, expected (k, {problem.n_items}) and (k,)", field="beliefs")
    if len(asked) and not NOBODY <= asked.min() <= asked.max() < problem.n_items:
        found = f"found {asked.min()} to {asked.max()}, expected -1 to {problem.n_items - 1}"
        raise PlannerError(found, field="asked")
    if isinstance(planner, BatchPlanner):
        return planner.decide_many(problem, np.ascontiguousarray(beliefs), asked.astype(np.int64), rng=rng)
    return one_by_one(planner, problem, beliefs, asked, rng)


def one_by_one(planner: Planner, problem: Problem, beliefs: Vector, asked: Integers, rng: Generator) -> Integers:
    """Return an action for every belief, (k,), decided in their order."""
    codes = [
        code_of(planner.decide(problem, Belief(belief), None if about < 0 else int(about), rng=rng).action, problem)
        for belief, about in zip(beliefs, asked, strict=True)
    ]
    return np.array(codes, dtype=np.int64)


def code_of(action: Action, problem: Problem) -> int:
    """Return an action as a whole number."""
    if isinstance(action, Wait):
        return NOBODY
    return action.item if isinstance(action, Point) else problem.n_items + action.item


def action_of(code: int, problem: Problem) -> Action:
    """Return the action of a whole number."""
    if code == NOBODY:
        return Wait()
    return Point(code) if code < problem.n_items else Pick(code - problem.n_items)


def on_all_cores(work: Callable[[int, int], None], count: int) -> None:
    """Call `work(begin, end)` on shares of `count`, one a core, in threads: for work that releases the GIL."""
    workers = max(1, min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
                         count // _SHARE))  # fmt: skip
    if workers == 1:
        work(0, count)
        return
    edges = np.linspace(0, count, workers + 1).astype(int).tolist()
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(work, edges[:-1], edges[1:]))
