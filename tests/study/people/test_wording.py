"""Requests in the words of the reader's own grammar: read as meant, and partly in words that nobody knows."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.random import default_rng

from fetch_pomdp.core.language.reading.reader import Context, TableReader
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.study.people.grammar import GRAMMARS, Words
from fetch_pomdp.study.people.wording import UNKNOWN, WORDINGS, by_reader
from tests.study.people.plain import AMBIGUOUS, share, traits

READER = TableReader()
BOTH = (AMBIGUOUS, Scene.load("unambiguous"))
ONES, TWOS = (0.0, 1.0), (0.0, 0.0, 1.0)


def requests(count: int, scene: Scene = AMBIGUOUS, **people: object) -> list[tuple[int, Words]]:
    who, rng = traits(**people), default_rng(5)
    desired = [number % len(scene.items) for number in range(count)]
    return [(item, by_reader(item, scene, who, rng)) for item in desired]


def chances(words: Words, scene: Scene) -> np.ndarray:
    return np.exp(READER.read(words, scene, Context()).log_likelihood)


def test_every_grammar_has_its_wording() -> None:
    assert tuple(WORDINGS) == GRAMMARS


@pytest.mark.parametrize("scene", BOTH)
def test_a_place_tells_an_item_from_its_twin(scene: Scene) -> None:
    """Without one a word says as much for either, so that the two have half each at most."""
    placed = requests(60, scene, p_place=1.0, descriptors=ONES)
    for item, words in placed:
        found = chances(words, scene)
        assert found[item] >= found.max() - 1e-3, words
    told = [chances(words, scene)[item] for item, words in placed]
    plain = [chances(words, scene)[item] for item, words in requests(60, scene, p_place=0.0, descriptors=ONES)]
    assert np.mean(plain) <= 0.5
    assert np.mean(told) > 0.65


def test_places_are_said_as_often_as_told() -> None:
    """A request without one is the item's words, and what stands around them."""
    said = requests(2_000, p_place=0.3, descriptors=ONES)
    plain = [words for item, words in said if "the" in words and words.index("the") in range(len(words) - 1)
             and words[words.index("the") + 1 :] in ((AMBIGUOUS.items[item].vocabulary[0],),
                                                     (AMBIGUOUS.items[item].vocabulary[0], "please"))]  # fmt: skip
    assert share(len(plain) / 2_000, 0.7, 2_000)


def test_the_item_has_as_many_words_as_its_shares_say() -> None:
    for item, words in requests(100, p_place=1.0, descriptors=TWOS):
        assert len(set(words) & set(AMBIGUOUS.items[item].vocabulary)) == 2, words


def test_some_of_it_nobody_knows() -> None:
    """Of the one phrase that is no article: "the whatsit"."""
    said = requests(1_000, p_place=0.0, descriptors=ONES, p_unknown=0.2)
    odd = [words for _, words in said if set(words) & set(UNKNOWN)]
    assert share(len(odd) / 1_000, 0.2, 1_000)
    assert not any(set(words) & set(UNKNOWN) for _, words in requests(100, p_place=1.0))


@pytest.mark.parametrize("word", UNKNOWN)
def test_what_nobody_knows_is_unknown_to_the_reader(word: str) -> None:
    assert READER.read(("the", word), AMBIGUOUS, Context()).unknown == (word,)


def test_the_same_numbers_give_the_same_request() -> None:
    assert requests(20, p_place=0.5, p_unknown=0.1) == requests(20, p_place=0.5, p_unknown=0.1)
