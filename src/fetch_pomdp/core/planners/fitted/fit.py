"""Fitted value iteration on the beliefs that the policy itself meets (Ernst et al. 2005; Munos and Szepesvari 2008).

A round plays interactions with the policy of the table so far, which now and then explores, looks ahead from every
belief met (`fitted.outlook`), and then sweeps: Bellman backups of all beliefs met, with answers summed exactly, and
a least-squares fit of the table to them. The fit is of an expectation, before the observation, so that the maximum over
actions is taken of fitted values and not of noise. Second differences of the table are held small where little is met.

After a round the share of the steps at which interactions are cut short is taken from the policy's own
(`fitted.rehearsal`). A share that is fixed for all tables makes robots hasty where stakes are high and nobody leaves.

Least squares are those of a table that is bilinear between its entries, with small second differences: an entry's place
is row * COLUMNS + column, and the matrix is a narrow band, so that Cholesky's factor and its solution need no SciPy. A
symmetric matrix is kept as (size, width): `band[row, k]` is the entry at (row, row - width + 1 + k), the diagonal last.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fetch_pomdp.core.compiled import RandomState, Vector, compiled, inlined, lean, random_state, uniform
from fetch_pomdp.core.planners.fitted.outlook import DistinctWords, look, outlook_size
from fetch_pomdp.core.planners.fitted.rehearsal import LONGEST, rehearse
from fetch_pomdp.core.planners.fitted.table import (
    ASK_FIRST,
    ASK_SECOND,
    COLUMNS,
    KINDS,
    OTHER,
    ROWS,
    Classes,
    Step,
    ValueTable,
    answered_value,
    cell_of,
    class_breaks,
    classes_of,
    closed_form,
    first_table,
    closeness,
    kind_of,
    pair_class,
    table_action,
    with_other,
)
from fetch_pomdp.core.planners.kernels import ASKED, NOBODY, WAITED, Leading, leading, live_step, smoothed_mass
from fetch_pomdp.core.problem import Problem, Tables

ROUNDS, SWEEPS = 3, 10
REHEARSED = 500  # interactions, which show how many are cut short
EXPLORES = 0.25  # share of the steps that explore: half of them wait, and more ask about the first than the second
PATIENT = 0.5  # share of the interactions that pick at no belief below one drawn uniformly
ANSWERED = 0.2  # i_r that is no leader counts as answered up to this share of b2
CERTAIN = 0.05  # b2 below which a pair is none
UNFITTED = KINDS  # a wait between two kinds
SMOOTHNESS = 0.2  # weight of a squared second difference, as of so many backups
ANCHOR = 1e-3  # weight of the table before, so that a cell never met stays
WIDTH = 2 * COLUMNS + 1  # of the band: second differences reach two rows

# A belief met: its leading items, where it lies in the table, i_r and the kind of a wait.
NODE = np.dtype([
    ("first", np.int64), ("second", np.int64), ("asked", np.int64), ("kind", np.int64), ("cls", np.int64),
    ("phase", np.int64), ("table", np.int64),
    ("b1", np.float64), ("b2", np.float64),
])  # fmt: skip
# A belief of its outlook: leaders, classes of their pairs, and beliefs in i_r and the two leaders before, each with the
# class of its pair with the first now.
NEXT = np.dtype([
    ("wait", np.float32), ("ask", np.float32), ("words", np.int8), ("seen", np.int8), ("b1", np.float32), ("b2", np.float32), ("b3", np.float32),
    ("i1", np.int32), ("i2", np.int32), ("i3", np.int32), ("c12", np.int8), ("c13", np.int8), ("c23", np.int8),
    ("own", np.float32, (3,)), ("with_own", np.int8, (3,)),
])  # fmt: skip


def fitted(problem: Problem, distinct: DistinctWords, count: int, seed: int) -> ValueTable:
    """Return the value table of a problem, fitted on `count` beliefs a round; same seed, same table."""
    tables = problem.tables
    groups = int(tables.alike.max()) + 1
    start = ValueTable(np.repeat(closed_form(tables), groups, axis=0), np.empty(0))
    close = np.empty(count // 4)
    breaks = class_breaks(close[: pairs_met(start, close, random_state(seed), tables)])
    table = ValueTable(np.repeat(start.values, len(breaks) + 1, axis=0), breaks)
    smooth = smoothness()
    nodes, nexts = np.zeros(count, NODE), np.zeros((count, outlook_size(distinct, tables)), NEXT)
    for number in range(ROUNDS):
        meet(table, nodes, nexts, random_state(seed + 1 + number), distinct, tables)
        lower = np.tile(smooth, (len(table.values), KINDS, 1, 1))
        normal_matrices(nodes, lower)
        for _ in range(SWEEPS):
            sweep(table, nodes, nexts, lower, tables)
        if number < ROUNDS - 1:
            table = table._replace(ends=rehearse(table, 1.0, REHEARSED, seed, tables, tables).ends)
    return table


@compiled
def pairs_met(table: ValueTable, close: Vector, state: RandomState, tables: Tables) -> int:
    """Fill in the closenesses of leading pairs that are met; return how many."""
    count, belief, work = len(tables.smoothing), np.empty(len(tables.smoothing)), np.empty(len(tables.smoothing))
    found = 0
    for _ in range(len(close)):
        for item in range(count):
            belief[item] = 1.0 / count
        desired, asked, phase = int(uniform(state) * count), NOBODY, 0
        least = uniform(state) if uniform(state) < PATIENT else 0.0
        for _step in range(LONGEST):
            asked, phase = explored_step(belief, asked, phase, desired, least, table, work, state, tables)
            if asked == count:
                break
            top = leading(belief)
            if top.b2 > CERTAIN:
                close[found] = closeness(top.first, top.second, tables)
                found += 1
            if found == len(close):
                return found
    return found


@lean
def explored_step(
    belief: Vector,
    asked: int,
    phase: int,
    desired: int,
    least: float,
    table: ValueTable,
    work: Vector,
    state: RandomState,
    tables: Tables,
) -> tuple[int, int]:
    """Go on by a step that may explore, and replace the belief; return i_r, or n_items after a pick, and the phase."""
    action = explored(belief, asked, phase, least, table, state, tables)
    if action >= len(belief):
        return len(belief), phase
    kind = WAITED if action == NOBODY else ASKED
    about = asked if action == NOBODY else action
    return about, live_step(belief, smoothed_mass(belief, tables), desired, about, phase, kind, work, state, tables)


@lean
def explored(belief: Vector, asked: int, phase: int, least: float, table: ValueTable, state: RandomState, tables: Tables) -> int:
    """Return the table's action, or now and then another that goes on; nothing is picked below the belief `least`.

    NOBODY is a wait, an item below n_items a question about it, n_items and more a pick.
    """
    top = leading(belief)
    action = table_action(belief, asked, phase, top, table, tables)
    drawn = uniform(state)
    if drawn >= EXPLORES and not (action >= len(belief) and top.b1 < least):
        return action
    which = uniform(state)
    if which < 0.5:
        return NOBODY
    return top.first if which < 0.8 else top.second


@compiled
def meet(
    table: ValueTable, nodes: Any, nexts: Any, state: RandomState, distinct: DistinctWords, tables: Tables
) -> None:
    """Fill in the beliefs that interactions meet, and their outlooks."""
    count = len(tables.smoothing)
    belief, work = np.empty(count), np.empty(count)
    met = 0
    while met < len(nodes):
        for item in range(count):
            belief[item] = 1.0 / count
        desired, asked, phase = int(uniform(state) * count), NOBODY, 0
        least = uniform(state) if uniform(state) < PATIENT else 0.0
        for _step in range(LONGEST):
            if met == len(nodes):
                break
            note(belief, asked, phase, nodes, met, table.breaks, tables)
            look_ahead(belief, nodes, nexts, met, table.breaks, work, state, distinct, tables)
            met += 1
            asked, phase = explored_step(belief, asked, phase, desired, least, table, work, state, tables)
            if asked == count:
                break


@inlined
def note(belief: Vector, asked: int, phase: int, nodes: Any, index: int, breaks: Vector, tables: Tables) -> None:
    """Fill in a node."""
    top = leading(belief)
    kind = kind_of(asked, top.first, top.second)
    if kind == OTHER and belief[asked] > ANSWERED * top.b2:
        kind = UNFITTED
    nodes["first"][index], nodes["second"][index], nodes["asked"][index] = top.first, top.second, asked
    nodes["kind"][index], nodes["b1"][index], nodes["b2"][index] = kind, top.b1, top.b2
    cls = pair_class(top.first, top.second, breaks, tables)
    nodes["cls"][index], nodes["phase"][index] = cls, phase
    nodes["table"][index] = first_table(phase, breaks, tables) + cls


@inlined
def look_ahead(
    belief: Vector,
    nodes: Any,
    nexts: Any,
    index: int,
    breaks: Vector,
    heard: Vector,
    state: RandomState,
    distinct: DistinctWords,
    tables: Tables,
) -> None:
    """Fill in a node's outlook."""
    smoothed = smoothed_mass(belief, tables)
    for number in range(nexts.shape[1]):
        seen = look(number, belief, smoothed, nodes["phase"][index], heard, state, distinct, tables)
        nexts["wait"][index, number], nexts["ask"][index, number] = seen.wait, seen.ask
        nexts["words"][index, number], nexts["seen"][index, number] = seen.words, seen.seen
        top = leading(heard)
        classes = classes_of(top, breaks, tables)
        nexts["b1"][index, number], nexts["b2"][index, number] = top.b1, top.b2
        nexts["b3"][index, number], nexts["i1"][index, number] = top.b3, top.first
        nexts["i2"][index, number], nexts["i3"][index, number] = top.second, top.third
        nexts["c12"][index, number], nexts["c13"][index, number] = classes.first_second, classes.first_third
        nexts["c23"][index, number] = classes.second_third
        for slot in range(3):
            about = marked(nodes, index, slot)
            nexts["own"][index, number, slot] = heard[about] if about != NOBODY else 0.0
            other = with_other(classes, about, top, breaks, tables).other_first
            nexts["with_own"][index, number, slot] = other


