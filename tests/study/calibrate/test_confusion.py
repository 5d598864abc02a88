"""What was heard for what was said."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core.events import Observed
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.study.calibrate.confusion import NOTHING, aligned, confusion_of

texts = st.lists(st.sampled_from("abc"), max_size=6).map(tuple)


@pytest.mark.parametrize(
    ("said", "heard", "pairs"),
    [
        ("yes", "hand", [("yes", "hand")]),
        ("hand me the bowl", "hand the bowl", [("hand", "hand"), ("me", NOTHING), ("the", "the"), ("bowl", "bowl")]),
        ("no", "no the", [("no", "no"), (NOTHING, "the")]),
        ("", "", []),
    ],
)
def test_alignments(said: str, heard: str, pairs: list[tuple[str, str]]) -> None:
    assert aligned(said.split(), heard.split()) == pairs


@given(said=texts, heard=texts)
def test_an_alignment_loses_no_word_and_is_no_worse_than_word_by_word(
    said: tuple[str, ...], heard: tuple[str, ...]
) -> None:
    pairs = aligned(said, heard)
    assert tuple(word for word, _ in pairs if word) == said
    assert tuple(word for _, word in pairs if word) == heard
    wrong = sum(first != second for first, second in pairs)
    straight = sum(a != b for a, b in zip(said, heard, strict=False)) + abs(len(said) - len(heard))
    assert abs(len(said) - len(heard)) <= wrong <= straight
    assert wrong == sum(first != second for first, second in aligned(heard, said))


def test_a_table_counts_observations_with_a_known_text() -> None:
    said = [("yes", "yes"), ("yes", "hand"), ("no", "no"), ("no", "")]
    events = [Observed(Observation(tuple(heard.split())), spoken=tuple(text.split())) for text, heard in said]
    found = confusion_of([events, [Observed(Observation(("marker",)))]])
    assert found.counts == {("yes", "yes"): 1, ("yes", "hand"): 1, ("no", "no"): 1, ("no", NOTHING): 1}
    assert (found.said, found.word_error) == (4, 0.5)
    assert found.rows()["yes"] == {"yes": 0.5, "hand": 0.5}
