"""One trial of a study: who asks whom for what, and how it went."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.scene import Scene


@dataclass(frozen=True, slots=True)
class Assignment:
    """A row of an experiment's trial list, fixed before anybody acts."""

    person: int
    layout: str
    paradigm: str  # how the robot decides, by its name in the experiment
    desired: str  # id of the item
    order: int  # place among the person's trials, from 0


@dataclass(frozen=True, slots=True)
class Trial:
    """How a trial went; one row of the table of a study."""

    person: int
    layout: str
    paradigm: str
    desired: str
    order: int
    time: float  # s, from the beginning of the request to the decision to pick (Section IV); the end if there is none
    correct: bool
    picked: str | None  # id of the item; None if the robot never picked
    questions: int
    waits: int


def scored(assignment: Assignment, events: Iterable[Event], scene: Scene, begun: float) -> Trial:
    """Return how a trial went from what happened in it; begun: when the request began (s).

    A trial ends with the first hand-over, whatever comes of it.

    Choice: a robot that picks before the request begins took no time, not less than none.
    """
    questions = waits = 0
    picked, time = None, begun
    for event in events:
        time = event.time if event.time is not None else time
        if isinstance(event, Acted) and event.done:
            questions += isinstance(event.action, Point)
            waits += isinstance(event.action, Wait)
            if isinstance(event.action, Pick):
                picked = scene.items[event.action.item].id
                break
    return Trial(
        assignment.person, assignment.layout, assignment.paradigm, assignment.desired, assignment.order,
        max(0.0, time - begun), picked == assignment.desired, picked, questions, waits,
    )  # fmt: skip
