"""The value of having acted, as a table over the leading pair of a belief, and what follows from it.

A node is a belief b1 >= b2 >= b3 ... and i_r. The table holds the expected value after an action and before its
observation (an afterstate: Sutton and Barto 2018, Section 6.8), for six kinds of node and action; the axes are b1 and
b2 / min(b1, 1 - b1). With W the table,

    V = max(pick of the first, wait + W[wait, i_r], point + max(W[ask the first], W[ask the second])).

Where people leave, or the robot has to pick after so many steps, a share of the interactions ends at each node with a
pick of the first: V becomes (1 - ends) V + ends * pick.

Where i_r is neither the first nor the second item, a wait's value lies between that of an answer that can come no more
(its belief is 0) and that of i_r being the second (its belief is b2). One table for all of these over-rated waits after
an answered question by several points: its policies waited for ever between two twins.

Two twins and two different items may have the same beliefs, and yet a wait is worth nothing between the first and much
between the second. So there is a table for each class of leading pairs, by how alike the two are to what is heard and
seen: what a wait can tell about them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Vector, compiled, inlined, lean
from fetch_pomdp.core.planners.kernels import NOBODY, Came, Leading, Turn, answer_weights, pick_value
from fetch_pomdp.core.planners.search.leaf import leaf_of, leaf_value
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.turns import DESIRED, NO, SILENT, YES
from fetch_pomdp.core.turns import OTHER as OTHER_DESIRED

MOST_CLASSES = 3
_LLOYD_ROUNDS = 20
_RAREST = 0.03  # share of the pairs seen: a class of fewer has too little to be fitted on
ROWS, COLUMNS = 33, 9
KINDS = 6
UNASKED, FIRST, SECOND, OTHER, ASK_FIRST, ASK_SECOND = range(KINDS)


class ValueTable(NamedTuple):
    """A fitted value: `values` (groups * classes, ROWS, COLUMNS, KINDS) in points, and the breaks between classes.

    Groups are those of `turns.Phases.alike`; the table of a group and a class is number group * classes + class.
    """

    values: Vector
    breaks: Vector
    ends: float = 0.0  # share of the interactions that a step ends with a forced pick


class Place(NamedTuple):
    """A place in the table, by its lower corner and how far it is on to the next."""

    row: int
    column: int
    down: float
    along: float


class Classes(NamedTuple):
    """Classes of the pairs of a node's leading items, and of an item that is none of the first two with the first."""

    first_second: int
    first_third: int
    second_third: int
    other_first: int


@inlined
def closeness(one: int, other: int, tables: Tables) -> float:
    """Return the Bhattacharyya coefficient of a step's base words and pointing under two items; 1 for twins in a place.

    Words by Eq. 4 and 5. Pointing as if on a plane: rays spread by sigma around two directions.
    """
    shared = 0
    starts, words = tables.item_starts, tables.item_words
    for left in range(starts[one], starts[one + 1]):
        for right in range(starts[other], starts[other + 1]):
            if words[left] == words[right]:
                shared += 1
    own = starts[one + 1] - starts[one] + starts[other + 1] - starts[other] - 2 * shared
    alpha, rest = tables.alpha, len(tables.word_starts) - 1 - own - shared
    mass = shared * (1.0 + alpha) + own * math.sqrt(alpha * (1.0 + alpha)) + rest * alpha
    word = mass * math.sqrt(tables.smoothing[one] * tables.smoothing[other])
    a, b = tables.directions[one], tables.directions[other]
    ray = math.exp((a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - 1.0) / (4.0 * tables.sigma * tables.sigma))
    return float((1.0 - tables.p_l + tables.p_l * word) * (1.0 - tables.p_g + tables.p_g * ray))


@inlined
def pair_class(one: int, other: int, breaks: Vector, tables: Tables) -> int:
    """Return the class of a pair: how many of the rising `breaks` its closeness is above."""
    if len(breaks) == 0:
        return 0
    found, close = 0, closeness(one, other, tables)
    for limit in breaks:
        if close > limit:
            found += 1
    return found


