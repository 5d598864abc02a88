"""One trial of a study: who asks whom for what, and how it went, simulated or recorded with real people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EventError
from fetch_pomdp.files.recordings import Recording


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


def trials_of(recordings: Iterable[tuple[str, Recording]]) -> Iterator[Trial]:
    """Yield how each recorded trial went, in the order given; each recording comes with the name of its file.

    Raises EventError, with the file, where the header does not say who wanted what: `person` and `target`, and `layout`
    of a scene that is not built in.

    Choice: a trial without `order` is the next of its person, one without `begun` began at 0, and one without
    `paradigm` has its planner's name.
    """
    known: Counter[int] = Counter()
    for source, recording in recordings:
        assignment = assignment_of(recording, source, known)
        yield scored(assignment, recording.events, recording.header.scene, recording.header.begun or 0.0)


def assignment_of(recording: Recording, source: str, known: Counter[int]) -> Assignment:
    """Return the trial that a recording is of, counting the person's trials in `known`. Raises as `trials_of`."""
    header = recording.header
    layout = header.layout or header.scene_name
    for name, value in (("person", header.person), ("target", header.target), ("layout", layout)):
        if value is None:
            found = "found none, expected it in the header of a trial of a study"
            raise EventError(found, field=name, source=source, line=1)
    person, target = header.person or 0, header.target or ""
    order = known[person] if header.order is None else header.order
    known[person] += 1
    return Assignment(person, layout or "", header.paradigm or header.planner, target, order)
