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
from typing import Any, NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled, inlined, lean, random_state, uniform
from fetch_pomdp.core.planners.fitted.ahead import Lookahead
from fetch_pomdp.core.planners.fitted.outlook import DistinctWords, look, outlook_size
from fetch_pomdp.core.planners.fitted.rehearsal import Policy, rehearse
from fetch_pomdp.core.planners.fitted.table import (
    ASK_FIRST,
    ASK_SECOND,
    COLUMNS,
    KINDS,
    OTHER,
    ROWS,
    Classes,
    ValueTable,
    answered_value,
    class_breaks,
    classes_of,
    closed_form,
    closeness,
    first_table,
    kind_of,
    pair_class,
    picks_now,
    place_of,
    table_action,
    with_other,
)
from fetch_pomdp.core.planners.kernels import NOBODY, Came, Leading, leading, live_step, smoothed_mass, turn_of
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.simulation import MOST_STEPS

ROUNDS, SWEEPS = 3, 10
REHEARSED = 500  # interactions, which show how many are cut short
EXPLORES = 0.25  # share of the steps that explore: half of them wait, and more ask about the first than the second
JUMPS = 0.1  # share of the steps that find live people in any phase: few fall silent of themselves
RELUCTANT = 0.5  # share of the interactions that pick at no belief below one drawn uniformly
ANSWERED = 0.2  # i_r that is no leader counts as answered up to this share of b2
CERTAIN = 0.05  # b2 below which there is no second leader
UNFITTED = KINDS  # a wait between two kinds
SMOOTHNESS = 0.2  # weight of a squared second difference, as of so many backups
ANCHOR = 1e-3  # weight of the table before, so that a cell never met stays
WIDTH = 2 * COLUMNS + 1  # of the band: second differences reach two rows

# A belief met: its leading items, where it lies in the table, i_r and the kind of a wait.
NODE = np.dtype([
    ("first", np.int64), ("second", np.int64), ("asked", np.int64), ("phase", np.int64), ("kind", np.int64),
    ("table", np.int64), ("b1", np.float64), ("b2", np.float64),
])  # fmt: skip
# A belief of its outlook: leaders, classes of their pairs, and beliefs in i_r and the two leaders before, each with the
# class of its pair with the first now.
NEXT = np.dtype([
    ("wait", np.float32), ("ask", np.float32), ("words", np.int8), ("seen", np.int8),
    ("b1", np.float32), ("b2", np.float32), ("b3", np.float32),
    ("i1", np.int32), ("i2", np.int32), ("i3", np.int32), ("c12", np.int8), ("c13", np.int8), ("c23", np.int8),
    ("own", np.float32, (3,)), ("with_own", np.int8, (3,)),
])  # fmt: skip


# An interaction that goes on: the item desired, i_r, the phase, how many steps it has had, and what it explores with.
NOW = np.dtype([
    ("desired", np.int64), ("asked", np.int64), ("phase", np.int64), ("steps", np.int64), ("least", np.float64),
])  # fmt: skip


class Walk(NamedTuple):
    """An interaction that explores, and its random numbers."""

    now: Any  # (1,) of NOW
    belief: Vector  # (n_items,)
    heard: Vector  # (n_items,), memory
    state: RandomState
    doors: Integers  # (groups,), the first phase of each group of phases


class Met(NamedTuple):
    """Beliefs met, and their outlooks."""

    nodes: Any  # (k,) of NODE
    nexts: Any  # (k, size of an outlook) of NEXT