def class_breaks(seen: Vector) -> Vector:
    """Return the breaks between up to MOST_CLASSES classes of the closenesses seen, (n,), by one-dimensional k-means.

    Classes are compact in the logarithm of what a step tells, log(1 / closeness - 1): what counts is how many waits it
    takes to tell a pair apart.
    """
    if not len(seen):
        return np.empty(0)
    told = np.log(1.0 / np.minimum(seen, 1.0 - 1e-4) - 1.0 + 1e-3)
    if np.ptp(told) < 0.1:
        return np.empty(0)
    centres = np.linspace(told.min(), told.max(), MOST_CLASSES)
    nearest = np.abs(told[:, None] - centres).argmin(axis=1)
    for _ in range(_LLOYD_ROUNDS):
        members = [told[nearest == index] for index in range(MOST_CLASSES)]
        centres = np.array([own.mean() if len(own) else old for own, old in zip(members, centres, strict=True)])
        nearest = np.abs(told[:, None] - centres).argmin(axis=1)
    shares = np.bincount(nearest, minlength=MOST_CLASSES) / len(told)
    kept = np.sort(centres[shares >= _RAREST])
    return np.sort(1.0 / (np.exp((kept[1:] + kept[:-1]) / 2.0) - 1e-3 + 1.0))


@inlined
def place_of(b1: float, b2: float) -> Place:
    """Return where the table has two leading beliefs."""
    x = b1 * (ROWS - 1)
    most = min(b1, 1.0 - b1)
    y = min(b2 / most, 1.0) * (COLUMNS - 1) if most > 1e-12 else 0.0
    row, column = min(int(x), ROWS - 2), min(int(y), COLUMNS - 2)
    return Place(row, column, x - row, y - column)


@inlined
def at(values: Vector, cls: int, kind: int, place: Place) -> float:
    """Return the table's value at a place, bilinear between its entries."""
    row, column, down, along = place
    upper = (1.0 - along) * values[cls, row, column, kind] + along * values[cls, row, column + 1, kind]
    lower = (1.0 - along) * values[cls, row + 1, column, kind] + along * values[cls, row + 1, column + 1, kind]
    return float((1.0 - down) * upper + down * lower)


@inlined
def kind_of(asked: int, first: int, second: int) -> int:
    """Return which kind of wait it is with i_r."""
    if asked == NOBODY:
        return UNASKED
    if asked == first:
        return FIRST
    return SECOND if asked == second else OTHER


@inlined
def waited(values: Vector, cls: int, kind: int, share: float, place: Place) -> float:
    """Return the value of having waited; share: belief in i_r over b2 where i_r is neither leader."""
    if kind != OTHER:
        return at(values, cls, kind, place)
    return (1.0 - share) * at(values, cls, OTHER, place) + share * at(values, cls, SECOND, place)


@inlined
def node_value(table: ValueTable, cls: int, b1: float, b2: float, kind: int, share: float, tables: Tables) -> float:
    """Return the value of a node, V."""
    place = place_of(b1, b2)
    pick = pick_value(b1, tables)
    best = max(pick, tables.wait + waited(table.values, cls, kind, share, place))
    best = max(
        best, tables.point + max(at(table.values, cls, ASK_FIRST, place), at(table.values, cls, ASK_SECOND, place))
    )
    return (1.0 - table.ends) * best + table.ends * pick


@inlined
def classes_of(top: Leading, breaks: Vector, tables: Tables) -> Classes:
    """Return the classes of the pairs of the three leading items."""
    one = pair_class(top.first, top.second, breaks, tables)
    two = pair_class(top.first, top.third, breaks, tables)
    return Classes(one, two, pair_class(top.second, top.third, breaks, tables), 0)


@inlined
def with_other(classes: Classes, about: int, top: Leading, breaks: Vector, tables: Tables) -> Classes:
    """Return the classes with that of an item asked about, if it is none of the first two, with the first."""
    if about in (NOBODY, top.first, top.second):
        return classes
    other = pair_class(about, top.first, breaks, tables)
    return Classes(classes.first_second, classes.first_third, classes.second_third, other)


@inlined
def first_table(phase: int, breaks: Vector, tables: Tables) -> int:
    """Return the number of the table of a phase and the first class of pairs."""
    return int(tables.alike[phase]) * (len(breaks) + 1)


