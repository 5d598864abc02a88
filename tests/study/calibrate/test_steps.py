"""Steps of logs whose words another reader read: they are those that the paper's reader would have had."""

from __future__ import annotations

import pytest

from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.header import Header
from fetch_pomdp.study.calibrate.steps import interaction_of, steps_of

SCENE = Scene.load("ambiguous")


def said(text: str) -> Observed:
    return Observed(Observation(tuple(text.split())))


@pytest.mark.parametrize(
    ("events", "words"),
    [
        ([said("hand me the marker . please")], [("hand", "me", "the", "marker", "please")]),
        ([said("the marker"), Acted(Point(2)), said("that's the one .")], [("the", "marker"), ("yes",)]),
        (
            [said("marker"), Acted(Pick(2), Outcome.STOPPED), said("stop wrong one"), Acted(Point(3)), said("uh-huh")],
            [("marker",), ("no", "no"), ("yes",)],
        ),
    ],
)
def test_answers_are_those_that_the_model_knows(events: list[Event], words: list[tuple[str, ...]]) -> None:
    read = interaction_of(Header(scene=SCENE, reader="table", target="marker-1"), events)
    assert [step.observation.words for step in steps_of(read.events, Problem(SCENE))] == words


def test_what_the_papers_reader_read_stays_as_it_is() -> None:
    events = [said("that's the one")]
    assert interaction_of(Header(scene=SCENE, target="marker-1"), events).events == tuple(events)
