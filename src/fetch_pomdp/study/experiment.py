"""A study played: every assignment an encounter, every encounter a line on disk."""

from __future__ import annotations

import dataclasses
import functools
import io
import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeAlias

from fetch_pomdp.core.events import Event
from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.recordings import EventLog
from fetch_pomdp.files.writing import replaced
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import PERSON, WORLD, Study, assignments, stream
from fetch_pomdp.study.encounter import encounter
from fetch_pomdp.study.people.channel import Channel
from fetch_pomdp.study.record import LOGS, Record
from fetch_pomdp.study.trial import Assignment, Trial, scored

Speech: TypeAlias = Callable[[tuple[str, ...]], Channel]


@dataclass(frozen=True, slots=True)
class Played:
    """A trial, and its interaction event by event where the study keeps logs (JSON Lines, docs/events.md)."""

    trial: Trial
    log: str | None


def play(study: Study, speech: Speech | None, assignment: Assignment) -> Played:
    """Play an assigned trial; the result depends on the study and the assignment alone."""
    header = study.header(assignment)
    traits = study.population.traits(stream(study, PERSON, assignment.person))
    world = stream(study, WORLD, assignment.person, assignment.order)
    channel = None if speech is None else _channel(speech, header.scene.words)
    desired = header.scene.index(assignment.desired)
    met = encounter(header.agent(), desired, traits, study.clock, world, channel=channel)
    begun = met.begun - study.clock.overhead
    trial = scored(assignment, met.events, header.scene, begun)
    return Played(trial, logged(dataclasses.replace(header, begun=begun), met.events) if study.logs else None)


@functools.lru_cache
def _channel(speech: Speech, words: tuple[str, ...]) -> Channel:
    """Return a channel that lasts as long as its worker: what it has heard once it need not hear again."""
    return speech(words)


def logged(header: Header, events: Iterable[Event]) -> str:
    """Return the log of an interaction."""
    text = io.StringIO()
    log = EventLog.begin(text, header)
    for event in events:
        log.write(event)
    return text.getvalue()


def run(
    study: Study,
    folder: Path,
    crew: Crew | None = None,
    *,
    speech: Speech | None = None,
    told: Callable[[int], None] = lambda _: None,
) -> None:
    """Play what is missing of a study in a folder, `folder`/trials.jsonl; the file is the same whoever does the work.

    speech: for a study of real speech, what makes a channel for a scene's words; workers must be able to import it.
    told: called with the number of trials on disk, at the beginning and whenever it has grown. Memory does not grow
    with it. Raises StudyError if the folder holds another study, another run is writing there, or a study of real
    speech is given none.
    """
    if study.real_speech != (speech is not None):
        found = "none" if speech is None else "one, in a study of simulated words"
        raise StudyError(f"found {found}, expected a channel of speech with real_speech alone", field="speech")
    with Record.open(folder, study) as record:
        told(record.count)
        if record.count == study.size:
            return
        rest = itertools.islice(assignments(study), record.count, None)
        for played in (crew or Crew()).results(partial(play, study, speech), rest):
            if played.log is not None:
                _keep(played.log, folder / LOGS / f"{played.trial.person:04}-{played.trial.order:03}.jsonl")
            record.add(played.trial)
            told(record.count)


def _keep(log: str, path: Path) -> None:
    """Write a log whole or not at all: what was left of it by a run that was killed is replaced."""
    path.parent.mkdir(exist_ok=True)
    with replaced(path, StudyError) as file:
        file.write(log.encode())