@lean
def answered_value(
    table: ValueTable, classes: Classes, top: Leading, own: float, turn: Turn, came: Came, tables: Tables
) -> float:
    """Return the expected value of the nodes after an answer, or silence, about an item (Eq. 6, Table I).

    own: belief in the item asked about. An answer scales it against all others alike, so the leaders decide.
    """
    about, cls, breaks = turn.about, classes.first_second, table.breaks
    following = tables.following[turn.phase, turn.kind, came.words, came.seen]
    group = first_table(following[SILENT], breaks, tables)
    if about == NOBODY:
        return node_value(table, group + cls, top.b1, top.b2, UNASKED, 0.0, tables)
    o1, o2, with_own, without = top.b1, top.b2, classes.other_first, cls
    if about == top.first:
        o1, o2, with_own, without = top.b2, top.b3, cls, classes.second_third
    elif about == top.second:
        o2, with_own, without = top.b3, cls, classes.first_third
    rate, if_desired = (
        tables.chances[turn.phase, turn.kind, OTHER_DESIRED],
        tables.chances[turn.phase, turn.kind, DESIRED],
    )
    total, first = 0.0, SILENT
    if rate == if_desired:  # then silence tells nothing
        share = own / top.b2 if top.b2 > 0.0 else 0.0
        kind = kind_of(about, top.first, top.second)
        total, first = (1.0 - rate) * node_value(table, group + cls, top.b1, top.b2, kind, share, tables), YES
    for answer in range(first, NO + 1):
        for_own, for_other = answer_weights(answer, rate, if_desired, tables)
        chance = for_own * own + for_other * (1.0 - own)
        if chance <= 0.0:
            continue
        group = first_table(following[answer], breaks, tables)
        b, q1, q2 = for_own * own / chance, for_other * o1 / chance, for_other * o2 / chance
        if b >= q1:
            value = node_value(table, group + with_own, b, q1, FIRST, 0.0, tables)
        elif b >= q2:
            value = node_value(table, group + with_own, q1, b, SECOND, 0.0, tables)
        else:
            value = node_value(table, group + without, q1, q2, OTHER, b / q2, tables)
        total += (1.0 - rate if answer == SILENT else rate) * chance * value
    return total


@compiled
def picks_now(tables: Tables) -> Vector:
    """Return a table to start from, (1, ROWS, COLUMNS, KINDS), in which nothing more is heard: a pick of the first."""
    result = np.empty((1, ROWS, COLUMNS, KINDS))
    for row in range(ROWS):
        result[0, row] = pick_value(row / (ROWS - 1), tables)
    return result


@compiled
def closed_form(tables: Tables) -> Vector:
    """Return a table to start from, (1, ROWS, COLUMNS, KINDS): that of leaf `question` (`search.leaf`)."""
    result = np.empty((1, ROWS, COLUMNS, KINDS))
    leaf = leaf_of(True, tables)
    for row in range(ROWS):
        b1 = row / (ROWS - 1)
        for column in range(COLUMNS):
            b2 = column / (COLUMNS - 1) * min(b1, 1.0 - b1)
            value = leaf_value(1.0, b1, b2, -1.0, leaf)
            held = leaf_value(1.0, b1, b2, b1 + b2, leaf)
            settled = leaf.gain * leaf.p_truth * (b1 + b2) + leaf.wrong
            later = max(settled + leaf.until_answer, leaf.gain * b1 + leaf.wrong)
            for kind in range(KINDS):
                result[0, row, column, kind] = held if kind in (FIRST, SECOND) else value
            for kind in (ASK_FIRST, ASK_SECOND):
                result[0, row, column, kind] = leaf.p_answer * settled + (1.0 - leaf.p_answer) * later
    return result


@lean
def table_action(belief: Vector, asked: int, phase: int, top: Leading, table: ValueTable, tables: Tables) -> int:
    """Return the table's best action: NOBODY for a wait, an item for a question, n_items and more for a pick."""
    cls, place = pair_class(top.first, top.second, table.breaks, tables), place_of(top.b1, top.b2)
    if tables.begun[phase] == 0:
        return NOBODY
    cls += first_table(phase, table.breaks, tables)
    share = belief[asked] / top.b2 if asked != NOBODY and top.b2 > 0.0 else 0.0
    best = pick_value(top.b1, tables)
    action = len(belief) + top.first
    wait = tables.wait + waited(table.values, cls, kind_of(asked, top.first, top.second), share, place)
    if wait > best:
        best, action = wait, NOBODY
    for kind, about in ((ASK_FIRST, top.first), (ASK_SECOND, top.second)):
        question = tables.point + at(table.values, cls, kind, place)
        if question > best:
            best, action = question, about
    return action