def fitted(problem: Problem, distinct: DistinctWords, count: int, seed: int) -> ValueTable:
    """Return the value table of a problem, fitted on `count` beliefs a round; same seed, same table."""
    tables = problem.tables
    groups = int(tables.alike.max()) + 1
    first = picks_now(tables) if groups > 1 else closed_form(tables)
    start = ValueTable(np.repeat(first, groups, axis=0), np.empty(0))
    close = np.empty(count // 4)
    breaks = class_breaks(close[: pairs_met(start, close, random_state(seed), tables)])
    table = ValueTable(np.repeat(start.values, len(breaks) + 1, axis=0), breaks)
    smooth = smoothness()
    met = Met(np.zeros(count, NODE), np.zeros((count, outlook_size(distinct, tables)), NEXT))
    for number in range(ROUNDS):
        meet(Lookahead(table, distinct, tables), met, random_state(seed + 1 + number))
        lower = np.tile(smooth, (len(table.values), KINDS, 1, 1))
        normal_matrices(met.nodes, lower)
        for _ in range(SWEEPS):
            sweep(table, met, lower, tables)
        if number < ROUNDS - 1:
            table = table._replace(ends=rehearse(Policy(table, 1.0, tables), REHEARSED, seed, problem).ends)
    return table


@compiled
def pairs_met(table: ValueTable, close: Vector, state: RandomState, tables: Tables) -> int:
    """Fill in the closenesses of leading pairs that are met; return how many."""
    walk, found = walk_of(state, tables), 0
    for _ in range(len(close)):
        begin(walk)
        while walk.now["steps"][0] < MOST_STEPS and go_on(walk, table, tables):
            top = leading(walk.belief)
            if top.b2 > CERTAIN:
                close[found] = closeness(top.first, top.second, tables)
                found += 1
            if found == len(close):
                return found
    return found


@compiled
def meet(ahead: Lookahead, met: Met, state: RandomState) -> None:
    """Fill in the beliefs that interactions meet, and their outlooks."""
    walk = walk_of(state, ahead.tables)
    begin(walk)
    for index in range(len(met.nodes)):
        note(walk, met.nodes, index, ahead)
        look_ahead(walk.belief, met, index, ahead, walk.heard, state)
        if not go_on(walk, ahead.table, ahead.tables) or walk.now["steps"][0] == MOST_STEPS:
            begin(walk)


@compiled
def walk_of(state: RandomState, tables: Tables) -> Walk:
    """Return the memory of interactions that explore."""
    count = len(tables.smoothing)
    doors = np.zeros(tables.alike.max() + 1, dtype=np.int64)
    for phase in range(len(tables.alike) - 1, -1, -1):
        doors[tables.alike[phase]] = phase
    return Walk(np.zeros(1, NOW), np.empty(count), np.empty(count), state, doors)


@lean
def begin(walk: Walk) -> None:
    """Begin an interaction anew."""
    count, now = len(walk.belief), walk.now
    for item in range(count):
        walk.belief[item] = 1.0 / count
    now["desired"][0], now["asked"][0], now["phase"][0] = int(uniform(walk.state) * count), NOBODY, 0
    now["steps"][0] = 0
    now["least"][0] = uniform(walk.state) if uniform(walk.state) < RELUCTANT else 0.0


@lean
def go_on(walk: Walk, table: ValueTable, tables: Tables) -> bool:
    """Go on by a step that may explore, and replace the belief; False after a pick."""
    now, belief = walk.now, walk.belief
    action = explored(belief, now["asked"][0], now["phase"][0], now["least"][0], table, walk.state, tables)
    if action >= len(belief):
        return False
    now["steps"][0] += 1
    if len(walk.doors) > 1 and uniform(walk.state) < JUMPS:
        now["phase"][0] = walk.doors[int(uniform(walk.state) * len(walk.doors))]
    turn = turn_of(now["asked"][0], now["phase"][0], action)
    now["asked"][0] = turn.about
    now["phase"][0] = live_step(belief, turn, now["desired"][0], walk.heard, walk.state, tables)
    return True


@lean
def explored(
    belief: Vector, asked: int, phase: int, least: float, table: ValueTable, state: RandomState, tables: Tables
) -> int:
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


@inlined
def note(walk: Walk, nodes: Any, index: int, ahead: Lookahead) -> None:
    """Fill in a node."""
    belief, asked, phase = walk.belief, walk.now["asked"][0], walk.now["phase"][0]
    top = leading(belief)
    kind = kind_of(asked, top.first, top.second)
    if kind == OTHER and belief[asked] > ANSWERED * top.b2:
        kind = UNFITTED
    nodes["first"][index], nodes["second"][index], nodes["asked"][index] = top.first, top.second, asked
    nodes["kind"][index], nodes["b1"][index], nodes["b2"][index] = kind, top.b1, top.b2
    nodes["phase"][index], nodes["table"][index] = phase, first_table(phase, ahead.table.breaks, ahead.tables)
    nodes["table"][index] += pair_class(top.first, top.second, ahead.table.breaks, ahead.tables)


@inlined
def look_ahead(belief: Vector, met: Met, index: int, ahead: Lookahead, heard: Vector, state: RandomState) -> None:
    """Fill in a node's outlook."""
    nexts, breaks, tables = met.nexts, ahead.table.breaks, ahead.tables
    smoothed, phase = smoothed_mass(belief, tables), met.nodes["phase"][index]
    for number in range(nexts.shape[1]):
        seen = look(number, belief, smoothed, phase, heard, state, ahead.distinct, tables)
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
            about = marked(met.nodes, index, slot)
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
def backed_up(index: int, slot: int, table: ValueTable, met: Met, tables: Tables) -> float:
    """Return the expected value after an action of a node, over its outlook and the answers."""
    nexts, total = met.nexts, 0.0
    turn = turn_of(
        met.nodes["asked"][index], met.nodes["phase"][index], NOBODY if slot == 0 else marked(met.nodes, index, slot)
    )
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
        came = Came(nexts["words"][index, number], nexts["seen"][index, number])
        chance = float(nexts["wait"][index, number]) if slot == 0 else float(nexts["ask"][index, number])
        total += chance * answered_value(table, classes, top, own, turn, came, tables)
    return total


@compiled
def normal_matrices(nodes: Any, lower: Vector) -> None:
    """Add to (classes, KINDS, entries, WIDTH) what the nodes weigh in least squares, and factor it."""
    for index in range(len(nodes)):
        place = place_of(nodes["b1"][index], nodes["b2"][index])
        for slot in range(3):
            kind = slot_kind(nodes, index, slot)
            if kind != UNFITTED:
                add_row(lower[nodes["table"][index], kind], place.row, place.column, place.down, place.along)
    for cls in range(lower.shape[0]):
        for kind in range(KINDS):
            factor(lower[cls, kind])


@inlined
def slot_kind(nodes: Any, index: int, slot: int) -> int:
    """Return the kind of a node's action."""
    return int(nodes["kind"][index]) if slot == 0 else ASK_FIRST if slot == 1 else ASK_SECOND


@compiled
def sweep(table: ValueTable, met: Met, lower: Vector, tables: Tables) -> None:
    """Back all nodes up under the table, and replace it by the fit."""
    values, nodes = table.values, met.nodes
    classes = values.shape[0]
    right = np.empty((classes, KINDS, ROWS * COLUMNS))
    for cls in range(classes):
        for kind in range(KINDS):
            for entry in range(ROWS * COLUMNS):
                right[cls, kind, entry] = ANCHOR * values[cls, entry // COLUMNS, entry % COLUMNS, kind]
    for index in range(len(nodes)):
        place = place_of(nodes["b1"][index], nodes["b2"][index])
        for slot in range(3):
            kind = slot_kind(nodes, index, slot)
            if kind == UNFITTED:
                continue
            value = backed_up(index, slot, table, met, tables)
            for one in range(4):
                entry = (place.row + one // 2) * COLUMNS + place.column + one % 2
                right[nodes["table"][index], kind, entry] += corner(one, place.down, place.along) * value
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
