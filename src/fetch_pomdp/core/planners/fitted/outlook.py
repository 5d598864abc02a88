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
from fetch_pomdp.core.planners.kernels import ASKED, WAITED, draw_item, hear_word, say, see, see_nothing
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.turns import POINTS, WIDTH, WORDS

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


def rays_of(problem: Problem, rays: int) -> int:
    """Return how many rays to draw for an outlook: twice as many where each is drawn with a word and without."""
    return 2 * rays if problem.model.turns else rays


@inlined
def rays_a_draw(phase: int, tables: Tables) -> int:
    """Return how many rays are drawn for one item: two where each kind of step weighs words and none otherwise."""
    return 1 if tables.chances[phase, WAITED, WORDS] == tables.chances[phase, ASKED, WORDS] else 2


@inlined
def outlook_size(distinct: DistinctWords, tables: Tables) -> int:
    """Return how many beliefs an outlook has: silence, words, rays."""
    return 1 + min(len(distinct.words), MOST_WORDS) + (distinct.rays if tables.p_g > 0.0 else 0)


@inlined
def word_chance(belief: Vector, smoothed: float, word: int, tables: Tables) -> float:
    """Return the chance of a base word where one is spoken (Eq. 5). smoothed: sum of beliefs times smoothing."""
    total = smoothed * tables.alpha
    for index in range(tables.word_starts[word], tables.word_starts[word + 1]):
        item = tables.word_items[index]
        total += belief[item] * tables.smoothing[item]
    return float(total)


class Look(NamedTuple):
    """What an outlook's belief came from: its chance in a step after a wait and in that of a question, words, a ray."""

    wait: float
    ask: float
    words: int
    seen: int


@lean
def look(
    index: int,
    belief: Vector,
    smoothed: float,
    phase: int,
    heard: Vector,
    state: RandomState,
    distinct: DistinctWords,
    tables: Tables,
) -> Look:
    """Fill in the belief number `index` of an outlook from a phase. The chances of all numbers in turn sum to 1."""
    count = min(len(distinct.words), MOST_WORDS)
    wait, ask = tables.chances[phase, WAITED], tables.chances[phase, ASKED]
    if index > count:
        draw = index - count - 1
        if rays_a_draw(phase, tables) == 1:
            desired = draw_item(belief, (draw + uniform(state)) / distinct.rays)
            words = say(desired, uniform(state) < wait[WORDS], belief, smoothed, heard, state, tables)
            of, wait_share, ask_share = distinct.rays, 1.0, 1.0
        else:  # every other ray comes with a word, so that one draw serves both kinds of step
            of, words = distinct.rays // 2, draw % 2
            desired = draw_item(belief, (draw // 2 + uniform(state)) / of)
            say(desired, words == 1, belief, smoothed, heard, state, tables)
            wait_share = wait[WORDS] if words else 1.0 - wait[WORDS]
            ask_share = ask[WORDS] if words else 1.0 - ask[WORDS]
        seen = see(desired, tables.sigma * wait[WIDTH], heard, state, tables)
        return Look(wait[POINTS] / of * wait_share, ask[POINTS] / of * ask_share, words, seen)
    words, wait_chance, ask_chance, share = 1, wait[WORDS], ask[WORDS], 1.0
    if index == 0:
        for item in range(len(belief)):
            heard[item] = belief[item]
        words, wait_chance, ask_chance = 0, 1.0 - wait[WORDS], 1.0 - ask[WORDS]
    elif count == len(distinct.words):
        word = distinct.words[index - 1]
        hear_word(belief, smoothed, word, heard, tables)
        share = distinct.sizes[index - 1]
        chance = word_chance(belief, smoothed, word, tables)
        wait_chance, ask_chance = wait_chance * chance, ask_chance * chance
    else:
        desired = draw_item(belief, (index - 1 + uniform(state)) / count)
        say(desired, True, belief, smoothed, heard, state, tables)
        wait_chance, ask_chance = wait_chance / count, ask_chance / count
    see_nothing(heard, tables)
    wait_still, ask_still = 1.0 - wait[POINTS], 1.0 - ask[POINTS]
    return Look(wait_still * (share * wait_chance), ask_still * (share * ask_chance), words, 0)