@inlined
def marked(nodes: Any, index: int, slot: int) -> int:
    """Return the item that an action of a node asks about: a wait about i_r, then its first and its second."""
    if slot == 0:
        return int(nodes["asked"][index])
    return int(nodes["first"][index] if slot == 1 else nodes["second"][index])


@lean
def backed_up(index: int, slot: int, table: ValueTable, nodes: Any, nexts: Any, tables: Tables) -> float:
    """Return the expected value after an action of a node, over its outlook and the answers."""
    about, kind, phase = marked(nodes, index, slot), WAITED if slot == 0 else ASKED, nodes["phase"][index]
    total = 0.0
    for number in range(nexts.shape[1]):
        top = Leading(
            nexts["i1"][index, number], nexts["i2"][index, number], nexts["i3"][index, number],
            float(nexts["b1"][index, number]), float(nexts["b2"][index, number]), float(nexts["b3"][index, number]),
        )  # fmt: skip
        classes = Classes(
            nexts["c12"][index, number], nexts["c13"][index, number], nexts["c23"][index, number],
            nexts["with_own"][index, number, slot],
        )  # fmt: skip
        own = float(nexts["own"][index, number, slot])
        step = Step(phase, kind, nexts["words"][index, number], nexts["seen"][index, number])
        chance = float(nexts["wait"][index, number]) if slot == 0 else float(nexts["ask"][index, number])
        total += chance * answered_value(table, classes, top, about, own, step, tables)
    return total


