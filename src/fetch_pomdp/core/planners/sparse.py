"""SparseSampling: the paper's planner (Section III-D)."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import RandomState, Vector, compiled, inlined, uniform
from fetch_pomdp.core.planners.base import MOST_DEPTH, MOST_WIDTH, Decision, whole_number
from fetch_pomdp.core.planners.kernels import (
    Search,
    Work,
    answered,
    best_of,
    draw_answer,
    draw_item,
    enter,
    hear,
    largest,
    workspace,
)
from fetch_pomdp.core.planners.root import last_action, searched
from fetch_pomdp.core.problem import Problem, Tables


@dataclass(frozen=True, slots=True)
class SparseSampling:
    """Sparse sampling on the belief MDP: `width` observations for each action at every node, `depth` actions ahead.

    One base word and one response word a step (Section III-D-1). Choice: depth counts actions, so depth 2 is act, observe,
    act; with one action left a node is worth its best pick or the reward of a wait.
    Raises PlannerError for a depth or width that is no whole number in range.
    """

    depth: int = 2
    width: int = 10

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 1, MOST_WIDTH, "width")

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator) -> Decision:
        """Choose the action with the highest sampled value."""
        if self.depth == 1:
            return last_action(problem, belief)
        search = Search(self.depth, self.width, problem.n_items, patient=False)
        return searched(plan_sparse, problem, belief, asked, search, rng)


@compiled
def plan_sparse(belief: Vector, asked: int, search: Search, seed: int, tables: Tables) -> tuple[Vector, Vector]:
    """Sparse sampling (Section III-D): every action has observations of its own. Returns the root's totals and squares."""
    work = workspace(belief, asked, search.depth, seed)
    level, last = 0, search.depth - 2
    while True:
        if level < last and next_observation(level, search, work, tables):
            level += 1
            enter(level, work.asked[level], work)
            continue
        if level == last:
            last_two_sampled(level, search, work, tables)
        if level == 0:
            return work.totals[0], work.squares[0]
        level -= 1
        action = (work.branch[level] - 1) // search.width - 1
        value = best_of(level + 1, search, work, tables)
        work.totals[level, action] += value
        work.squares[level, action] += value * value


@compiled
def next_observation(level: int, search: Search, work: Work, tables: Tables) -> bool:
    """Move a node's cursor to its next action and sample and put the belief then one level down; False at the end."""
    action = work.branch[level] // search.width - 1
    if action == search.questions:
        return False
    work.branch[level] += 1
    about, rate = (work.asked[level], tables.p_again) if action < 0 else (action, tables.p_l)
    work.asked[level + 1] = about
    perceive(work.beliefs[level], about, rate, work.heard[level], work.beliefs[level + 1], work.state, tables)
    return True


@inlined
def perceive(
    belief: Vector, about: int, rate: float, heard: Vector, following: Vector, state: RandomState, tables: Tables
) -> None:
    """Fill in the belief that follows one observation drawn from a belief (Eq. 1-7)."""
    desired = draw_item(belief, uniform(state))
    hear(belief, desired, heard, state, tables)
    answer = draw_answer(desired, about, rate, state, tables)
    answered(heard, about, answer, rate, following, tables)


@compiled
def last_two_sampled(level: int, search: Search, work: Work, tables: Tables) -> None:
    """Fill in the totals of a node with two actions left, the last of them by leaf `pick`."""
    belief, heard, following, state = work.beliefs[level], work.heard[level], work.beliefs[level + 1], work.state
    totals, squares, asked = work.totals[level], work.squares[level], work.asked[level]
    for action in range(-1, search.questions):
        about, rate = (asked, tables.p_again) if action < 0 else (action, tables.p_l)
        for _ in range(search.width):
            perceive(belief, about, rate, heard, following, state, tables)
            likeliest = largest(following)
            pick = tables.pick_wrong + (tables.pick_correct - tables.pick_wrong) * likeliest
            value = max(tables.wait, pick)
            totals[action] += value
            squares[action] += value * value
