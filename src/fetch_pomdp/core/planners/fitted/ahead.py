"""One exact step ahead of a value table: words and answers summed, gestures sampled, the same for all actions."""

from __future__ import annotations

import math

import numpy as np

from fetch_pomdp.core.compiled import Integers, RandomState, Vector, compiled, lean
from fetch_pomdp.core.planners.fitted.outlook import DistinctWords, look, outlook_size
from fetch_pomdp.core.planners.fitted.rehearsal import sharpened
from fetch_pomdp.core.planners.fitted.table import Step, ValueTable, answered_value, classes_of, with_other
from fetch_pomdp.core.planners.kernels import ASKED, NOBODY, WAITED, leading, smoothed_mass
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.turns import POINTS

MOST_ASKED = 6  # leading items whose questions are valued
_NEXT_PASS = 0x632BE59BD9B4E019  # far from the steps of the generator, so that passes do not overlap

# Values of a wait, of questions and their standard errors, and the best action (see `afterstate.table_action`).
Ahead = tuple[float, Vector, float, Vector, int]


@compiled
def step_ahead(
    belief: Vector, asked: int, phase: int, table: ValueTable, distinct: DistinctWords, seed: int, passes: int,
    tables: Tables,
) -> Ahead:
    """Return what a number of passes finds."""
    asks = candidates(belief)
    totals, squares = np.zeros(len(asks) + 1), np.zeros(len(asks) + 1)
    add_passes(belief, asked, phase, asks, table, distinct, seed, 0, passes, totals, squares, tables)
    found = chosen(belief, asks, totals, squares, passes, tables)
    return found if tables.begun[phase] else (found[0], found[1], found[2], found[3], NOBODY)


@compiled
def add_passes(
    belief: Vector, asked: int, phase: int, asks: Integers, table: ValueTable, distinct: DistinctWords, seed: int,
    begin: int, end: int, totals: Vector, squares: Vector, tables: Tables,
) -> None:  # fmt: skip
    """Add the values that passes `begin` to `end` find, and the squares of their errors: questions, then a wait.

    Pass by pass, so that the sums are the same to the last digit however a number of passes is divided into calls.
    """
    state, heard = np.empty(1, dtype=np.uint64), np.empty(len(belief))
    values, errors, sampled = np.empty(len(totals)), np.empty(len(totals)), np.empty(len(totals))
    for number in range(begin, end):
        state[0] = np.uint64(seed) + np.uint64(number) * np.uint64(_NEXT_PASS)
        one_pass(belief, asked, phase, asks, table, distinct, state, heard, values, errors, sampled, tables)
        for index in range(len(totals)):
            totals[index] += values[index]
            squares[index] += errors[index] * errors[index]


@lean
def one_pass(
    belief: Vector, asked: int, phase: int, asks: Integers, table: ValueTable, distinct: DistinctWords, state: RandomState,
    heard: Vector, values: Vector, errors: Vector, sampled: Vector, tables: Tables,
) -> None:  # fmt: skip
    """Fill in the value that each action leads to, and its standard error over the gestures; `sampled` is memory."""
    smoothed, size = smoothed_mass(belief, tables), outlook_size(distinct, tables)
    rays = distinct.rays if tables.p_g > 0.0 else 0
    for index in range(len(values)):
        values[index], errors[index], sampled[index] = 0.0, 0.0, 0.0
    for number in range(size):
        seen = look(number, belief, smoothed, phase, heard, state, distinct, tables)
        top = leading(heard)
        classes = classes_of(top, table.breaks, tables)
        for index in range(len(values)):
            waits = index == len(asks)
            about, kind = (asked, WAITED) if waits else (asks[index], ASKED)
            pairs = with_other(classes, about, top, table.breaks, tables)
            own = heard[about] if about != NOBODY else 0.0
            value = answered_value(table, pairs, top, about, own, Step(phase, kind, seen.words, seen.seen), tables)
            values[index] += (seen.wait if waits else seen.ask) * value
            if number >= size - rays:
                sampled[index] += value / rays
                errors[index] += value * value / rays
    for index in range(len(values)):
        spread = max(errors[index] - sampled[index] * sampled[index], 0.0) if rays > 1 else 0.0
        points = tables.chances[phase, WAITED if index == len(asks) else ASKED, POINTS]
        errors[index] = points * math.sqrt(spread / max(rays - 1, 1))


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
def chosen(belief: Vector, asks: Integers, totals: Vector, squares: Vector, passes: int, tables: Tables) -> Ahead:
    """Return what the sums of passes amount to; equal values go to the pick, then the wait, then the question."""
    count = len(belief)
    point, point_errors = np.full(count, np.nan), np.full(count, np.nan)
    wait = tables.wait + totals[-1] / passes
    best, action = tables.pick_wrong + (tables.pick_correct - tables.pick_wrong) * belief[asks[0]], count + asks[0]
    if wait > best:
        best, action = wait, NOBODY
    for index in range(len(asks)):
        value = tables.point + totals[index] / passes
        point[asks[index]], point_errors[asks[index]] = value, math.sqrt(squares[index]) / passes
        if value > best:
            best, action = value, asks[index]
    return wait, point, math.sqrt(squares[-1]) / passes, point_errors, action


@compiled
def step_ahead_many(
    beliefs: Vector, asked: Integers, phases: Integers, power: float, table: ValueTable, distinct: DistinctWords, seeds: RandomState,
    passes: int, actions: Integers, tables: Tables,
) -> None:  # fmt: skip
    """Fill in the best action for that power of every belief."""
    for index in range(len(beliefs)):
        belief = sharpened(beliefs[index], power)
        found = step_ahead(belief, asked[index], phases[index], table, distinct, seeds[index], passes, tables)
        actions[index] = found[4]
