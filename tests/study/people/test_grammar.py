from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import default_rng

from fetch_pomdp.core.language.words import COURTESY, NEGATIVE, POSITIVE, RESPONSES
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.study.people import grammar

from .plain import AMBIGUOUS, share

BOWL, MARKER, TWIN = AMBIGUOUS.items[0], AMBIGUOUS.items[2], AMBIGUOUS.items[3]
COUNT = 4000


def requests(shares: tuple[float, ...], p_name: float = 1.0, place: str = "") -> list[grammar.Words]:
    rng = default_rng(2)
    return [grammar.request(MARKER, shares, p_name, place, rng) for _ in range(COUNT)]


def test_a_request_names_the_item_by_as_many_words_as_its_chances_say() -> None:
    shares = (0.1, 0.2, 0.4, 0.3)
    counts = Counter(len({*said} & {*MARKER.vocabulary}) for said in requests(shares))
    for count, chance in enumerate(shares):
        assert share(counts[count] / COUNT, chance, COUNT)


def test_the_name_is_said_as_often_as_told_and_after_the_other_words() -> None:
    said = requests((0.0, 0.0, 1.0), p_name=0.7)
    named = [words for words in said if "marker" in words]
    assert share(len(named) / COUNT, 0.7, COUNT)
    assert all(words[words.index("marker") - 1] in MARKER.vocabulary for words in named)


def test_the_other_words_of_the_item_are_as_likely() -> None:
    counts = Counter(word for said in requests((0.0, 0.0, 1.0)) for word in said if word in MARKER.vocabulary[1:])
    for word in MARKER.vocabulary[1:]:
        assert share(counts[word] / COUNT, 1 / 3, COUNT)


def test_words_around_the_item_say_nothing_about_it_and_are_no_answers() -> None:
    rest = {word for said in requests((0.1, 0.2, 0.4, 0.3)) for word in said} - {*MARKER.vocabulary}
    assert rest <= COURTESY
    assert not rest & RESPONSES


def test_without_a_word_it_is_that_one() -> None:
    assert all("that one" in " ".join(said) for said in requests((1.0,)))


def test_more_words_than_there_are_is_all_of_them() -> None:
    rng = default_rng(0)
    item = Item(id="cup", position=(0.0, 1.0, 0.0), vocabulary=("cup",))
    assert all("cup" in grammar.request(item, (0.0, 0.0, 0.0, 1.0), 0.0, "", rng) for _ in range(50))


def test_a_place_comes_after_the_item() -> None:
    assert grammar.next_to(2, AMBIGUOUS) == "next to the bowl"
    assert grammar.next_to(3, AMBIGUOUS) == "next to the spoon"
    assert grammar.next_to(0, Scene(items=(BOWL,), head=(0.0, 0.0, 1.6))) == ""
    said = " ".join(requests((0.0, 1.0), place="next to the spoon")[0])
    assert "marker next to the spoon" in said


@given(st.integers(0, 2**32))
def test_answers_have_words_of_table_one_of_one_kind(seed: int) -> None:
    rng = default_rng(seed)
    assert RESPONSES & {*grammar.affirmation(rng)} <= {*POSITIVE}
    assert RESPONSES & {*grammar.affirmation(rng)}
    assert RESPONSES & {*grammar.denial(rng)} <= {*NEGATIVE}
    assert RESPONSES & {*grammar.denial(rng)}
    assert not RESPONSES & {*grammar.UNSURE}


@pytest.mark.parametrize("weight", [0.0, 1.0, 3.0])
def test_a_contrast_is_drawn_by_the_power_of_the_literal_listener(weight: float) -> None:
    # A green pen and a green cup: of "pen", "green" and "other one", "green" leaves two in question.
    pen = Item(id="pen", position=(0.0, 1.0, 0.0), vocabulary=("pen", "green"))
    cup = Item(id="cup", position=(1.0, 1.0, 0.0), vocabulary=("cup", "green"))
    rng = default_rng(4)
    counts = Counter(" ".join(grammar.contrast(pen, cup, weight, rng)) for _ in range(COUNT))
    total = 2 + 0.5**weight
    for said, mass in {"the pen": 1.0, "the green": 0.5**weight, "the other one": 1.0}.items():
        assert share(counts[said] / COUNT, mass / total, COUNT)


def test_of_two_of_a_kind_the_implicature_speaker_wants_the_other_one() -> None:
    rng = default_rng(1)
    assert {grammar.contrast(MARKER, TWIN, 20.0, rng) for _ in range(100)} == {("the", "other", "one")}


def test_of_two_with_no_word_in_common_there_is_no_other_one() -> None:
    rng = default_rng(1)
    said = {grammar.contrast(MARKER, BOWL, 1.0, rng)[1:] for _ in range(200)}
    assert said == {(word,) for word in MARKER.vocabulary}


def test_weights_draw_in_proportion() -> None:
    rng = default_rng(9)
    counts = Counter(grammar.weighted("abc", (1.0, 0.0, 3.0), rng) for _ in range(COUNT))
    assert counts["b"] == 0
    assert share(counts["a"] / COUNT, 0.25, COUNT)
