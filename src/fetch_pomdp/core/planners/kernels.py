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
from fetch_pomdp.core.turns import DESIRED, NO, OTHER, POINTS, SILENT, WORDS, YES

NOBODY = -1
WAITED, ASKED = 0, 1  # kinds of step, see `turns.Phases`


class Heard(NamedTuple):
    """What a step was like, as far as the phase after it depends on that: whether words came, and pointing."""

    words: int
    seen: int


@inlined
def hear(
    belief: Vector, smoothed: float, desired: int, phase: int, kind: int, heard: Vector, state: RandomState,
    tables: Tables,
) -> Heard:  # fmt: skip
    """Fill in the belief after base words and a gesture drawn for the desired item (Eq. 4, 5, 7).

    phase: in which the step began; kind: of the step.
    """
    chances = tables.chances[phase, kind]
    words, seen = spoken(desired, uniform(state) < chances[WORDS], belief, smoothed, heard, state, tables), 0
    if uniform(state) < chances[POINTS]:
        seen = see(desired, heard, state, tables)
    else:
        see_nothing(heard, tables)
    return Heard(words, seen)


@inlined
def spoken(
    desired: int, speaks: bool, belief: Vector, smoothed: float, heard: Vector, state: RandomState, tables: Tables
) -> int:
    """Fill in the belief after a word drawn for the desired item, if anything was said; return whether there was."""
    which = uniform(state)
    if speaks:
        hear_word(belief, smoothed, draw_word(desired, which, tables), heard, tables)
        return 1
    for item in range(len(belief)):
        heard[item] = belief[item]
    return 0


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
def see(desired: int, heard: Vector, state: RandomState, tables: Tables) -> int:
    """Update by a ray drawn around the desired item (Eq. 7); return whether it points at the table."""
    angle, roll = abs(standard_normal(state)) * tables.sigma, 2.0 * math.pi * uniform(state)
    x, y, z = turned(tables.directions[desired], angle, roll)
    nearest = -1.0
    for item in range(len(heard)):
        nearest = max(nearest, cosine_of(item, x, y, z, tables))
    if nearest < math.cos(tables.threshold):
        see_nothing(heard, tables)
        return 0
    for item in range(len(heard)):
        # The arc cosine is off by 1e-8 rad near the axis: nothing for a plan, and faster than `angle_between`.
        heard[item] *= ray_likelihood(math.acos(max(-1.0, min(1.0, cosine_of(item, x, y, z, tables)))), tables)
    normalise(heard)
    return 1


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
def answered(
    heard: Vector, about: int, answer: int, phase: int, kind: int, belief: Vector, tables: Tables
) -> float:
    """Fill in the belief after an answer to a question about an item (Eq. 6, Table I); return the answer's chance."""
    rate, if_desired = tables.chances[phase, kind, OTHER], tables.chances[phase, kind, DESIRED]
    if about == NOBODY or (answer == SILENT and rate == if_desired):
        for item in range(len(heard)):
            belief[item] = heard[item]
        return 1.0 if about == NOBODY else 1.0 - rate
    own, others = answer_weights(answer, rate, if_desired, tables)
    chance = float(own * heard[about] + others * (1.0 - heard[about]))
    if chance > 0.0:
        for item in range(len(heard)):
            belief[item] = heard[item] * (others / chance)
        belief[about] = heard[about] * own / chance
    return (1.0 - rate if answer == SILENT else rate) * chance


@inlined
def answer_weights(answer: int, rate: float, if_desired: float, tables: Tables) -> tuple[float, float]:
    """Return how likely an answer is for the item asked about and for another, over the rate of such for another."""
    if answer == SILENT:
        return (1.0 - if_desired) / (1.0 - rate), 1.0
    true, false = tables.p_truth, 1.0 - tables.p_truth
    own, others = (true, false) if answer == YES else (false, true)
    return own * (if_desired / rate), others


@inlined
def select_answer(
    desired: int, about: int, phase: int, kind: int, speaks: float, means: float, tables: Tables
) -> int:
    """Return the answer that two uniform numbers in [0, 1) select by Eq. 6 and Table I."""
    if about == NOBODY or speaks >= tables.chances[phase, kind, DESIRED if about == desired else OTHER]:
        return SILENT
    truthful = means < tables.p_truth
    return YES if truthful == (about == desired) else NO


@inlined
def live_step(
    belief: Vector,
    smoothed: float,
    desired: int,
    asked: int,
    phase: int,
    kind: int,
    work: Vector,
    state: RandomState,
    tables: Tables,
) -> int:
    """Replace a belief by that after a step of a person drawn from the model: words, pointing and an answer.

    asked: i_r after the robot's action; phase: before it; kind: of the step; work: (n_items,), memory. Returns the
    phase that the step leads to.
    """
    heard = hear(belief, smoothed, desired, phase, kind, work, state, tables)
    speaks, means = uniform(state), uniform(state)
    answer = select_answer(desired, asked, phase, kind, speaks, means, tables)
    answered(work, asked, answer, phase, kind, belief, tables)
    return int(tables.following[phase, kind, heard.words, heard.seen, answer])


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