@compiled
def normal_matrices(nodes: Any, lower: Vector) -> None:
    """Add to (classes, KINDS, entries, WIDTH) what the nodes weigh in least squares, and factor it."""
    for index in range(len(nodes)):
        cell = cell_of(nodes["b1"][index], nodes["b2"][index])
        for slot in range(3):
            kind = slot_kind(nodes, index, slot)
            if kind != UNFITTED:
                add_row(lower[nodes["table"][index], kind], cell.row, cell.column, cell.down, cell.along)
    for cls in range(lower.shape[0]):
        for kind in range(KINDS):
            factor(lower[cls, kind])


@inlined
def slot_kind(nodes: Any, index: int, slot: int) -> int:
    """Return the kind of a node's action."""
    return int(nodes["kind"][index]) if slot == 0 else ASK_FIRST if slot == 1 else ASK_SECOND


@compiled
def sweep(table: ValueTable, nodes: Any, nexts: Any, lower: Vector, tables: Tables) -> None:
    """Back all nodes up under the table, and replace it by the fit."""
    values = table.values
    classes = values.shape[0]
    right = np.empty((classes, KINDS, ROWS * COLUMNS))
    for cls in range(classes):
        for kind in range(KINDS):
            for entry in range(ROWS * COLUMNS):
                right[cls, kind, entry] = ANCHOR * values[cls, entry // COLUMNS, entry % COLUMNS, kind]
    for index in range(len(nodes)):
        cell = cell_of(nodes["b1"][index], nodes["b2"][index])
        for slot in range(3):
            kind = slot_kind(nodes, index, slot)
            if kind == UNFITTED:
                continue
            value = backed_up(index, slot, table, nodes, nexts, tables)
            for one in range(4):
                entry = (cell.row + one // 2) * COLUMNS + cell.column + one % 2
                right[nodes["table"][index], kind, entry] += corner(one, cell.down, cell.along) * value
    for cls in range(classes):
        for kind in range(KINDS):
            solve(lower[cls, kind], right[cls, kind])
            for entry in range(ROWS * COLUMNS):
                value = min(right[cls, kind, entry], tables.pick_correct)
                values[cls, entry // COLUMNS, entry % COLUMNS, kind] = value


@compiled
def factor(band: Vector) -> None:
    """Replace a positive definite matrix by its lower Cholesky factor, in place."""
    size, width = band.shape
    for row in range(size):
        for k in range(width):
            column = row - width + 1 + k
            if column < 0:
                continue
            total = band[row, k]
            for inner in range(max(0, row - width + 1, column - width + 1), column):
                total -= band[row, inner - row + width - 1] * band[column, inner - column + width - 1]
            band[row, k] = math.sqrt(total) if column == row else total / band[column, width - 1]


@compiled
def solve(lower: Vector, right: Vector) -> None:
    """Replace the right-hand side, (size,), by the solution, in place; lower: what `factor` left."""
    size, width = lower.shape
    for row in range(size):
        for column in range(max(0, row - width + 1), row):
            right[row] -= lower[row, column - row + width - 1] * right[column]
        right[row] /= lower[row, width - 1]
    for row in range(size - 1, -1, -1):
        right[row] /= lower[row, width - 1]
        for column in range(max(0, row - width + 1), row):
            right[column] -= lower[row, column - row + width - 1] * right[row]


def smoothness() -> Vector:
    """Return the penalty on second differences of a table's entries, as a band."""
    band = np.zeros((ROWS * COLUMNS, WIDTH))
    for row in range(ROWS):
        for column in range(COLUMNS):
            here = row * COLUMNS + column
            for inside, apart in ((0 < row < ROWS - 1, COLUMNS), (0 < column < COLUMNS - 1, 1)):
                if inside:
                    add_outer(band, (here - apart, here, here + apart), (1.0, -2.0, 1.0), SMOOTHNESS)
    band[:, -1] += ANCHOR
    return band


def add_outer(band: Vector, places: tuple[int, int, int], weights: tuple[float, float, float], scale: float) -> None:
    """Add the outer product of a sparse vector with itself to a band."""
    for row, one in zip(places, weights, strict=True):
        for column, other in zip(places, weights, strict=True):
            if column <= row:
                band[row, column - row + WIDTH - 1] += scale * one * other


@lean
def add_row(band: Vector, row: int, column: int, down: float, along: float) -> None:
    """Add the outer product of the weights of a cell's four corners."""
    for one in range(4):
        here = (row + one // 2) * COLUMNS + column + one % 2
        weight = corner(one, down, along)
        for other in range(one + 1):
            there = (row + other // 2) * COLUMNS + column + other % 2
            band[here, there - here + WIDTH - 1] += weight * corner(other, down, along)


@inlined
def corner(number: int, down: float, along: float) -> float:
    """Return the bilinear weight of one of a cell's corners."""
    return (down if number // 2 else 1.0 - down) * (along if number % 2 else 1.0 - along)
