"""What has happened in an interaction, kept so that a page that comes back goes on where it was.

A page holds a secret of its own; the journal is found by its hash, so that no list of journals lets anybody in.
"""

from __future__ import annotations

import hashlib
import secrets
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from fetch_pomdp.core.action import Pick
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.language.reading.reader import Reader
from fetch_pomdp.errors import EventError, InputError
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.recordings import EventLog

MOST_KEPT = 1_000  # journals in memory, when there is no folder for them


class Sink(Protocol):
    """Where the events of an interaction are kept: a file, or a trial in a database."""

    def write(self, event: Event) -> None:
        """Keep an event; it is safe when this returns."""
        ...

    def close(self) -> None:
        """Keep no more."""
        ...


@dataclass(slots=True)
class Journal:
    """One interaction: what it is about, and its events, in memory and in a sink if there is one.

    clock: the time (s) on the interaction's clock when its person left, where that is known. reader: what reads the
    words, where that is none of ours.
    """

    secret: str
    header: Header
    events: list[Event] = field(default_factory=list)
    sink: Sink | None = None
    clock: float = 0.0
    reader: Reader | None = None

    @property
    def name(self) -> str:
        """The name under which the journal is found; it lets nobody in."""
        return name_of(self.secret)

    @property
    def time(self) -> float:
        """When (s) it goes on: with the last event, or later if somebody was there after it."""
        return max([self.clock, *(event.time for event in self.events if event.time is not None)])

    @property
    def picked(self) -> str | None:
        """The id of the item that was handed over, if one was."""
        last = self.events[-1] if self.events else None
        over = isinstance(last, Acted) and last.done and isinstance(last.action, Pick)
        return self.header.scene.items[last.action.item].id if over else None  # type: ignore[union-attr]

    def agent(self) -> Agent:
        """Return an agent that has taken in all of it."""
        agent = self.header.agent(reader=self.reader)
        for event in self.events:
            agent.take(event)
        return agent

    def write(self, event: Event) -> None:
        """Add an event; it is safe when this returns, if there is a sink."""
        self.events.append(event)
        if self.sink is not None:
            self.sink.write(event)

    def close(self) -> None:
        """Close the sink."""
        if self.sink is not None:
            self.sink.close()
            self.sink = None


def name_of(secret: str) -> str:
    """Return the name of the journal that a secret opens."""
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()[:32]


class Journals:
    """All journals: files in a folder, or without one the last ones in memory.

    Raises InputError for a folder that cannot be made.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self._kept: OrderedDict[str, Journal] = OrderedDict()
        if folder is not None:
            try:
                folder.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                found = error.strerror or error
                raise InputError(f"{folder}: {found}, expected a folder, or a place for one", field="--data") from None

    def new(self, header: Header) -> Journal:
        """Begin a journal. Raises EventError if its file cannot be written."""
        journal = Journal(secrets.token_urlsafe(24), header)
        if self._folder is not None:
            journal.sink = EventLog.create(self._path(journal.name), header)
        else:
            self._kept[journal.name] = journal
            while len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
        return journal

    def resumed(self, secret: str) -> Journal | None:
        """Return the journal that a secret opens, or None if there is none or it cannot be read any more."""
        name = name_of(secret)
        if self._folder is None:
            return self._kept.get(name)
        path = self._path(name)
        if not path.is_file():
            return None
        try:
            recording, log = EventLog.resume(path)
        except EventError:
            return None
        return Journal(secret, recording.header, list(recording.events), log)

    def _path(self, name: str) -> Path:
        return (self._folder or Path()) / f"{name}.jsonl"
