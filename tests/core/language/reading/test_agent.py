"""An agent that reads with the grammar: what the paper's words cannot say moves its belief the right way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.reading.reader import TableReader
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.live.person import LIVE_MODEL
from fetch_pomdp.core.observation import Observation
from tests.core.language.reading.tables import LINE, READER, scene

RED_LEFT, GREEN, RED_RIGHT, BOWL = range(4)


def agent(*turns: str | int) -> Agent:
    """An agent after turns: a text was said, or it asked about an item."""
    made = Agent(LINE, reader=READER)
    for turn in turns:
        if isinstance(turn, int):
            made.did(Point(turn))
        else:
            made.observe(turn)
    return made


@pytest.mark.parametrize(
    ("turns", "item"),
    [
        (("anything but a mug",), BOWL),
        (("red mug", "red mug", "actually the bowl"), BOWL),
        (("the mug", RED_LEFT, "yes", "no wait, the green one"), GREEN),
        (("the red mug", RED_LEFT, "no, the other one"), RED_RIGHT),
        (("the mug", RED_LEFT, "no the green one"), GREEN),
        (("the mug", RED_LEFT, "not that one, the other red one"), RED_RIGHT),
        (("the red mug next to the bowl",), RED_RIGHT),
        (("the grean mug",), GREEN),
        (("the bowl", BOWL, "yes"), BOWL),
    ],
)
def test_what_was_said_is_understood(turns: tuple[str | int, ...], item: int) -> None:
    assert agent(*turns).belief.argmax() == item


def test_without_a_reader_words_are_read_as_in_the_paper() -> None:
    plain = Agent(LINE)
    plain.observe("not the red one")
    assert plain.belief[RED_LEFT] > plain.belief[GREEN]
    assert agent("not the red one").belief[RED_LEFT] < agent("not the red one").belief[GREEN]


def test_answers_are_those_of_the_paper() -> None:
    plain, reading = Agent(LINE), Agent(LINE, reader=READER)
    for each in (plain, reading):
        each.did(Point(GREEN))
        assert each.observe("yes").meaning is Meaning.YES
    assert reading.belief == pytest.approx(plain.belief)


def test_a_gesture_counts_as_it_did_and_stays_after_a_correction() -> None:
    made = Agent(LINE, reader=READER)
    made.observe("the bowl", head=(0.0, 0.0, 1.6), wrist=(-0.15, 0.4, 1.175))
    made.observe("no wait, a red mug")
    assert made.belief.argmax() == RED_LEFT
    assert made.belief[RED_LEFT] > 2.0 * made.belief[RED_RIGHT]


def test_what_was_heard_and_not_known_is_told() -> None:
    made = Agent(LINE, reader=TableReader())
    assert made.observe("the green snark").unknown == ("snark",)
    assert made.understood.heard is not None
    assert str(made.understood.heard.readings[0].meaning) == "green"
    assert made.observe("").unknown == ()
    assert made.understood.heard is None


def test_evidence_and_belief_agree() -> None:
    made = agent("the mug on my left", RED_RIGHT, "no", "the red one")
    evidence = made.evidence
    log = evidence.prior + evidence.words + evidence.answers + evidence.pointing
    assert made.belief == pytest.approx(np.exp(log - np.logaddexp.reduce(log)))


def test_silence_is_no_evidence_and_the_robot_still_decides() -> None:
    made = agent("the green mug", "", "")
    assert isinstance(made.act(), Pick)
    quiet = Agent(LINE, reader=READER)
    quiet.update(Observation())
    assert quiet.belief == pytest.approx([0.25] * 4)


def test_a_word_that_all_items_share_is_a_request_and_one_of_courtesy_is_none() -> None:
    table = scene(("marker", -0.3, 0.9), ("marker", 0.3, 0.9))
    made = Agent(dataclasses.replace(table, model=LIVE_MODEL), reader=READER)
    assert made.observe("could you please").base == ()
    assert isinstance(made.decide().action, Wait)
    assert made.observe("the marker").base == ("the", "marker")
    assert made.belief == pytest.approx([0.5, 0.5], abs=0.05)
    made.observe("")
    assert isinstance(made.decide().action, Point), "it asks which"
