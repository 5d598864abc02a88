"""The reader as a whole: what today's words could not say, and what they may."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from fetch_pomdp.core.language.reading.denotation import Denotation
from fetch_pomdp.core.language.reading.discourse import Before
from fetch_pomdp.core.language.reading.form import Description, Relation, Select
from fetch_pomdp.core.language.reading.reader import Context, TableReader
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.scene import Scene
from tests.core.language.reading.tables import LINE, READER, ROOM, heard, meant, scene

RED_LEFT, GREEN, RED_RIGHT, BOWL = range(4)


def chances(text: str, table: Scene = LINE, context: Context | None = None) -> list[float]:
    return [float(each) for each in np.exp(heard(text, table, context).log_likelihood)]


def test_a_denial_lowers_what_it_denies() -> None:
    found = chances("not the red one")
    assert found[RED_LEFT] < 0.1
    assert found[RED_RIGHT] < 0.1
    assert found[GREEN] > 0.3
    assert chances("anything but the red mug")[RED_LEFT] < 0.15


def test_none_of_these_lowers_what_was_asked_about() -> None:
    found = chances("none of these", context=Context(before=Before(asked=RED_LEFT)))
    assert found[RED_LEFT] == min(found)
    assert found[RED_LEFT] < 0.2


def test_a_correction_takes_back_what_was_said() -> None:
    found = heard("actually the bowl")
    assert found.corrects
    assert found.log_likelihood.argmax() == BOWL
    assert meant("the red mug, no wait, the green one") == GREEN
    assert not heard("the bowl").corrects


@pytest.mark.parametrize(
    ("text", "item"),
    [("the grean mug", GREEN), ("the bwol", BOWL), ("bowls", BOWL), ("the white thing", BOWL), ("a gren cup", GREEN)],
)
def test_words_that_are_spelt_otherwise_are_understood(text: str, item: int) -> None:
    assert meant(text) == item


def test_a_like_colour_stands_for_one_that_no_item_has() -> None:
    found = chances("the crimson one")
    assert found[RED_LEFT] + found[RED_RIGHT] > 0.8


@pytest.mark.parametrize(
    ("text", "item"),
    [
        ("the mug next to the bowl", RED_RIGHT),
        ("the mug between the two red ones", GREEN),
        ("the mug on my left", RED_LEFT),
        ("the red mug on my right", RED_RIGHT),
        ("the red mug on your left", RED_RIGHT),
        ("the second from my right", RED_RIGHT),
        ("third from my left", RED_RIGHT),
        ("my leftmost mug", RED_LEFT),
    ],
)
def test_places_are_understood(text: str, item: int) -> None:
    assert meant(text) == item


@pytest.mark.parametrize(
    ("text", "item"),
    [
        ("the bowl that is by itself", 3),
        ("there are three bowls in a row. take the one in the middle", 1),
        ("the middle one of the three bowls", 1),
        ("the plate closest to me", 4),
        ("the plate nearest to you", 5),
        ("the plate farthest from you", 4),
        ("look at the pan. i want the plate behind it, seen from my side", 5),
        ("the bowl close to the pan", 3),
        ("give me the bowl that is not in the row", 3),
    ],
)
def test_groups_and_people_are_understood(text: str, item: int) -> None:
    assert meant(text, ROOM) == item


@pytest.mark.parametrize(
    ("text", "item"),
    [("the one next to it", GREEN), ("the other red one", RED_RIGHT), ("the red one, not that one", RED_RIGHT)],
)
def test_words_after_a_question_are_about_what_was_asked(text: str, item: int) -> None:
    assert meant(text, LINE, Context(before=Before(asked=RED_LEFT))) == item


def test_the_same_as_before_is_what_was_meant_before() -> None:
    first = heard("the white bowl")
    assert meant("the same as before", LINE, first.context) == BOWL


def test_whose_left_was_named_once_is_known_the_next_time() -> None:
    fresh = chances("the leftmost mug")
    after = chances("the leftmost mug", context=heard("the red mug on my left").context)
    assert after[RED_LEFT] > fresh[RED_LEFT]


def test_the_place_of_the_robot_changes_its_left() -> None:
    beside = scene(("cup", -0.3, 0.8), ("cup", 0.3, 0.8), robot=(0.1, -0.2, 1.2))
    across = scene(("cup", -0.3, 0.8), ("cup", 0.3, 0.8), robot=(0.0, 1.8, 1.2))
    assert meant("the cup on your left", beside) == 0
    assert meant("the cup on your left", across) == 1


def test_an_item_with_a_front_has_a_front_of_its_own() -> None:
    def table(facing: tuple[float, float] | None) -> Scene:
        plain = scene(("car", 0.0, 0.8), ("cup", 0.0, 0.5), ("cup", 0.0, 1.1), ("cup", 0.3, 0.8))
        items = (dataclasses.replace(plain.items[0], facing=facing), *plain.items[1:])
        return dataclasses.replace(plain, items=items)

    plain, left = (
        chances("the cup in front of the car", table(None)),
        chances("the cup in front of the car", table((1, 0))),
    )
    assert left[3] > plain[3] + 0.1
    assert meant("the cup behind the car", table((-2.0, 0.0))) == 3


def test_unknown_words_are_reported_and_cost_confidence() -> None:
    plain, odd = heard("the green mug"), heard("the green frumious snark")
    assert plain.unknown == ()
    assert set(odd.unknown) == {"frumious", "snark"}
    assert odd.lost > plain.lost
    assert odd.log_likelihood.max() < plain.log_likelihood.max()


def test_what_says_nothing_is_no_evidence() -> None:
    for text in ("", "hm", "that one", "please"):
        found = heard(text).log_likelihood
        assert found == pytest.approx([found[0]] * 4)


def test_chances_are_a_distribution_whatever_is_said() -> None:
    for text in ("the red mug", "left", "not the bowl", "the one between the red ones and the bowl", "blue"):
        assert sum(chances(text)) == pytest.approx(1.0)


def test_readings_are_ranked_and_their_chances_sum_to_one() -> None:
    found = heard("the red mug next to the bowl on my right").readings
    assert [each.chance for each in found] == sorted((each.chance for each in found), reverse=True)
    assert sum(each.chance for each in found) == pytest.approx(1.0)


def test_one_item_alone_is_no_trouble() -> None:
    assert chances("the leftmost cup between the plates", scene(("cup", 0.0, 1.0))) == pytest.approx([1.0])


def test_reading_twice_is_the_same() -> None:
    again = TableReader()
    for text in ("second from the left", "the mug by itself"):
        assert heard(text).log_likelihood.tolist() == heard(text).log_likelihood.tolist()
        assert again.read(words_of(text), LINE, Context()).log_likelihood == pytest.approx(heard(text).log_likelihood)


def test_the_degrees_of_a_meaning_do_not_depend_on_what_was_asked_before() -> None:
    nested = [Description((Select("bowl"),))]
    for _ in range(9):
        nested.append(Description((Select("mug"), Relation("next to", nested[-1]))))
    fresh, used = (Denotation(Table.of(LINE), READER.grammar, READER.weights) for _ in range(2))
    used.of(nested[-1])
    for said in nested:
        np.testing.assert_array_equal(used.of(said), fresh.of(said))
