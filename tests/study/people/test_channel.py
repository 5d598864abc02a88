from __future__ import annotations

from collections import Counter
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import default_rng

from fetch_pomdp.core.ports import Word
from fetch_pomdp.study.people.channel import INSERTED, MistakenWords, miss_chance
from fetch_pomdp.study.people.parameters import CONFUSIONS, People
from fetch_pomdp.study.people.traits import draw_mood

from .plain import AMBIGUOUS, share, still

COUNT = 4000


def channel(people: People) -> MistakenWords:
    rng = default_rng(0)
    return MistakenWords(people, draw_mood(people.traits(rng), rng), AMBIGUOUS.words)


def said(text: str) -> tuple[Word, ...]:
    return tuple(Word(word, float(place), place + 1.0) for place, word in enumerate(text.split()))


def hear(text: str, distance: float = 1.0, seed: int = 1, **changes: Any) -> list[list[str]]:
    """Say a text many times and return what was heard each time."""
    ears, rng, words = channel(still(**changes)), default_rng(seed), said(text)
    return [[word.text for word in ears.hear(words, distance=distance, voice=0, rng=rng)] for _ in range(COUNT)]


def test_without_mistakes_it_is_heard_as_it_was_said() -> None:
    words = said("hand me the green marker")
    assert channel(still()).hear(words, distance=9.0, voice=0, rng=default_rng(0)) == words


def test_a_request_is_missed_as_a_whole_and_the_farther_the_more() -> None:
    for distance, chance in ((1.0, 0.2), (4.0, 0.5)):  # odds of 1/4 become 1 in two doublings by log 2 each
        heard = hear("the green marker", distance, p_miss=0.2, miss_per_doubling=0.6931471805599453)
        assert share(heard.count([]) / COUNT, chance, COUNT)
        assert heard.count([]) + heard.count(["the", "green", "marker"]) == COUNT


def test_answers_are_missed_by_a_chance_of_their_own() -> None:
    assert share(hear("no the other one", p_miss=1.0, p_lost=0.3).count([]) / COUNT, 0.3, COUNT)
    assert hear("the marker", p_miss=0.0, p_lost=1.0).count([]) == 0


def test_the_chance_of_a_miss_at_the_two_layouts_is_near_our_fit() -> None:
    people = People()
    assert miss_chance(people.p_miss, 1.49, people.miss_per_doubling) == pytest.approx(0.13, abs=0.01)
    assert miss_chance(people.p_miss, 3.31, people.miss_per_doubling) == pytest.approx(0.25, abs=0.03)


def test_yes_is_misheard_as_hand() -> None:
    heard = Counter(words[0] for words in hear("yes", confusions=CONFUSIONS))
    for text, chance in CONFUSIONS["yes"].items():
        assert share(heard[text] / COUNT, chance, COUNT)
    assert share(heard["yes"] / COUNT, 1 - sum(CONFUSIONS["yes"].values()), COUNT)


def test_a_word_of_the_scene_is_heard_as_any_other_of_the_scene() -> None:
    heard = Counter(words[0] for words in hear("marker", p_substitute=0.55))
    assert set(heard) == set(AMBIGUOUS.words)
    assert len(AMBIGUOUS.words) == 12
    for word in set(AMBIGUOUS.words) - {"marker"}:
        assert share(heard[word] / COUNT, 0.05, COUNT)


def test_other_words_are_not_substituted() -> None:
    assert hear("please yes", p_substitute=1.0).count(["please", "yes"]) == COUNT


def test_a_word_is_deleted_as_often_as_told() -> None:
    heard = hear("hand me", p_delete=0.3)
    assert share(sum(map(len, heard)) / (2 * COUNT), 0.7, 2 * COUNT)
    assert share(heard.count([]) / COUNT, 0.09, COUNT)


def test_a_word_is_inserted_after_another_as_often_as_told() -> None:
    heard = hear("marker", p_insert=0.4)
    extra = Counter(word for words in heard for word in words[1:])
    assert share(sum(extra.values()) / COUNT, 0.4, COUNT)
    assert set(extra) <= {*INSERTED, *AMBIGUOUS.words}
    assert len(extra) > 40


@given(st.integers(0, 2**32), st.floats(0, 1), st.floats(0, 1), st.floats(0, 1))
def test_heard_words_are_in_order_and_within_what_was_said(
    seed: int, delete: float, insert: float, swap: float
) -> None:
    ears, words = channel(still(p_delete=delete, p_insert=insert, p_substitute=swap)), said("the green marker yes")
    heard = ears.hear(words, distance=2.0, voice=0, rng=default_rng(seed))
    times = [time for word in heard for time in (word.start, word.end)]
    assert times == sorted(times)
    assert all(0.0 <= time <= 4.0 for time in times)
    assert heard == ears.hear(words, distance=2.0, voice=0, rng=default_rng(seed))
