"""ExactAnswers: our search, which solves nothing ahead."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from numpy.random import Generator

from fetch_pomdp.checks import shown
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.compiled import Vector, compiled, lean
from fetch_pomdp.core.planners.base import MOST_DEPTH, MOST_WIDTH, Decision, whole_number
from fetch_pomdp.core.planners.kernels import NOBODY, SILENT, answered, draw_item, hear, leading
from fetch_pomdp.core.planners.search.leaf import answered_leaf, last_action, leaf_of, patient_last_action
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
from fetch_pomdp.errors import PlannerError

LeafName = Literal["pick", "question"]


@dataclass(frozen=True, slots=True)
class ExactAnswers:
    """Search that samples words and pointing once for all actions of a node, and sums the answers exactly.

    Words and pointing do not depend on the action, so one sample serves all questions and differences between actions
    carry little noise. What follows the last action looked at is closed by a leaf (see `search.leaf`): `pick`, or
    `question`. Width 0 stands for a number of samples by the number of items: 80 a node for small tables, 5 for
    100,000 items. Raises PlannerError for a depth or width that is no whole number in range, or an unknown leaf.
    """

    depth: int = 2
    width: int = 0
    leaf: LeafName = "question"

    def __post_init__(self) -> None:
        whole_number(self.depth, 1, MOST_DEPTH, "depth")
        whole_number(self.width, 0, MOST_WIDTH, "width")
        if self.leaf not in get_args(LeafName):
            raise PlannerError(f"found {shown(self.leaf)}, expected 'pick' or 'question'", field="leaf")

    def decide(self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0) -> Decision:
        """Choose the action with the highest value."""
        patient = self.leaf == "question"
        if self.depth == 1:
            return patient_last_action(problem, belief, asked) if patient else last_action(problem, belief)
        width = self.width or default_width(problem.n_items)
        search = Search(self.depth, width, problem.n_items, patient)
        return searched(plan_exact, problem, belief, asked, search, rng)


def default_width(n_items: int) -> int:
    """Return how many samples keep a decision of depth 2 under about 5 ms."""
    return max(5, min(80, 500_000 // n_items))


@compiled
def plan_exact(belief: Vector, asked: int, search: Search, seed: int, tables: Tables) -> RootValues:
    """Search with sampled words and pointing, shared by all actions, and answers summed exactly."""
    work = workspace(belief, asked, search.depth, seed, tables)
    cursor, level, last = work.cursor, 0, search.depth - 2
    while True:
        if level < last and next_answer(level, search, work, tables):
            level += 1
            enter(level, cursor["asked"][level], work, tables)
            continue
        if level == last:
            last_two_actions(level, search, work, tables)
        if level == 0:
            return root_values(search, work, tables)
        level -= 1
        cursor["sums"][level] += cursor["chance"][level] * best_of(level + 1, search, work, tables)


@lean
def next_answer(level: int, search: Search, work: Work, tables: Tables) -> bool:
    """Move a node's cursor to its next sample, action and answer and put the belief then one level down; False at the
    end.

    A sample has 3 branches an action: silence, yes, no; where nothing was asked a wait has one.
    """
    cursor, branches = work.cursor, 3 * (search.questions + 1)
    while True:
        sample, branch = divmod(cursor["branch"][level], branches)
        action, answer = branch // 3 - 1, branch % 3
        if answer == 0 and cursor["branch"][level] > 0:  # the sample's action before is complete
            before = search.questions - 1 if action < 0 else action - 1
            work.totals[level, before] += cursor["sums"][level]
            work.squares[level, before] += cursor["sums"][level] ** 2
            cursor["sums"][level] = 0.0
        if sample == search.width:
            return False
        if branch == 0:
            desired = draw_item(work.beliefs[level], (sample + cursor["offset"][level]) / search.width)
            hear(work.beliefs[level], cursor["smoothed"][level], desired, work.heard[level], work.state, tables)
        cursor["branch"][level] += 1
        about, rate = (cursor["asked"][level], tables.p_again) if action < 0 else (action, tables.p_l)
        if about == NOBODY and answer != SILENT:
            continue
        chance = answered(work.heard[level], about, answer, rate, work.beliefs[level + 1], tables)
        if chance > 0.0:
            cursor["chance"][level], cursor["asked"][level + 1] = chance, about
            return True


@lean
def last_two_actions(level: int, search: Search, work: Work, tables: Tables) -> None:
    """Fill in the totals of a node with two actions left: the answers summed over, then the leaf."""
    belief, heard, state = work.beliefs[level], work.heard[level], work.state
    totals, squares = work.totals[level], work.squares[level]
    asked, offset = work.cursor["asked"][level], work.cursor["offset"][level]
    smoothed = work.cursor["smoothed"][level]
    leaf = leaf_of(search.patient, tables)
    for sample in range(search.width):
        desired = draw_item(belief, (sample + offset) / search.width)
        hear(belief, smoothed, desired, heard, state, tables)
        top = leading(heard)
        value = answered_leaf(heard, asked, tables.p_again, top, leaf)
        totals[-1] += value
        squares[-1] += value * value
        for about in range(search.questions):
            value = answered_leaf(heard, about, tables.p_l, top, leaf)
            totals[about] += value
            squares[about] += value * value
