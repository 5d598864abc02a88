"""The model compiled, for planners and simulations: what a person does in a step, and what it makes of a belief.

Numbers and arrays in, arrays out. Beliefs are probabilities here, (n_items,); `asked` and `about` are an item's index
or NOBODY.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from fetch_pomdp.core.compiled import RandomState, Vector, inlined, lean, standard_normal, uniform
from fetch_pomdp.core.gesture import ray_likelihood
from fetch_pomdp.core.language import draw_word
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.rays import turned

NOBODY = -1
SILENT, YES, NO = 0, 1, 2


@inlined
def hear(belief: Vector, smoothed: float, desired: int, heard: Vector, state: RandomState, tables: Tables) -> None:
    """Fill in the belief after base words and a gesture drawn for the desired item (Eq. 4, 5, 7)."""
    word = draw_word(desired, uniform(state), uniform(state), tables)
    if word < 0:
        for item in range(len(belief)):
            heard[item] = belief[item]
    else:
        hear_word(belief, smoothed, word, heard, tables)
    if uniform(state) < tables.p_g:
        see(desired, heard, state, tables)
    else:
        see_nothing(heard, tables)


@inlined
def hear_word(belief: Vector, smoothed: float, word: int, heard: Vector, tables: Tables) -> None:
    """Fill in the belief after one base word (Eq. 5)."""
    owners = range(tables.word_starts[word], tables.word_starts[word + 1])
    total = smoothed
    for index in owners:
        item = tables.word_items[index]
        total += belief[item] * tables.smoothing[item] / tables.alpha
    scale = 1.0 / total
    for item in range(len(belief)):
        heard[item] = belief[item] * tables.smoothing[item] * scale
    gain = 1.0 + 1.0 / tables.alpha
    for index in owners:
        heard[tables.word_items[index]] *= gain


@lean
def see(desired: int, heard: Vector, state: RandomState, tables: Tables) -> None:
    """Update by a ray drawn around the desired item (Eq. 7)."""
    angle, roll = abs(standard_normal(state)) * tables.sigma, 2.0 * math.pi * uniform(state)
    x, y, z = turned(tables.directions[desired], angle, roll)
    nearest = -1.0
    for item in range(len(heard)):
        nearest = max(nearest, cosine_of(item, x, y, z, tables))
    if nearest < math.cos(tables.threshold):
        see_nothing(heard, tables)
        return
    for item in range(len(heard)):
        # The arc cosine is off by 1e-8 rad near the axis: nothing for a plan, and faster than `angle_between`.
        heard[item] *= ray_likelihood(math.acos(max(-1.0, min(1.0, cosine_of(item, x, y, z, tables)))), tables)
    normalise(heard)


@inlined
def cosine_of(item: int, x: float, y: float, z: float, tables: Tables) -> float:
    """Return the cosine of the angle between a ray and the direction to an item."""
    axis = tables.directions[item]
    return float(axis[0] * x + axis[1] * y + axis[2] * z)


@inlined
def see_nothing(heard: Vector, tables: Tables) -> None:
    """Update by no pointing (Eq. 7)."""
    if tables.exact:  # else it is as likely for every item
        for item in range(len(heard)):
            heard[item] *= tables.null_chance[item]
        normalise(heard)


@inlined
def normalise(belief: Vector) -> None:
    """Scale to a sum of 1."""
    total = 0.0
    for item in range(len(belief)):
        total += belief[item]
    scale = 1.0 / total
    for item in range(len(belief)):
        belief[item] *= scale


@inlined
def answered(heard: Vector, about: int, answer: int, rate: float, belief: Vector, tables: Tables) -> float:
    """Fill in the belief after an answer to a question about an item (Eq. 6, Table I); return the answer's chance."""
    if about == NOBODY or answer == SILENT:
        for item in range(len(heard)):
            belief[item] = heard[item]
        return 1.0 if about == NOBODY else 1.0 - rate
    true, false = tables.p_truth, 1.0 - tables.p_truth
    own, others = (true, false) if answer == YES else (false, true)
    chance = float(own * heard[about] + others * (1.0 - heard[about]))
    if chance > 0.0:
        for item in range(len(heard)):
            belief[item] = heard[item] * (others / chance)
        belief[about] = heard[about] * own / chance
    return rate * chance


@inlined
def select_answer(desired: int, about: int, rate: float, speaks: float, means: float, tables: Tables) -> int:
    """Return the answer that two uniform numbers in [0, 1) select by Eq. 6 and Table I."""
    if about == NOBODY or speaks >= rate:
        return SILENT
    truthful = means < tables.p_truth
    return YES if truthful == (about == desired) else NO


@inlined
def turn_of(asked: int, action: int, tables: Tables) -> tuple[int, float]:
    """Return i_r after a wait (NOBODY) or a question about an item, and the chance of an answer about it (Eq. 6)."""
    return (asked, tables.p_again) if action == NOBODY else (action, tables.p_l)


@inlined
def live_step(
    belief: Vector, asked: int, action: int, desired: int, heard: Vector, state: RandomState, tables: Tables
) -> int:
    """Replace a belief by that after an action and a step of a person drawn from the model: words, pointing, an answer.

    action: NOBODY for a wait, or the item of a question; heard: (n_items,), memory. Returns i_r after the action.
    """
    about, rate = turn_of(asked, action, tables)
    hear(belief, smoothed_mass(belief, tables), desired, heard, state, tables)
    speaks, means = uniform(state), uniform(state)
    answer = select_answer(desired, about, rate, speaks, means, tables)
    answered(heard, about, answer, rate, belief, tables)
    return about


@inlined
def pick_value(belief: float, tables: Tables) -> float:
    """Return the expected reward of picking an item of a belief."""
    return tables.pick_wrong + (tables.pick_correct - tables.pick_wrong) * belief


@inlined
def largest(belief: Vector) -> float:
    """Return the largest belief."""
    found = float(belief[0])
    for item in range(1, len(belief)):
        found = max(found, belief[item])
    return found


@inlined
def draw_item(belief: Vector, number: float) -> int:
    """Return the item that a uniform number in [0, 1) selects from a belief."""
    last, reached = 0, 0.0
    for item in range(len(belief)):
        if belief[item] > 0.0:
            last = item
            reached += belief[item]
            if reached > number:
                break
    return last


class Leading(NamedTuple):
    """The three leading items and their beliefs, largest first; with fewer items a belief is 0 and its item 0."""

    first: int
    second: int
    third: int
    b1: float
    b2: float
    b3: float


@inlined
def leading(belief: Vector) -> Leading:
    """Return the leaders of a belief; beliefs that do not exist count as 0."""
    first, second, third, b1, b2, b3 = 0, 0, 0, 0.0, 0.0, 0.0
    for item in range(len(belief)):
        chance = belief[item]
        if chance > b3:
            if chance > b1:
                first, second, third, b1, b2, b3 = item, first, second, chance, b1, b2
            elif chance > b2:
                second, third, b2, b3 = item, second, chance, b2
            else:
                third, b3 = item, chance
    return Leading(first, second, third, b1, b2, b3)


@inlined
def smoothed_mass(belief: Vector, tables: Tables) -> float:
    """Return the sum of the beliefs, each times its item's smoothing (Eq. 5)."""
    total = 0.0
    for item in range(len(belief)):
        total += belief[item] * tables.smoothing[item]
    return total
