"""What may be heard and seen next from a belief: base words summed exactly where they are few, pointing sampled.

Words that the same items own say the same, so they are one word here. An outlook is a list of beliefs after base words
and a gesture, each with its chance:

- nobody points: silence, then every distinct word; where there are more than MOST_WORDS, as many evenly drawn words;
- somebody points: rays and words drawn together, desired items spread evenly over the belief.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Integers, RandomState, Vector, inlined, lean, uniform
from fetch_pomdp.core.language.unigram import draw_word
from fetch_pomdp.core.planners.kernels import draw_item, hear_word, see, see_nothing
from fetch_pomdp.core.problem import Problem, Tables

MOST_WORDS = 12


class DistinctWords(NamedTuple):
    """Words by what they say: one of each set of owners, how many share it, and the rays to draw beside them."""

    words: Integers  # (k,), index of a word
    sizes: Vector  # (k,), how many words have its owners
    rays: int  # drawn for an outlook, 1 or more


def distinct_words(problem: Problem, rays: int) -> DistinctWords:
    """Return the words of a problem that differ in their owners."""
    alike = problem.words_by_owners().values()
    words = np.array([members[0] for members in alike], dtype=np.int64)
    return DistinctWords(words, np.array([len(members) for members in alike], dtype=np.float64), rays)


@inlined
def outlook_size(distinct: DistinctWords, tables: Tables) -> int:
    """Return how many beliefs an outlook has: silence, words, rays."""
    return 1 + min(len(distinct.words), MOST_WORDS) + (distinct.rays if tables.p_g > 0.0 else 0)


@inlined
def word_chance(belief: Vector, smoothed: float, word: int, tables: Tables) -> float:
    """Return the chance of a base word in a step (Eq. 4, 5). smoothed: sum of beliefs times smoothing."""
    total = smoothed * tables.alpha
    for index in range(tables.word_starts[word], tables.word_starts[word + 1]):
        item = tables.word_items[index]
        total += belief[item] * tables.smoothing[item]
    return float(tables.p_l * total)


@inlined
def smoothed_mass(belief: Vector, tables: Tables) -> float:
    """Return the sum of the beliefs, each times its item's smoothing (Eq. 5)."""
    total = 0.0
    for item in range(len(belief)):
        total += belief[item] * tables.smoothing[item]
    return total


@lean
def look(
    index: int,
    belief: Vector,
    smoothed: float,
    heard: Vector,
    state: RandomState,
    distinct: DistinctWords,
    tables: Tables,
) -> float:
    """Fill in the belief number `index` of an outlook and return its chance. All numbers in turn sum to 1."""
    count = min(len(distinct.words), MOST_WORDS)
    if index > count:
        draw = index - count - 1
        desired = draw_item(belief, (draw + uniform(state)) / distinct.rays)
        spoken(desired, uniform(state), belief, smoothed, heard, state, tables)
        see(desired, heard, state, tables)
        return tables.p_g / distinct.rays
    still = 1.0 - tables.p_g
    if index == 0:
        for item in range(len(belief)):
            heard[item] = belief[item]
        chance = 1.0 - tables.p_l
    elif count == len(distinct.words):
        word = distinct.words[index - 1]
        hear_word(belief, smoothed, word, heard, tables)
        chance = distinct.sizes[index - 1] * word_chance(belief, smoothed, word, tables)
    else:
        desired = draw_item(belief, (index - 1 + uniform(state)) / count)
        spoken(desired, 0.0, belief, smoothed, heard, state, tables)
        chance = tables.p_l / count
    see_nothing(heard, tables)
    return float(still * chance)


@inlined
def spoken(
    desired: int, speaks: float, belief: Vector, smoothed: float, heard: Vector, state: RandomState, tables: Tables
) -> None:
    """Fill in the belief after a word drawn for the desired item, or silence; speaks: uniform, 0 for a word surely."""
    word = draw_word(desired, speaks, uniform(state), tables)
    if word < 0:
        for item in range(len(belief)):
            heard[item] = belief[item]
    else:
        hear_word(belief, smoothed, word, heard, tables)
