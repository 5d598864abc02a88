"""Whatever is said, the reader neither fails nor hangs."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.language.reading.grammar import grammar
from fetch_pomdp.core.language.reading.tokens import MOST_WORDS
from hostile import strike
from tests.core.language.reading.tables import LINE, ROOM, heard

KNOWN = sorted({word for phrase in grammar("english").lexicon for word in phrase} | {"red", "mug", "bowl", "."})


def finite(text: str) -> None:
    for table in (LINE, ROOM):
        found = heard(text, table)
        assert np.isfinite(found.log_likelihood).all()
        assert abs(np.exp(found.log_likelihood).sum() - 1.0) < 1e-9
        assert 0.0 <= found.lost <= 1.0


@settings(deadline=None, max_examples=60)
@given(text=st.text(max_size=80))
def test_any_text(text: str) -> None:
    finite(text)


@settings(deadline=None, max_examples=120)
@given(words=st.lists(st.sampled_from(KNOWN), max_size=24))
def test_any_order_of_words_that_it_knows(words: list[str]) -> None:
    finite(" ".join(words))


def test_long_and_repeated_words() -> None:
    growing = "i want zorgon behind " * 30  # "behind" it, which is all that was said before, and so twice as much
    for text in (
        growing,
        "left " * 500,
        "not " * 200 + "red",
        "the mug next to " * 60,
        "a" * 100_000,
        "it it it it",
        ". . .",
    ):
        finite(text)
    assert heard("red " * 1000).unknown == ()
    assert MOST_WORDS < 1000


def test_a_part_of_the_benchmark_of_hostile_strings() -> None:
    found = strike(1_000, seed=1)
    assert found.failed == []
    assert sum(found.counts.values()) == 1_000
