"""Descriptions counted exactly, against a sampler that makes them one by one, and against the reader's grammar."""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise

import numpy as np
import pytest
from numpy.random import Generator

from fetch_pomdp.adapters.speech.descriptions import AFTER, ARTICLES, DEFINITE, SAID, SHARES, WORD, Followers, followers
from fetch_pomdp.core.language.reading.grammar import grammar

ITEMS = ("bowl", "spoon", "red")
SENTENCES = 20_000


def make(symbol: str, rng: Generator) -> list[str]:
    """Make what a symbol may be, with an article where one is said."""
    if symbol == WORD:
        return [ITEMS[rng.integers(len(ITEMS))]]
    if symbol in SAID:
        phrases = SAID[symbol].split(", ")
        return phrases[rng.integers(len(phrases))].split()
    shares = np.array(list(SHARES[symbol].values()))
    parts = list(SHARES[symbol])[rng.choice(len(shares), p=shares / shares.sum())].split()
    words: list[str] = []
    for before, part in zip([None, *parts], parts, strict=False):
        alone = symbol == "NP" and len(parts) == 1
        if (alone or (before in AFTER and part in DEFINITE)) and rng.random() < ARTICLES:
            words.append("the")
        words += make(part, rng)
    return words


@pytest.fixture(scope="module")
def found() -> Followers:
    return followers(ITEMS)


def test_what_is_counted_is_what_a_sampler_makes(found: Followers) -> None:
    rng, pairs, squares, first = (
        np.random.default_rng(0),
        Counter[tuple[str, str]](),
        Counter[tuple[str, str]](),
        Counter[str](),
    )
    for _ in range(SENTENCES):
        words = make("NP", rng)
        first[words[0]] += 1
        here = Counter(pairwise(words))
        pairs.update(here)
        squares.update({pair: count * count for pair, count in here.items()})
    for place, word in enumerate(found.words):
        error = math.sqrt(found.first[place] * (1 - found.first[place]) / SENTENCES)
        assert first[word] / SENTENCES == pytest.approx(found.first[place], abs=4 * error + 1e-12)
        for other, after in enumerate(found.words):
            mean = pairs[word, after] / SENTENCES
            variance = max(squares[word, after] / SENTENCES - mean**2, found.follows[place, other])
            assert mean == pytest.approx(found.follows[place, other], abs=4.5 * math.sqrt(variance / SENTENCES) + 1e-12)


@pytest.mark.parametrize("vocabulary", [ITEMS, ("pen",), ("left", "of", "the")])
def test_every_word_is_come_to_as_often_as_it_is_left(vocabulary: tuple[str, ...]) -> None:
    counted = followers(vocabulary)
    assert counted.first.sum() == pytest.approx(1)
    assert counted.last.sum() == pytest.approx(1)
    np.testing.assert_allclose(
        counted.first + counted.follows.sum(axis=0), counted.last + counted.follows.sum(axis=1), atol=1e-12
    )


def test_what_is_said_is_in_the_readers_grammar() -> None:
    english = grammar("english")
    rules = {
        tuple(rule.name.partition(":")[0].split())
        for rules in [*english.unary.values(), *(each for right in english.binary.values() for each in right.values())]
        for rule in rules
        if rule.name
    }
    for parent, shares in SHARES.items():
        for parts in shares:
            assert (parent, "=", *parts.split()) in rules, f"{parent} = {parts}"
    for category, phrases in SAID.items():
        for phrase in phrases.split(", "):
            leaves = english.lexicon[tuple(phrase.split())]
            assert category in {leaf.category for leaf in leaves}, f"{category}: {phrase}"


@pytest.mark.parametrize(
    "sentence",
    ["the spoon to the left of the bowl", "the second one from the right", "the one between the bowl and the spoon"],
)
def test_what_people_say_is_expected(sentence: str, found: Followers) -> None:
    place = {word: index for index, word in enumerate(found.words)}
    words = sentence.split()
    assert found.first[place[words[0]]] > 0.1
    for before, after in pairwise(words):
        assert found.follows[place[before], place[after]] > 0.002 * found.follows[place[before]].sum(), (before, after)
