"""Recorded interactions checked and lived through again."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from fetch_pomdp.core.action import Action
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.errors import EventError, InputError
from fetch_pomdp.files.events import action_to_json
from fetch_pomdp.files.recordings import Recording
from fetch_pomdp.files.scanning import Scan, scanned


def schema() -> dict[str, Any]:
    """Return the JSON Schema of the lines of a recorded interaction."""
    text = resources.files("fetch_pomdp.files").joinpath("log.schema.json").read_text(encoding="utf-8")
    return dict(json.loads(text))


def checked(path: str | Path) -> Scan:
    """Read a recorded interaction with everything that is wrong with it, in the order of its lines.

    Stricter than reading: times that go back are faults too, for a trial is timed by them. Raises EventError for an
    unreadable file.
    """
    found = scanned(path)
    faults = [*found.faults, *_backward(found)]
    faults.sort(key=lambda fault: fault.line or 0)
    return Scan(found.header, found.events, found.documents, tuple(faults), found.torn)


def _backward(found: Scan) -> Iterator[InputError]:
    latest = -float("inf")
    for event, document in zip(found.events, found.documents, strict=True):
        if event.time is None:
            continue
        if event.time < latest:
            problem = f"found {event.time:g} after {latest:g}, expected no earlier time"
            yield EventError(problem, field="t", source=document.source, line=document.line_of("t"))
        latest = max(latest, event.time)


@dataclass(frozen=True, slots=True)
class Relived:
    """An event of a recording, and the mind of the agent that lived through it.

    belief: after the event, (n_items,). decided: what the agent would have done in the place of a recorded action; None
    for what the person did, who gave an item back.
    """

    event: Event
    line: int | None
    belief: Vector
    asked: int | None
    decided: Action | None


def relived(recording: Recording) -> Iterator[Relived]:
    """Let the agent of a recording, with its planner and seed, live through it again and decide at each action.

    Raises BeliefError or ObservationError, with file and line, for an event that the model holds impossible.
    """
    agent, decided = recording.header.agent(), None
    for place, (event, document) in enumerate(zip(recording.events, recording.documents, strict=True)):
        chosen = isinstance(event, Acted) and event.outcome is not Outcome.RETURNED
        if decided is None and (chosen or (isinstance(event, Observed) and event.early)):
            decided = agent.decide(passes=_passes(recording.events[place:])).action
        document.build(lambda _, event=event: agent.take(event))  # type: ignore[misc]
        yield Relived(event, document.line_of(""), agent.belief, agent.asked, decided if chosen else None)
        decided = None if chosen else decided


def _passes(events: Sequence[Event]) -> int | None:
    """Return how many passes the next decision took, if it had a budget."""
    return next((event.passes for event in events if isinstance(event, Acted)), None)


def differences(recording: Recording) -> Iterator[InputError]:
    """Yield a complaint for each action that the recorded planner and seed do not decide again.

    A recording's robot may have been led by hand, or by a planner that is not of this package: then they differ.
    """
    scene = recording.header.scene
    for step, document in zip(relived(recording), recording.documents, strict=True):
        if isinstance(step.event, Acted) and step.decided is not None and step.decided != step.event.action:
            found, expected = (
                " ".join(map(str, action_to_json(action, scene).values()))
                for action in (step.event.action, step.decided)
            )
            problem = f"found {found}, expected {expected}, as the recorded planner decides with the recorded seed"
            yield EventError(problem, field="action", source=document.source, line=step.line)
