"""Speech: Eq. 4-6 and Table I, each likelihood beside its sampler.

Choice: a word that no item has in its vocabulary, and that is no response, carries no information: it is left out
before Eq. 4, and an utterance of such words alone counts as empty. Read to the letter, Eq. 5 gives such a word a
probability alpha / (|vocab| + alpha |words|), which would favour items with few words.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp.core.compiled import Vector, inlined
from fetch_pomdp.core.language.words import MEANINGS, NEGATIVE, POSITIVE, RESPONSES, Meaning
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.turns import StepChances

Words = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Utterance:
    """The words of an utterance l, split into those of Eq. 4, those of Eq. 6 and those not understood.

    meaning: of the last answer in it, also of one that is no evidence about the item ("unsure"), which is in no part.
    """

    base: Words = ()
    response: Words = ()
    unknown: Words = ()
    meaning: Meaning | None = None


def split(words: Words, problem: Problem) -> Utterance:
    """Split the words of an utterance (Section III-C); lower case, as `words.tokenize` gives them."""
    base, response, unknown, meaning = [], [], [], None
    for word in words:
        if word in problem.word_index:
            base.append(word)
            continue
        answer = MEANINGS.get(word)
        meaning = answer or meaning
        if word in RESPONSES:
            response.append(word)
        elif answer is None:
            unknown.append(word)
    return Utterance(tuple(base), tuple(response), tuple(unknown), meaning)


def base_log_likelihood(base: Words, problem: Problem) -> Vector:
    """Log probability of the base words given each item as the desired one, log p(l_b | i_d) (Eq. 4, 5).

    base: words of the scene. Returns (n_items,) in scene order.
    """
    tables = problem.tables
    if not base:
        return np.full(problem.n_items, math.log1p(-tables.p_l))
    result = len(base) * problem.log_smoothing + math.log(tables.p_l)
    gain = math.log1p(1.0 / tables.alpha)
    for word in base:
        index = problem.word_index[word]
        result[tables.word_items[tables.word_starts[index] : tables.word_starts[index + 1]]] += gain
    return result


def sample_base(desired: int, problem: Problem, p_words: float, rng: Generator) -> Words:
    """Draw the base words of one step: one word, or none (Section III-D-1). p_words: chance of any."""
    spoken, which = rng.random(), rng.random()
    return (problem.words[draw_word(desired, which, problem.tables)],) if spoken < p_words else ()


@inlined
def draw_word(desired: int, which: float, tables: Tables) -> int:
    """Return the index of the word that a uniform number in [0, 1) selects by Eq. 5."""
    # By Eq. 5 each of the item's own words has mass `smoothing`, and each word of the scene alpha times that on top.
    mass = tables.smoothing[desired]
    start, own = tables.item_starts[desired], tables.item_starts[desired + 1] - tables.item_starts[desired]
    slot = which / mass
    if slot < own:
        return int(tables.item_words[start + int(slot)])
    return min(int((slot - own) / tables.alpha), len(tables.word_starts) - 2)


def response_log_likelihood(response: Words, asked: int | None, problem: Problem, chances: StepChances) -> Vector:
    """Log probability of the response words given each item as the desired one, log p(l_r | i_d, i_r) (Eq. 6).

    Choice: Table I gives the probability of the class of a response word; within it each word is equally likely, so
    that the probabilities of all words sum to 1.

    asked: index of i_r, or None. chances: see `Problem.step_chances`. Returns (n_items,).
    """
    if not response:
        result = np.full(problem.n_items, _log(1.0 - chances.other))
        if asked is not None:
            result[asked] = _log(1.0 - chances.desired)
        return result
    positive = sum(word in POSITIVE for word in response)
    negative = len(response) - positive
    within = positive * math.log(len(POSITIVE)) + negative * math.log(len(NEGATIVE))
    if asked is None:
        return np.full(problem.n_items, _log(chances.other) - within + len(response) * math.log(0.5))
    true, false = math.log(problem.model.p_truth), _log(1.0 - problem.model.p_truth)
    result = np.full(problem.n_items, _log(chances.other) - within + _times(positive, false) + _times(negative, true))
    result[asked] = _log(chances.desired) - within + _times(positive, true) + _times(negative, false)
    return result


def sample_response(desired: int, asked: int | None, problem: Problem, chances: StepChances, rng: Generator) -> Words:
    """Draw the response of one step: one word, or none (Table I, Section III-D-1)."""
    if rng.random() >= (chances.desired if asked == desired else chances.other):
        return ()
    p_truth = problem.model.p_truth
    p_positive = 0.5 if asked is None else p_truth if asked == desired else 1.0 - p_truth
    words = POSITIVE if rng.random() < p_positive else NEGATIVE
    return (words[int(rng.random() * len(words))],)


def _log(probability: float) -> float:
    return math.log(probability) if probability > 0 else -math.inf


def _times(count: int, log: float) -> float:
    return count * log if count else 0.0  # 0 * -inf would be no number
