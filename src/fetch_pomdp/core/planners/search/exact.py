"""A node whose answers are summed exactly.

Words and pointing do not depend on the action, so one sample of them serves all actions of a node; of each the answers
are tried in turn.
"""

from __future__ import annotations

from fetch_pomdp.core.compiled import inlined, lean
from fetch_pomdp.core.planners.kernels import NOBODY, SILENT, answered, draw_item, hear, leading, turn_of
from fetch_pomdp.core.planners.search.leaf import answered_leaf, leaf_of
from fetch_pomdp.core.planners.search.tree import Search, Work
from fetch_pomdp.core.problem import Tables


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
        about, rate = turn_of(cursor["asked"][level], action, tables)
        if about == NOBODY and answer != SILENT:
            continue
        chance = answered(work.heard[level], about, answer, rate, work.beliefs[level + 1], tables)
        if chance > 0.0:
            cursor["chance"][level], cursor["asked"][level + 1] = chance, about
            return True


@lean
def last_two_answered(level: int, search: Search, work: Work, tables: Tables) -> None:
    """Fill in the totals of a node with two actions left: the answers summed over, then the leaf."""
    belief, heard, state = work.beliefs[level], work.heard[level], work.state
    totals, squares = work.totals[level], work.squares[level]
    asked, offset = work.cursor["asked"][level], work.cursor["offset"][level]
    smoothed = work.cursor["smoothed"][level]
    leaf = leaf_of(search.leaf_asks, tables)
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


@inlined
def add_answer(level: int, value: float, work: Work) -> None:
    """Add the value of the belief that the node's cursor is at."""
    work.cursor["sums"][level] += work.cursor["chance"][level] * value
