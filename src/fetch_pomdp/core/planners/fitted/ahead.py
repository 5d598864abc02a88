"""One exact step ahead of a value table: words and answers summed, gestures sampled, the same for all actions."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled, lean
from fetch_pomdp.core.planners.fitted.outlook import DistinctWords, look, outlook_size, rays_a_draw
from fetch_pomdp.core.planners.fitted.rehearsal import sharpened
from fetch_pomdp.core.planners.fitted.table import ValueTable, answered_value, classes_of, with_other
from fetch_pomdp.core.planners.kernels import ASKED, NOBODY, WAITED, Came, leading, pick_value, smoothed_mass, turn_of
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.turns import POINTS, WORDS

ALMOST = 0.1  # points
MOST_ASKED = 6  # leading items whose questions are valued
_NEXT_PASS = 0x632BE59BD9B4E019  # far from the steps of the generator, so that passes do not overlap

# Values of a wait, of questions and their standard errors, and the best action (see `table.table_action`).
Ahead = tuple[float, Vector, float, Vector, int]


class Root(NamedTuple):
    """Where a decision is made."""

    belief: Vector  # (n_items,)
    asked: int  # i_r, or NOBODY
    phase: int  # see `turns`


class Lookahead(NamedTuple):
    """What a step ahead is taken with: a value, what may be heard and seen, and the model that the value is of."""

    table: ValueTable
    distinct: DistinctWords
    tables: Tables


class Sums(NamedTuple):
    """What passes add up, of questions about `asks` and, last, of a wait."""

    asks: Integers  # (k,), items
    totals: Vector  # (k + 1,), of values
    squares: Vector  # (k + 1,), of their standard errors


class Pass(NamedTuple):
    """What one pass finds for the actions of `Sums`, and its memory."""

    values: Vector  # (k + 1,), what each action leads to
    errors: Vector  # (k + 1,), their standard errors over the gestures
    sampled: Vector  # (k + 1,)
    drawn: Vector  # (k + 1,)
    heard: Vector  # (n_items,)


@compiled
def step_ahead(
    belief: Vector, asked: int, phase: int, table: ValueTable, distinct: DistinctWords, seed: int, passes: int,
    tables: Tables,
) -> Ahead:  # fmt: skip
    """Return what a number of passes finds. Python hands over the parts of a `Lookahead` faster than the whole."""
    root, sums = Root(belief, asked, phase), no_sums(belief)
    add_passes(root, sums, Lookahead(table, distinct, tables), seed, 0, passes)
    return chosen(root, sums, passes, tables)


@compiled
def no_sums(belief: Vector) -> Sums:
    """Return the sums before the first pass."""
    asks = candidates(belief)
    return Sums(asks, np.zeros(len(asks) + 1), np.zeros(len(asks) + 1))


@compiled
def add_passes(root: Root, sums: Sums, ahead: Lookahead, seed: int, begin: int, end: int) -> None:
    """Add what passes `begin` to `end` find.

    Pass by pass, so that the sums are the same to the last digit however a number of passes is divided into calls.
    """
    asks, totals, squares = sums
    state, size = np.empty(1, dtype=np.uint64), len(totals)
    values, errors = np.empty(size), np.empty(size)
    found = Pass(values, errors, np.empty(size), np.empty(size), np.empty(len(root.belief)))
    for number in range(begin, end):
        state[0] = np.uint64(seed) + np.uint64(number) * np.uint64(_NEXT_PASS)
        one_pass(root, asks, ahead, found, state)
        for index in range(size):
            totals[index] += values[index]
            squares[index] += errors[index] * errors[index]


@lean
def one_pass(root: Root, asks: Integers, ahead: Lookahead, found: Pass, state: RandomState) -> None:
    """Fill in the value that a question about each of `asks`, and then a wait, leads to, and its standard error."""
    belief, asked, phase = root
    table, distinct, tables = ahead
    values, errors, sampled, drawn, heard = found
    smoothed, size = smoothed_mass(belief, tables), outlook_size(distinct, tables)
    first = size - (distinct.rays if tables.p_g > 0.0 else 0)
    each = rays_a_draw(phase, tables)
    draws = (size - first) // each
    for index in range(len(values)):
        values[index], errors[index], sampled[index], drawn[index] = 0.0, 0.0, 0.0, 0.0
    for number in range(size):
        seen = look(number, belief, smoothed, phase, heard, state, distinct, tables)
        top = leading(heard)
        classes = classes_of(top, table.breaks, tables)
        for index in range(len(values)):
            waits = index == len(asks)
            turn = turn_of(asked, phase, NOBODY if waits else asks[index])
            pairs = with_other(classes, turn.about, top, table.breaks, tables)
            own = heard[turn.about] if turn.about != NOBODY else 0.0
            value = answered_value(table, pairs, top, own, turn, Came(seen.words, seen.seen), tables)
            values[index] += (seen.wait if waits else seen.ask) * value
            if number >= first:
                words = tables.chances[phase, turn.kind, WORDS]
                drawn[index] += value if each == 1 else value * (words if seen.words else 1.0 - words)
                if (number - first) % each == each - 1:
                    sampled[index] += drawn[index] / draws
                    errors[index] += drawn[index] * drawn[index] / draws
                    drawn[index] = 0.0
    for index in range(len(values)):
        spread = max(errors[index] - sampled[index] * sampled[index], 0.0) if draws > 1 else 0.0
        points = tables.chances[phase, WAITED if index == len(asks) else ASKED, POINTS]
        errors[index] = points * math.sqrt(spread / max(draws - 1, 1))


@compiled
def candidates(belief: Vector) -> Integers:
    """Return the leading items, at most MOST_ASKED, the likeliest first; of equals the first in the scene."""
    found = np.full(min(MOST_ASKED, len(belief)), NOBODY)
    for item in range(len(belief)):
        place = len(found)
        while place > 0 and (found[place - 1] == NOBODY or belief[item] > belief[found[place - 1]]):
            place -= 1
            if place + 1 < len(found):
                found[place + 1] = found[place]
        if place < len(found):
            found[place] = item
    return found


@compiled
def chosen(root: Root, sums: Sums, passes: int, tables: Tables) -> Ahead:
    """Return what the sums of passes amount to; equal values go to the pick, then the wait, then the question.

    Choice: before live people a question about a less likely item has to be worth ALMOST more than one about a likelier
    item: a robot that is shown one item and asks about its neighbour seems not to have looked. So has one about another
    item than that of a question that nobody has answered: who says "what?" wants to hear it again.
    """
    belief, count = root.belief, len(root.belief)
    asks, totals, squares = sums
    live = len(tables.begun) > 1
    point, point_errors = np.full(count, np.nan), np.full(count, np.nan)
    wait = tables.wait + totals[-1] / passes
    best, action = pick_value(belief[asks[0]], tables), count + asks[0]
    if wait > best:
        best, action = wait, NOBODY
    again = asked_again(root, asks, tables)
    for number in range(len(asks)):
        index = again if number == 0 else number - 1 if number <= again else number
        value = tables.point + totals[index] / passes
        point[asks[index]], point_errors[asks[index]] = value, math.sqrt(squares[index]) / passes
        margin = ALMOST if live and 0 <= action < count else 0.0
        if value > best + margin:
            best, action = value, asks[index]
    if tables.begun[root.phase] == 0:
        action = NOBODY
    return wait, point, math.sqrt(squares[-1]) / passes, point_errors, action


@compiled
def asked_again(root: Root, asks: Integers, tables: Tables) -> int:
    """Return the place among `asks` of a question that nobody has answered for long, 0 if there is none."""
    if tables.late[root.phase] > 0:
        for index in range(len(asks)):
            if asks[index] == root.asked:
                return index
    return 0


@compiled
def step_ahead_many(
    beliefs: Vector, asked: Integers, phases: Integers, power: float, ahead: Lookahead, seeds: RandomState, passes: int,
    actions: Integers,
) -> None:  # fmt: skip
    """Fill in the best action for that power of every belief."""
    table, distinct, tables = ahead
    for index in range(len(beliefs)):
        belief = sharpened(beliefs[index], power)
        found = step_ahead(belief, asked[index], phases[index], table, distinct, seeds[index], passes, tables)
        actions[index] = found[4]
