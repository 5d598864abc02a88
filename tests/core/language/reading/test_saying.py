"""The grammar read backwards: what is said is read as what was meant."""

from __future__ import annotations

import dataclasses
from collections import Counter

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from numpy.random import default_rng

from fetch_pomdp.core.language.reading.describing import Describer, describer, places
from fetch_pomdp.core.language.reading.form import (
    Between,
    Description,
    Form,
    Middle,
    Not,
    Ordinal,
    Person,
    Relation,
    Select,
    Side,
    Superlative,
    Toward,
)
from fetch_pomdp.core.language.reading.grammar import grammar
from fetch_pomdp.core.language.reading.reader import Context
from fetch_pomdp.core.language.reading.saying import Speaker, earlier
from fetch_pomdp.core.language.reading.table import Table
from fetch_pomdp.core.model import Model
from fetch_pomdp.core.scene import Scene
from tests.core.language.reading.tables import LINE, READER, ROOM, heard, meant, scene

SPEAKER = Speaker(grammar("english"), Table.of(LINE).vocabulary)
MUG, BOWL, MY_LEFT = Select("mug"), Description((Select("bowl"),)), Side(("left",), Person.ME)


def said(*parts: Form) -> list[str]:
    ways = SPEAKER.ways(Description(parts))
    return [" ".join(word for phrase in way for word in phrase) for way in ways]


@pytest.mark.parametrize(
    ("parts", "text"),
    [
        ((MUG,), "the mug"),
        ((Select("red"), MUG), "the red mug"),
        ((MUG, MY_LEFT), "my left mug"),
        ((MUG, MY_LEFT), "the mug on my left"),
        ((MUG, dataclasses.replace(MY_LEFT, extreme=True)), "my leftmost mug"),
        ((MUG, Superlative(Person.YOU)), "the mug closest to you"),
        ((MUG, Superlative(Person.ME, far=True)), "the mug farthest from me"),
        ((MUG, Ordinal(2), Toward(MY_LEFT)), "the mug second from my left"),
        ((Ordinal(2), Toward(Side(("left",)))), "the second one from the left"),
        ((MUG, Relation("next to", BOWL)), "the mug next to the bowl"),
        ((MUG, Relation("left of", BOWL)), "the mug to the left of the bowl"),
        ((MUG, Between(BOWL, Description((Select("green"),)))), "the mug between the bowl and the green"),
        ((MUG, Middle()), "the middle mug"),
        ((MUG, Not(MY_LEFT)), "the mug not on my left"),
        ((MUG, Not(Relation("next to", BOWL))), "the mug not next to the bowl"),
    ],
)
def test_ways_to_say_a_meaning(parts: tuple[Form, ...], text: str) -> None:
    assert text in said(*parts)


def test_what_no_rule_says_is_not_said() -> None:
    assert said(Relation("next to", Description())) == []


def test_what_may_be_taken_for_something_else_is_not_said() -> None:
    """ "by itself" may be beside it, "the right mug" the one that is meant; "alone" and "on the right" may not."""
    alone = describer(ROOM).speaker.ways(
        Description((Select("bowl"), *next(p for p in places(()) if str(p[0]) == "by itself")))
    )
    texts = [" ".join(word for phrase in way for word in phrase) for way in alone]
    assert "the bowl alone" in texts
    assert "the bowl by itself" not in texts


def test_a_way_has_nothing_twice() -> None:
    for text in said(MUG, MY_LEFT) + said(MUG, Ordinal(2), Toward(MY_LEFT)):
        words = text.split()
        assert Counter(words).most_common(1)[0][1] == 1, text


WORDS = st.lists(st.sampled_from(["red", "green", "metal", "large"]), max_size=2, unique=True)
NAMES = st.sampled_from(["mug", "bowl", "spoon", "marker"])
PLACES = st.tuples(st.integers(-6, 6), st.integers(4, 12))
TABLES = st.lists(st.tuples(NAMES, WORDS, PLACES), min_size=2, max_size=7, unique_by=lambda each: each[2])


@settings(max_examples=20, deadline=None, phases=(Phase.explicit, Phase.reuse, Phase.generate))
@given(rows=TABLES, seed=st.integers(0, 2**32 - 1))
def test_what_is_said_of_an_item_is_read_with_that_item_likeliest(
    rows: list[tuple[str, list[str], tuple[int, int]]], seed: int
) -> None:
    table = scene(*((" ".join([name, *words]), x / 10, y / 10) for name, words, (x, y) in rows))
    rng, one = default_rng(seed), Describer.of(table)
    for item, each in enumerate(table.items):
        count = int(rng.integers(len(each.vocabulary)))
        text = one.described(item, (*each.vocabulary[1 : 1 + count], each.vocabulary[0]), rng)
        words = [word for phrase in text for word in phrase]
        found = np.exp(READER.read(words, table, Context()).log_likelihood)
        assert not words or found[item] >= found.max() - 1e-5, (each.id, words, found)


@pytest.mark.parametrize("table", [LINE, ROOM, Scene.load("ambiguous"), Scene.load("unambiguous")])
def test_places_tell_items_apart_that_words_do_not(table: Scene) -> None:
    one, rng, plain, placed = describer(table), default_rng(0), list[float](), list[float]()
    for item, each in enumerate(table.items * 3):
        name, index = each.vocabulary[-1:], item % len(table.items)
        text = " ".join(word for phrase in one.described(index, name, rng) for word in phrase)
        plain.append(np.exp(heard(f"the {name[0]}", table).log_likelihood)[index])
        placed.append(np.exp(heard(text, table).log_likelihood)[index])
    assert np.mean(placed) > np.mean(plain) + 0.15


def test_what_tells_apart_better_is_said_more_often() -> None:
    """Of two red mugs, "next to the bowl" is one's alone; that it is in the middle, both could claim."""
    found, weights = describer(LINE).choices(2, ("red",))
    weight = dict(zip(map(str, found), weights, strict=True))
    assert weights.sum() == pytest.approx(1.0)
    beside = str((Relation("next to", Description((Select("white"),))),))
    assert weight[beside] > np.median(weights)


def test_all_words_are_said_before_the_name() -> None:
    rng = default_rng(3)
    for _ in range(20):
        words = [word for phrase in describer(ROOM).described(4, ("white", "plate"), rng) for word in phrase]
        assert words[words.index("plate") - 1] == "white"
        assert meant(" ".join(words), ROOM) == 4


def test_where_no_place_tells_an_item_none_is_said() -> None:
    """Two mugs at one place."""
    same = scene(("mug", 0.0, 0.8), ("mug", 0.0, 0.8), ("mug", 0.0, 0.8))
    words = describer(same).described(1, ("mug",), default_rng(0))
    assert not words or {"mug"} <= {word for phrase in words for word in phrase}


def test_a_scene_has_one_describer_whatever_robot_stands_there() -> None:
    other = dataclasses.replace(LINE, model=Model(sigma=0.3))
    assert describer(LINE) is describer(other)


def test_earlier_is_likelier() -> None:
    rng = default_rng(0)
    counts = np.bincount([earlier(3, rng) for _ in range(4_000)], minlength=3) / 4_000
    for found, expected in zip(counts, np.array([1, 1 / 4, 1 / 9]) / (1 + 1 / 4 + 1 / 9), strict=True):
        assert found == pytest.approx(expected, abs=4 * np.sqrt(expected * (1 - expected) / 4_000))
