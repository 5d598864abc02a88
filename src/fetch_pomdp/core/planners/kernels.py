"""The model compiled, for planners and simulations: what a person does in a step, and what it makes of a belief.

Numbers and arrays in, arrays out. Beliefs are probabilities here, (n_items,); `asked` and `about` are an item's index
or NOBODY.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from fetch_pomdp.core.compiled import RandomState, Vector, inlined, lean, standard_normal, uniform
from fetch_pomdp.core.gesture import ray_likelihood
from fetch_pomdp.core.language.unigram import draw_word
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.rays import turned
from fetch_pomdp.core.turns import DESIRED, NO, OTHER, POINTS, SILENT, WIDTH, WORDS, YES

NOBODY = -1
WAITED, ASKED = range(2)  # kinds of step, see `turns.Phases`


class Turn(NamedTuple):
    """A step of the person's: i_r in it, the phase in which it began, and its kind."""

    about: int
    phase: int
    kind: int


class Came(NamedTuple):
    """What a step brought, as far as the next phase depends on it: whether base words came, and pointing."""

    words: int
    seen: int


@inlined
def turn_of(asked: int, phase: int, action: int) -> Turn:
    """Return the step after a wait (NOBODY) or a question about an item."""
    return Turn(asked, phase, WAITED) if action == NOBODY else Turn(action, phase, ASKED)


@inlined
def phase_after(turn: Turn, came: Came, answer: int, tables: Tables) -> int:
    """Return the phase that a step leads to."""
    return int(tables.following[turn.phase, turn.kind, came.words, came.seen, answer])


@inlined
def hear(
    belief: Vector, smoothed: float, desired: int, turn: Turn, heard: Vector, state: RandomState, tables: Tables
) -> Came:
    """Fill in the belief after base words and a gesture drawn for the desired item (Eq. 4, 5, 7)."""
    chances = tables.chances[turn.phase, turn.kind]
    words = say(desired, uniform(state) < chances[WORDS], belief, smoothed, heard, state, tables)
    seen = 0
    if uniform(state) < chances[POINTS]:
        seen = see(desired, tables.sigma * chances[WIDTH], heard, state, tables)
    else:
        see_nothing(heard, tables)
    return Came(words, seen)


@inlined
def say(
    desired: int, speaks: bool, belief: Vector, smoothed: float, heard: Vector, state: RandomState, tables: Tables
) -> int:
    """Fill in the belief after a word drawn for the desired item if anybody speaks; return whether they did."""
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
def see(desired: int, sigma: float, heard: Vector, state: RandomState, tables: Tables) -> int:
    """Update by a ray drawn around the desired item (Eq. 7); return whether it points at the table. sigma: rad."""
    angle, roll = abs(standard_normal(state)) * sigma, 2.0 * math.pi * uniform(state)
    x, y, z = turned(tables.directions[desired], angle, roll)
    nearest = -1.0
    for item in range(len(heard)):
        nearest = max(nearest, cosine_of(item, x, y, z, tables))
    if nearest < math.cos(tables.threshold):
        see_nothing(heard, tables)
        return 0
    for item in range(len(heard)):
        # The arc cosine is off by 1e-8 rad near the axis: nothing for a plan, and faster than `angle_between`.
        heard[item] *= ray_likelihood(math.acos(max(-1.0, min(1.0, cosine_of(item, x, y, z, tables)))), sigma, tables)
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
def answered(heard: Vector, turn: Turn, answer: int, belief: Vector, tables: Tables) -> float:
    """Fill in the belief after an answer to a question about an item (Eq. 6, Table I); return the answer's chance."""
    about = turn.about
    rate, if_desired = tables.chances[turn.phase, turn.kind, OTHER], tables.chances[turn.phase, turn.kind, DESIRED]
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
    return float((1.0 - rate if answer == SILENT else rate) * chance)


@inlined
def answer_weights(answer: int, rate: float, if_desired: float, tables: Tables) -> tuple[float, float]:
    """Return the likelihoods of an answer for the item asked about and for another, over the rate of it for another.

    rate, if_desired: chance of an answer if another item is desired, and if that one is.
    """
    if answer == SILENT:
        return (1.0 - if_desired) / (1.0 - rate), 1.0
    true, false = tables.p_truth, 1.0 - tables.p_truth
    own, others = (true, false) if answer == YES else (false, true)
    return (own, others) if rate == if_desired else (own * (if_desired / rate), others)


@inlined
def select_answer(desired: int, turn: Turn, speaks: float, means: float, tables: Tables) -> int:
    """Return the answer that two uniform numbers in [0, 1) select by Eq. 6 and Table I."""
    desired_asked = turn.about == desired
    if turn.about == NOBODY or speaks >= tables.chances[turn.phase, turn.kind, DESIRED if desired_asked else OTHER]:
        return SILENT
    truthful = means < tables.p_truth
    return YES if truthful == desired_asked else NO


@inlined
def live_step(belief: Vector, turn: Turn, desired: int, heard: Vector, state: RandomState, tables: Tables) -> int:
    """Replace a belief by that after a step of a person drawn from the model: words, pointing, an answer.

    heard: (n_items,), memory. Returns the phase that the step leads to.
    """
    came = hear(belief, smoothed_mass(belief, tables), desired, turn, heard, state, tables)
    speaks, means = uniform(state), uniform(state)
    answer = select_answer(desired, turn, speaks, means, tables)
    answered(heard, turn, answer, belief, tables)
    return phase_after(turn, came, answer, tables)


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
