"""Utterances with several readings, on their way into an observation."""

from __future__ import annotations

import math

import pytest

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.hearing import MOST, understood
from fetch_pomdp.core.language.answers import PAPER, After
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Word
from fetch_pomdp.core.scene import Scene

READER = Agent(Scene.load("ambiguous")).answers


def utterance(start: float, *readings: tuple[str, float]) -> list[Word]:
    """Return the words of the first reading, with all of them."""
    among = tuple(Alternative(tuple(text.split()), weight) for text, weight in readings)
    return [Word(text, start + k, start + k + 1, 0.9, among) for k, text in enumerate(among[0].words)]


def weights(observation: Observation) -> dict[str, float]:
    return {" ".join(each.words): each.weight for each in observation.alternatives}


def test_words_without_readings_are_one_string() -> None:
    words = [Word("hand", 0, 1), Word("marker", 1, 2)]
    assert understood(words, PAPER, After.NOTHING) == Observation(("hand", "marker"))


def test_each_reading_is_read_as_an_answer_and_equal_ones_are_one() -> None:
    words = utterance(0.0, ("nope", 0.5), ("wrong one", 0.3), ("nah", 0.1), ("spoon", 0.1))
    found = understood(words, READER, After.QUESTION)
    assert found.words == ("nope",)
    assert weights(found) == pytest.approx({"nope": 0.5, "no": 0.4, "spoon": 0.1})


def test_readings_that_mean_the_same_are_none() -> None:
    words = utterance(0.0, ("that's right", 0.6), ("that's the one", 0.4))
    assert understood(words, READER, After.QUESTION) == Observation(("yes",))


def test_two_utterances_are_combined() -> None:
    words = [*utterance(0.0, ("no", 0.8), ("one", 0.2)), *utterance(5.0, ("the spoon", 0.75), ("the bowl", 0.25))]
    found = understood(words, PAPER, After.QUESTION)
    assert found.words == ("no", "the", "spoon")
    expected = {"no the spoon": 0.6, "no the bowl": 0.2, "one the spoon": 0.15, "one the bowl": 0.05}
    assert weights(found) == pytest.approx(expected)


def test_alike_readings_of_two_utterances_are_not_one_utterance() -> None:
    words = [*utterance(0.0, ("no", 0.8), ("one", 0.2)), *utterance(5.0, ("no", 0.8), ("one", 0.2))]
    assert weights(understood(words, PAPER, After.QUESTION))["no no"] == pytest.approx(0.64)


def test_part_of_an_utterance_is_what_it_was_heard_as() -> None:
    words = utterance(0.0, ("no the spoon", 0.6), ("nose spoon", 0.4))[1:]
    assert understood(words, PAPER, After.QUESTION) == Observation(("the", "spoon"))


def test_of_many_utterances_the_likeliest_readings_are_kept() -> None:
    words = [word for k in range(8) for word in utterance(9.0 * k, ("no", 0.7), (f"spoon{k}", 0.3))]
    found = understood(words, PAPER, After.QUESTION)
    assert len(found.alternatives) == MOST
    assert math.fsum(each.weight for each in found.alternatives) == pytest.approx(1.0)
    assert found.words == ("no",) * 8
    assert max(found.alternatives, key=lambda each: each.weight).words == found.words


def test_what_was_read_before_comes_first_in_every_reading() -> None:
    words = utterance(0.0, ("the spoon", 0.6), ("the bowl", 0.4))
    found = understood(words, PAPER, After.NOTHING, before=("marker",))
    assert weights(found) == pytest.approx({"marker the spoon": 0.6, "marker the bowl": 0.4})
