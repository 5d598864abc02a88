"""A node whose answers are summed exactly.

One sample of words and pointing serves all actions of a node; of each the answers are tried in turn. Before live people
words and pointing are likelier in the step of a question, so that the sample has two rows, from the same numbers.
"""

from __future__ import annotations

from fetch_pomdp.core.compiled import inlined, lean
from fetch_pomdp.core.planners.kernels import NOBODY, answered, draw_item, leading, turn_of
from fetch_pomdp.core.planners.search.leaf import answered_leaf, leaf_of
from fetch_pomdp.core.planners.search.tree import Search, Work, draw, following_phase, row_of
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.turns import SILENT


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
            draw(level, desired, work, tables)
        cursor["branch"][level] += 1
        turn = turn_of(cursor["asked"][level], cursor["phase"][level], action)
        if turn.about == NOBODY and answer != SILENT:
            continue
        chance = answered(work.heard[level, row_of(turn, tables)], turn, answer, work.beliefs[level + 1], tables)
        if chance > 0.0:
            cursor["chance"][level], cursor["asked"][level + 1] = chance, turn.about
            cursor["phase"][level + 1] = following_phase(level, turn, answer, work, tables)
            return True


@lean
def last_two_answered(level: int, search: Search, work: Work, tables: Tables) -> None:
    """Fill in the totals of a node with two actions left: the answers summed over, then the leaf."""
    totals, squares, cursor = work.totals[level], work.squares[level], work.cursor
    asked, phase, leaf = cursor["asked"][level], cursor["phase"][level], leaf_of(search.leaf_asks, tables)
    for sample in range(search.width):
        draw(level, draw_item(work.beliefs[level], (sample + cursor["offset"][level]) / search.width), work, tables)
        row, top = -1, leading(work.heard[level, 0])
        for action in range(-1, search.questions):
            turn = turn_of(asked, phase, action)
            if row_of(turn, tables) != row:
                row = row_of(turn, tables)
                top = leading(work.heard[level, row])
            silent = following_phase(level, turn, SILENT, work, tables)
            value = answered_leaf(work.heard[level, row], turn, tables.awaited[silent] == 1, top, leaf, tables)
            totals[action] += value
            squares[action] += value * value


@inlined
def add_answer(level: int, value: float, work: Work) -> None:
    """Add the value of the belief that the node's cursor is at."""
    work.cursor["sums"][level] += work.cursor["chance"][level] * value
