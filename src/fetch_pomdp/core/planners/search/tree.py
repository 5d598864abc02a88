"""The tree of the compiled searches: what they keep of a node, and its value.

A node at level k has the belief `work.beliefs[k]`; a search adds the values of its samples up in `work.totals[k]` (a
question about item i at i, a wait at the end).

A search walks its tree depth first with a cursor a level, `work.cursor`: compiled recursion cannot be cached on disk.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import RandomState, Vector, compiled, inlined, lean, uniform
from fetch_pomdp.core.planners.kernels import (
    ASKED,
    NOBODY,
    WAITED,
    Came,
    Turn,
    hear,
    largest,
    phase_after,
    pick_value,
    smoothed_mass,
)
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.turns import POINTS, WORDS

# Values of a wait, of questions and of picks; standard errors of the first two.
RootValues = tuple[float, Vector, Vector, float, Vector]


class Search(NamedTuple):
    """How far and how broadly to search."""

    depth: int  # actions, 2 or more
    width: int  # sampled observations at a node
    questions: int  # items that may be asked about: all, or 0
    exact: bool  # sums answers exactly, instead of sampling them with the rest
    leaf_asks: bool  # leaf `question` instead of `pick`


# Where a search stands in one node.
CURSOR = np.dtype(
    [
        ("asked", np.int64),
        ("phase", np.int64),
        ("words", np.int64, (2,)),  # what the sample brought after a wait, and with a question
        ("seen", np.int64, (2,)),
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
    heard: Vector  # (depth, 2 kinds of step, n_items), a node's belief after base words and pointing
    totals: Vector  # (depth, n_items + 1), sums of values over samples
    squares: Vector  # (depth, n_items + 1), sums of their squares
    cursor: Any  # (depth,) of CURSOR
    state: RandomState


@compiled
def workspace(belief: Vector, asked: int, phase: int, depth: int, seed: int, tables: Tables) -> Work:
    """Return the memory of a search from a belief, a last question and a phase."""
    count = len(belief)
    beliefs, values = np.empty((depth, count)), np.empty((2, depth, count + 1))
    state = np.empty(1, dtype=np.uint64)
    state[0] = seed
    cursor = np.empty(depth, CURSOR)
    work = Work(beliefs, np.empty((depth, 2, count)), values[0], values[1], cursor, state)
    for item in range(count):
        work.beliefs[0, item] = belief[item]
    enter(0, asked, phase, work, tables)
    return work


@inlined
def enter(level: int, asked: int, phase: int, work: Work, tables: Tables) -> None:
    """Start on a node whose belief is in place."""
    for action in range(work.totals.shape[1]):
        work.totals[level, action] = 0.0
        work.squares[level, action] = 0.0
    cursor = work.cursor
    cursor["sums"][level] = 0.0
    cursor["asked"][level] = asked
    cursor["phase"][level] = phase
    cursor["branch"][level] = 0
    cursor["offset"][level] = uniform(work.state)
    cursor["smoothed"][level] = smoothed_mass(work.beliefs[level], tables)


@inlined
def draw(level: int, desired: int, work: Work, tables: Tables) -> None:
    """Draw what a node's step brings if an item is desired, after a wait and with a question, from the same numbers."""
    cursor, phase = work.cursor, work.cursor["phase"][level]
    smoothed, before = cursor["smoothed"][level], work.state[0]
    for kind in range(1 if alike(phase, tables) else 2):
        work.state[0] = before
        turn = Turn(NOBODY, phase, kind)
        came = hear(work.beliefs[level], smoothed, desired, turn, work.heard[level, kind], work.state, tables)
        cursor["words"][level, kind], cursor["seen"][level, kind] = came.words, came.seen


@inlined
def alike(phase: int, tables: Tables) -> bool:
    """Whether words and pointing are as likely after a wait as with a question, so that one sample serves both."""
    wait, ask = tables.chances[phase, WAITED], tables.chances[phase, ASKED]
    return bool(wait[WORDS] == ask[WORDS] and wait[POINTS] == ask[POINTS])


@inlined
def row_of(turn: Turn, tables: Tables) -> int:
    """Return which of a node's two samples is that of a step."""
    return WAITED if alike(turn.phase, tables) else turn.kind


@inlined
def following_phase(level: int, turn: Turn, answer: int, work: Work, tables: Tables) -> int:
    """Return the phase that an answer leads to after a node's sample."""
    row = row_of(turn, tables)
    return phase_after(turn, Came(work.cursor["words"][level, row], work.cursor["seen"][level, row]), answer, tables)


@lean
def best_of(level: int, search: Search, work: Work, tables: Tables) -> float:
    """Return the value of a node whose totals are complete: the best of picks, a wait and questions."""
    best = pick_value(largest(work.beliefs[level]), tables)
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
        belief[item] = pick_value(belief[item], tables)
    return float(means[count]), means[:count], belief, float(errors[count]), errors[:count]
