"""Items by the names on their labels: which words are names, and what they say about the items."""

from __future__ import annotations

import dataclasses

import pytest

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.names import as_spoken, named, with_names, words_besides_name
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.scene import Scene

SCENE = named(live_scene("ambiguous"))
KNOWN = SCENE.words


@pytest.mark.parametrize(
    "said",
    [
        "spoon 1",
        "spoon-1",
        "spoon1",
        "the spoon number one",
        "spoon one",
        "please hand me spoon 1",
        "spoon nummer eins",
    ],
)
def test_a_name_makes_its_item_the_leader_by_far(said: str) -> None:
    agent = Agent(SCENE)
    agent.observe(said)
    # By hand (Eq. 4, 5): each of the two words is 1 + 1 / alpha = 26 times as likely of an item that has it.
    assert agent.belief[4] == pytest.approx(26**2 / (26**2 + 26 + 4))
    assert agent.belief[5] == pytest.approx(26 / (26**2 + 26 + 4))


@pytest.mark.parametrize("said", ["spoon one more", "one spoon", "spoon 9", "two spoons", "1", "one of the spoon"])
def test_a_number_that_names_nothing_is_no_name(said: str) -> None:
    assert with_names(said.split(), KNOWN) == tuple(said.split())


def test_what_was_read_is_read_as_it_is() -> None:
    read = with_names(["give", "me", "marker", "2", "and", "spoon-1"], KNOWN)
    assert read == ("give", "me", "marker", "marker-2", "and", "spoon", "spoon-1")
    assert with_names(read, KNOWN) == read


def test_answers_are_read_beside_names() -> None:
    agent = Agent(SCENE)
    agent.observe("spoon")
    assert agent.observe("no, spoon 2").response == ("no",)
    assert agent.belief.argmax() == 5


def test_only_what_there_are_several_of_has_names() -> None:
    items = [
        {"id": name, "position": [x, 2.0, 0.75], "vocabulary": [word]}
        for x, name, word in ((-0.3, "Coffee cup 1", "cup"), (0.0, "coffee_cup_02", "cup"), (0.3, "pen-1", "pen"))
    ]
    scene = named(Scene.from_mapping({"head": [0, 0, 1.6], "items": items}))
    assert [item.vocabulary for item in scene.items] == [("cup", "coffee-cup-1"), ("cup", "coffee-cup-2"), ("pen",)]
    assert with_names(["coffee", "cup", "two"], scene.words) == ("coffee", "cup", "coffee-cup-2")
    assert [words_besides_name(item) for item in scene.items] == [("cup",), ("cup",), ("pen",)]


def test_a_scene_that_was_read_knows_no_names() -> None:
    scene = Scene.load("ambiguous")
    assert live_scene("ambiguous").items == scene.items
    assert with_names(["spoon", "1"], scene.words) == ("spoon", "1")
    assert dataclasses.replace(named(scene), items=scene.items) == scene


def test_a_recogniser_listens_for_names_as_they_sound() -> None:
    assert as_spoken(["pen", "spoon-1", "spoon-12", "t-shirt"]) == ["pen", "t-shirt", "spoon-one"]
    assert with_names(["spoon-one"], KNOWN) == ("spoon", "spoon-1")
