from __future__ import annotations

import math
import re
from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.adapters.speech.bigram import COMMON, language_model, own_words
from fetch_pomdp.core.language.words import NEGATIVE, POSITIVE

WORDS = ["marker", "green", "spoon", "the", "weather"]  # with a determiner and a common word, as a scene may have them


class Arpa:
    """An ARPA bigram model, read from the format's description alone."""

    def __init__(self, text: str) -> None:
        counts = dict(re.findall(r"^ngram (\d)=(\d+)$", text, re.M))
        _, unigrams, bigrams = re.split(r"\\[12]-grams:\n", text)
        self.alone, self.backoff, self.pairs = {}, {}, {}
        for line in unigrams.strip().splitlines():
            p, word, backoff = line.split()
            self.alone[word], self.backoff[word] = 10 ** float(p), 10 ** float(backoff)
        for line in bigrams.strip().removesuffix("\\end\\").strip().splitlines():
            p, history, word = line.split()
            self.pairs[history, word] = 10 ** float(p)
        assert (len(self.alone), len(self.pairs)) == (int(counts["1"]), int(counts["2"]))

    def probability(self, word: str, history: str) -> float:
        return self.pairs.get((history, word), self.backoff[history] * self.alone[word])


@pytest.mark.parametrize("vocabulary", [WORDS, ["pen"], [], ["pen", "pen"]])
@pytest.mark.parametrize("common", [COMMON, ["weather"], []])
def test_probabilities_sum_to_one_after_every_word(vocabulary: list[str], common: Sequence[str]) -> None:
    model = Arpa(language_model(vocabulary, common))
    words = [word for word in model.alone if word != "<s>"]
    for history in model.alone:
        if history != "</s>":
            assert math.fsum(model.probability(word, history) for word in words) == pytest.approx(1, abs=2e-4)


@settings(max_examples=20, deadline=None)
@given(st.lists(st.from_regex("[a-z]{2,8}", fullmatch=True), max_size=12))
def test_any_vocabulary_gives_a_distribution(vocabulary: list[str]) -> None:
    model = Arpa(language_model(vocabulary))
    assert {*vocabulary, *POSITIVE, *NEGATIVE, *COMMON} <= set(model.alone)
    assert {*own_words(vocabulary), *COMMON} == set(model.alone) - {"<s>", "</s>"}
    for history in ("<s>", "the", *vocabulary):
        total = math.fsum(model.probability(word, history) for word in model.alone if word != "<s>")
        assert total == pytest.approx(1, abs=2e-4)


def test_items_are_likelier_than_other_words_where_they_are_named() -> None:
    model = Arpa(language_model(WORDS))
    assert model.probability("marker", "the") > 20 * model.probability("music", "the")
    assert model.probability("no", "<s>") > 20 * model.probability("music", "<s>")


def test_the_same_words_give_the_same_text() -> None:
    assert language_model(WORDS) == language_model(tuple(WORDS))
