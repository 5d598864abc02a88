"""What else a speaker might have said, and what the robot says that it understood."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from fetch_pomdp.core.language.reading.denotation import Denotation
from fetch_pomdp.core.language.reading.form import Description, Person, Select
from fetch_pomdp.core.language.reading.grammar import grammar
from fetch_pomdp.core.language.reading.likelihood import spoken
from fetch_pomdp.core.language.reading.speaker import ADDITIONS, alternatives, ease
from fetch_pomdp.core.language.reading.table import VIEWS, Table
from fetch_pomdp.core.language.reading.telling import told, whose
from fetch_pomdp.core.language.reading.weights import Weights
from tests.core.language.reading.tables import LINE, heard

WEIGHTS = Weights.default()
EASE = ease(Denotation(Table.of(LINE), grammar("english"), WEIGHTS)).reshape(-1)
GREEN, RED_LEFT, BOWL = 1, 0, 3


def test_what_may_be_said_is_each_word_alone_and_with_one_addition() -> None:
    found = alternatives(frozenset({"red", "green"}))
    assert len(found) == 2 * (1 + len(ADDITIONS))
    assert [str(said) for said, additions in found if additions == 0] == ["green", "red"]
    assert alternatives(frozenset())[0] == (Description(), 0)


def test_an_item_that_a_word_tells_apart_is_easier_than_one_of_two() -> None:
    assert EASE[GREEN] > EASE[RED_LEFT]
    assert EASE[BOWL] > EASE[RED_LEFT]


def test_what_was_not_said_counts_against_what_it_would_have_told_apart() -> None:
    even = np.full((len(VIEWS), 4), -np.log(4.0))
    found = np.exp(spoken(even, Description((Select("thing"),)), EASE, WEIGHTS))[0]
    assert found.sum() == pytest.approx(1.0)
    assert found[RED_LEFT] > found[GREEN]


def test_who_says_nothing_of_an_item_left_nothing_out() -> None:
    even = np.full((len(VIEWS), 4), -np.log(4.0))
    assert spoken(even, Description(), EASE, WEIGHTS) is even


def test_the_robot_tells_what_it_understood_and_asks_whose_left() -> None:
    assert told(heard("the red mug on my left")) == "I understood: red, mug, my left"
    assert told(heard("the left red mug")) == "I understood: left, red, mug; your left or mine?"
    assert told(heard("the green snark")) == 'I understood: green; I do not know "snark"'
    assert told(heard("frumious snark")).startswith("I did not understand")


@pytest.mark.parametrize(("listener", "person"), [(0.95, Person.YOU), (0.05, Person.ME), (0.5, None)])
def test_whose_left_is_known_where_one_view_is_far_likelier(listener: float, person: Person | None) -> None:
    views = tuple((listener if wide else 1.0 - listener) / 4.0 for _, wide, _ in VIEWS)
    assert whose(dataclasses.replace(heard("the left mug"), views=views)) is person
