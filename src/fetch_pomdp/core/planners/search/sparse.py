"""SparseSampling: the paper's planner (Section III-D)."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector, compiled, inlined, lean, uniform
from fetch_pomdp.core.planners.base import MOST_DEPTH, MOST_WIDTH, Decision, whole_number
from fetch_pomdp.core.planners.kernels import answered, draw_item, hear, largest, select_answer
from fetch_pomdp.core.planners.search.leaf import last_action
from fetch_pomdp.core.planners.search.tree import (
    RootValues,
    Search,
    Work,
    best_of,
    enter,
    root_values,
    searched,
    workspace,
)
from fetch_pomdp.core.problem import Problem, Tables


@dataclass(frozen=True, slots=True)
class SparseSampling:
    """Sparse sampling on the belief MDP: `width` observations for each action at every node, `depth` actions ahead.

    One base word and one response word a step (Section III-D-1).

    Choice: depth counts actions, so depth 2 is act, observe, act.

    Choice: the paper does not say how the observations of a node are drawn; here the actions share their random
    numbers, and desired items and answers are spread evenly over their distributions. Drawn independently for each
    action, ten observations cost 0.3 (ambiguous) to 0.6 points a fetch.

    Raises PlannerError for a depth or width that is no whole number in range.
    """

    depth: int = 2
    width: int = 10

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 1, MOST_WIDTH, "width")

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0) -> Decision:
        """Choose the action with the highest sampled value."""
        if self.depth == 1:
            return last_action(problem, belief)
        search = Search(self.depth, self.width, problem.n_items, patient=False)
        return searched(plan_sparse, problem, belief, asked, search, rng)


@compiled
def plan_sparse(belief: Vector, asked: int, search: Search, seed: int, tables: Tables) -> RootValues:
    """Search with sampled observations, answers included."""
    work = workspace(belief, asked, search.depth, seed, tables)
    cursor, level, last = work.cursor, 0, search.depth - 2
    while True:
        if level < last and next_observation(level, search, work, tables):
            level += 1
            enter(level, cursor["asked"][level], work, tables)
            continue
        if level == last:
            last_two_sampled(level, search, work, tables)
        if level == 0:
            return root_values(search, work, tables)
        level -= 1
        action = (cursor["branch"][level] - 1) % (search.questions + 1) - 1
        value = best_of(level + 1, search, work, tables)
        work.totals[level, action] += value
        work.squares[level, action] += value * value


@lean
def next_observation(level: int, search: Search, work: Work, tables: Tables) -> bool:
    """Move a node's cursor to its next sample and action and put the belief then one level down; False at the end."""
    cursor = work.cursor
    sample, branch = divmod(cursor["branch"][level], search.questions + 1)
    if sample == search.width:
        return False
    belief, heard, state = work.beliefs[level], work.heard[level], work.state
    if branch == 0:
        cursor["desired"][level] = draw_item(belief, (sample + cursor["offset"][level]) / search.width)
        hear(belief, cursor["smoothed"][level], cursor["desired"][level], heard, state, tables)
        if sample == 0:
            cursor["speaks"][level], cursor["means"][level] = uniform(state), uniform(state)
        cursor["speaks"][level], cursor["means"][level] = spread(cursor["speaks"][level], cursor["means"][level])
    cursor["branch"][level] += 1
    about, rate = (cursor["asked"][level], tables.p_again) if branch == 0 else (branch - 1, tables.p_l)
    answer = select_answer(
        cursor["desired"][level], about, rate, cursor["speaks"][level], cursor["means"][level], tables
    )
    answered(heard, about, answer, rate, work.beliefs[level + 1], tables)
    cursor["asked"][level + 1] = about
    return True


@lean
def last_two_sampled(level: int, search: Search, work: Work, tables: Tables) -> None:
    """Fill in the totals of a node with two actions left, the last of them by leaf `pick`."""
    belief, heard, following, state = work.beliefs[level], work.heard[level], work.beliefs[level + 1], work.state
    totals, squares = work.totals[level], work.squares[level]
    asked, offset = work.cursor["asked"][level], work.cursor["offset"][level]
    smoothed = work.cursor["smoothed"][level]
    speaks, means = uniform(state), uniform(state)
    for sample in range(search.width):
        desired = draw_item(belief, (sample + offset) / search.width)
        hear(belief, smoothed, desired, heard, state, tables)
        speaks, means = spread(speaks, means)
        for action in range(-1, search.questions):
            about, rate = (asked, tables.p_again) if action < 0 else (action, tables.p_l)
            answer = select_answer(desired, about, rate, speaks, means, tables)
            answered(heard, about, answer, rate, following, tables)
            pick = tables.pick_wrong + (tables.pick_correct - tables.pick_wrong) * largest(following)
            value = max(tables.wait, pick)
            totals[action] += value
            squares[action] += value * value


@inlined
def spread(speaks: float, means: float) -> tuple[float, float]:
    """Return the next point of a sequence that fills the unit square evenly (Roberts 2018, the R2 sequence)."""
    return (speaks + 0.7548776662466927) % 1.0, (means + 0.5698402909980532) % 1.0
