"""What a planner is, and what it returns, for one belief or for many.

Where decisions are many an action is a whole number: -1 for a wait, an item's index for a question about it, n_items +
index for its pick.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.explanation import Explanation
from fetch_pomdp.core.planners.kernels import NOBODY
from fetch_pomdp.core.problem import Problem, points_only
from fetch_pomdp.errors import PlannerError

MOST_DEPTH, MOST_WIDTH = 20, 1_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Decision:
    """An action and why: the expected return of every action, NaN where the planner does not value it.

    The errors are standard errors of the sampling; 0 where nothing was sampled.
    """

    action: Action
    wait: float
    point: Vector  # (n_items,), asking about each item
    pick: Vector  # (n_items,), handing each item over
    wait_error: float = 0.0
    point_error: Vector | None = None  # (n_items,)
    explanation: Explanation | None = None  # filled in by Agent.decide
    passes: int | None = None  # of sampling, if their number depended on the clock

    @property
    def value(self) -> float:
        """The expected return of the chosen action."""
        if isinstance(self.action, Wait):
            return self.wait
        return float((self.point if isinstance(self.action, Point) else self.pick)[self.action.item])


class Planner(Protocol):
    """Decides. It keeps no state between calls: the same arguments and generator state give the same decision."""

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Choose an action for a belief and i_r, the index of the last item asked about, or None."""
        ...


@runtime_checkable
class PreparedPlanner(Planner, Protocol):
    """A planner that can do ahead what would keep its first decision waiting."""

    def prepare(self, problem: Problem) -> None:
        """Get ready to decide about a problem."""
        ...


@runtime_checkable
class BudgetPlanner(Planner, Protocol):
    """A planner whose decisions may depend on the clock, and on a number of passes instead."""

    def with_passes(self, passes: int) -> Planner:
        """Return a planner that makes so many passes whatever the time."""
        ...


def prepare(planner: Planner, problem: Problem) -> None:
    """Load what a planner has compiled, and let it solve the problem, so that no decision is kept waiting."""
    if isinstance(planner, PreparedPlanner):
        planner.prepare(problem)
    else:
        planner.decide(problem, Belief.uniform(problem.n_items), None, rng=np.random.default_rng(0))


def pick_values(belief: Vector, problem: Problem) -> Vector:
    """Return the expected reward of picking each item, (n_items,)."""
    rewards = problem.rewards
    return (rewards.pick_correct - rewards.pick_wrong) * belief + rewards.pick_wrong


def is_uniform(beliefs: Vector) -> npt.NDArray[np.bool_]:
    """Return whether nothing tells the items of a belief apart, (...); beliefs: (..., n_items). Never of one item."""
    same = np.ptp(beliefs, axis=-1) < 1e-9
    return np.asarray(same & (beliefs.shape[-1] > 1))


def best_action(wait: float, point: Vector, pick: Vector) -> Action:
    """Return the action with the highest value; NaN counts as never.

    Choice: equal values go to the pick, then the wait, then the question, and there to the first item of the scene.
    """
    item, question = int(pick.argmax()), int(point.argmax())
    best = max(float(pick[item]), wait)
    if point[question] > best:
        return Point(question)
    return Wait() if wait > pick[item] else Pick(item)


def whole_number(value: object, least: int, most: int, field: str) -> int:
    """Return a planner's whole-number parameter. Raises PlannerError for one that is out of range."""
    return checks.whole(value, least, most, field, PlannerError)


def unvalued(problem: Problem) -> Vector:
    """Return NaN for each item: no value."""
    return np.full(problem.n_items, np.nan)


def checked_asked(probabilities: Vector, asked: int | None, problem: Problem, phase: int = 0) -> int:
    """Return i_r for compiled code, which checks no index.

    Raises PlannerError for a belief or i_r of another table, or a phase of another model.
    """
    if not 0 <= phase < len(problem.tables.begun):
        expected = f"expected 0 to {len(problem.tables.begun) - 1}"
        raise PlannerError(f"found {phase!r}, {expected} for the problem's model", field="phase")
    points_only(problem, "`decide`, unlike `decide_asking`,")
    about = NOBODY if asked is None else asked
    if len(probabilities) != problem.n_items or not NOBODY <= about < problem.n_items:
        found = f"found a belief over {len(probabilities)} items and a question about item {asked}"
        raise PlannerError(f"{found}, expected the {problem.n_items} items of the problem", field="belief")
    return about


@runtime_checkable
class BatchPlanner(Protocol):
    """A planner that decides for many beliefs faster than one by one."""

    def decide_many(
        self, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator, phases: Integers | None = None
    ) -> Integers:
        """Choose an action for every belief; see `decide_many`."""
        ...


def decide_many(
    planner: Planner, problem: Problem, beliefs: Vector, asked: Integers, *, rng: Generator,
    phases: Integers | None = None,
) -> Integers:  # fmt: skip
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
    if phases is not None and len(phases):
        most = len(problem.tables.begun) - 1
        if not (phases.shape == asked.shape and 0 <= phases.min() <= phases.max() <= most):
            raise PlannerError(
                f"found {phases.min()} to {phases.max()}, expected (k,) from 0 to {most}", field="phases"
            )
    if isinstance(planner, BatchPlanner):
        return planner.decide_many(
            problem, np.ascontiguousarray(beliefs), asked.astype(np.int64), rng=rng, phases=phases
        )
    return one_by_one(planner, problem, beliefs, asked, rng, phases)


def one_by_one(
    planner: Planner, problem: Problem, beliefs: Vector, asked: Integers, rng: Generator, phases: Integers | None = None
) -> Integers:
    """Return an action for every belief, (k,), decided in their order."""
    codes = []
    for belief, about, phase in zip(beliefs, asked, np.zeros_like(asked) if phases is None else phases, strict=True):
        last = None if about < 0 else int(about)
        decision = planner.decide(problem, Belief(belief), last, rng=rng, phase=int(phase))
        codes.append(code_of(decision.action, problem))
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
