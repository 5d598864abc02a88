"""What the compiled searches share: numbers and arrays in, arrays out. Beliefs are probabilities here, (n_items,).

`asked` and `about` are an item's index or NOBODY. A node at level k has the belief `work.beliefs[k]`; a search adds the
values of its samples up in `work.totals[k]` (a question about item i at i, a wait at the end).

A search walks its tree depth first with a cursor a level, `work.cursor`: compiled recursion cannot be cached on disk.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import RandomState, Vector, compiled, inlined, lean, standard_normal, uniform
from fetch_pomdp.core.gesture import ray_likelihood
from fetch_pomdp.core.language.unigram import draw_word
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.rays import turned

# Values of a wait, of questions and of picks; standard errors of the first two.
RootValues = tuple[float, Vector, Vector, float, Vector]

NOBODY = -1
SILENT, YES, NO = 0, 1, 2


class Search(NamedTuple):
    """How far and how broadly to search."""

    depth: int  # actions, 2 or more
    width: int  # sampled observations at a node
    questions: int  # items that may be asked about: all, or 0
    patient: bool  # leaf `question` instead of `pick`


# Where a search stands in one node.
CURSOR = np.dtype(
    [
        ("asked", np.int64),
        ("branch", np.int64),  # which sample, action and answer it is at
        ("offset", np.float64),  # of the evenly spread draws
        ("smoothed", np.float64),  # sum of the node's beliefs, each times its item's smoothing (Eq. 5)
        ("desired", np.int64),  # the item drawn for the sample
        ("speaks", np.float64),  # random numbers that select the sample's answer
        ("means", np.float64),
        ("chance", np.float64),  # of the answer
        ("sums", np.float64),  # value of the sample and action, over the answers so far
    ]
)


class Work(NamedTuple):
    """Memory of a search, and its random numbers; a row for each level of the tree."""

    beliefs: Vector  # (depth, n_items)
    heard: Vector  # (depth, n_items), a node's belief after base words and pointing
    totals: Vector  # (depth, n_items + 1), sums of values over samples
    squares: Vector  # (depth, n_items + 1), sums of their squares
    cursor: Any  # (depth,) of CURSOR
    state: RandomState


@compiled
def workspace(belief: Vector, asked: int, depth: int, seed: int, tables: Tables) -> Work:
    """Return the memory of a search from a belief and a last question."""
    count = len(belief)
    chances, values = np.empty((2, depth, count)), np.empty((2, depth, count + 1))
    state = np.empty(1, dtype=np.uint64)
    state[0] = seed
    cursor = np.empty(depth, CURSOR)
    work = Work(chances[0], chances[1], values[0], values[1], cursor, state)
    for item in range(count):
        work.beliefs[0, item] = belief[item]
    enter(0, asked, work, tables)
    return work


@inlined
def enter(level: int, asked: int, work: Work, tables: Tables) -> None:
    """Start on a node whose belief is in place."""
    for action in range(work.totals.shape[1]):
        work.totals[level, action] = 0.0
        work.squares[level, action] = 0.0
    cursor = work.cursor
    cursor["sums"][level] = 0.0
    cursor["asked"][level] = asked
    cursor["branch"][level] = 0
    cursor["offset"][level] = uniform(work.state)
    smoothed = 0.0
    for item in range(work.beliefs.shape[1]):
        smoothed += work.beliefs[level, item] * tables.smoothing[item]
    cursor["smoothed"][level] = smoothed


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
def live_step(
    belief: Vector,
    smoothed: float,
    desired: int,
    asked: int,
    rate: float,
    work: Vector,
    state: RandomState,
    tables: Tables,
) -> None:
    """Replace a belief by that after a step of a person drawn from the model: words, pointing and an answer.

    asked: i_r after the robot's action; work: (n_items,), memory.
    """
    hear(belief, smoothed, desired, work, state, tables)
    speaks, means = uniform(state), uniform(state)
    answer = select_answer(desired, asked, rate, speaks, means, tables)
    answered(work, asked, answer, rate, belief, tables)


@inlined
def largest(belief: Vector) -> float:
    """Return the largest belief."""
    found = float(belief[0])
    for item in range(1, len(belief)):
        found = max(found, belief[item])
    return found


@lean
def best_of(level: int, search: Search, work: Work, tables: Tables) -> float:
    """Return the value of a node whose totals are complete: the best of picks, a wait and questions."""
    best = tables.pick_wrong + (tables.pick_correct - tables.pick_wrong) * largest(work.beliefs[level])
    best = max(best, tables.wait + float(work.totals[level, -1]) / search.width)
    for item in range(search.questions):
        best = max(best, tables.point + float(work.totals[level, item]) / search.width)
    return best


@compiled
def root_values(search: Search, work: Work, tables: Tables) -> RootValues:
    """Return what a search that is complete knows at its root."""
    belief, means, errors, count = work.beliefs[0], work.totals[0], work.squares[0], work.beliefs.shape[1]
    for action in range(count + 1):  # in place: fresh memory costs more than all that is computed here
        mean = means[action] / search.width
        spread = max(errors[action] / search.width - mean * mean, 0.0)
        means[action] = mean + (tables.point if action < count else tables.wait)
        errors[action] = math.sqrt(spread / max(search.width - 1, 1))
    for item in range(count):
        belief[item] = tables.pick_wrong + (tables.pick_correct - tables.pick_wrong) * belief[item]
    return float(means[count]), means[:count], belief, float(errors[count]), errors[:count]


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
