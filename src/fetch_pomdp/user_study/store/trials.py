"""One trial in the database, written event by event."""

from __future__ import annotations

import json
import threading
import time
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa
from sqlalchemy import Connection

from fetch_pomdp.core.events import Event
from fetch_pomdp.documents import Document
from fetch_pomdp.errors import StoreError
from fetch_pomdp.files.events import event_from_json, event_to_json
from fetch_pomdp.files.header import Header, header_from_json, header_to_json
from fetch_pomdp.files.scanning import ends
from fetch_pomdp.user_study.store.database import Database, key_of
from fetch_pomdp.user_study.store.participants import as_json, now
from fetch_pomdp.user_study.store.schema import EVENTS, PARTICIPANTS, SOUNDS, TRIALS

FRESH = 20.0  # s in which a person's `last` is not written again
MOST_SOUND = 600  # s of sound that are kept of a trial
SECOND = 32_000  # bytes of sound


@dataclass(frozen=True, slots=True)
class Row:
    """Where a trial is in the database."""

    trial: int
    participant: int


class StoredTrial:
    """A trial that is written as it happens: what a method was given is committed when it returns. From any thread.

    clock: the time (s) on the trial's clock when it was last noted, None before it ran.

    Choice: of a trial's sound no more than MOST_SOUND seconds are kept, so that no page can fill the disk.
    """

    def __init__(
        self, database: Database, row: Row, header: Header, events: tuple[Event, ...] = (), clock: float | None = None
    ) -> None:
        self._database, self._row, self.header, self.clock = database, row, header, clock
        self._events = list(events)
        self._sounds: tuple[int, int] | None = None  # pieces, bytes
        self._touched = -FRESH
        self._lock = threading.Lock()
        self.finished = False
        self.given_up = False

    @property
    def events(self) -> tuple[Event, ...]:
        """What has happened."""
        return tuple(self._events)

    def write(self, event: Event) -> None:
        """Add an event; a pick that was done finishes the trial in the same commit.

        Raises StoreError if another server writes this trial, or it was deleted.
        """
        with self._lock:
            line = as_json(event_to_json(event, self.header.scene), "event")
            with self._database.writing() as connection:
                self._touch(connection)  # first, as a deletion of the person does: neither waits for the other
                values = {"trial": self._row.trial, "number": len(self._events), "line": line}
                connection.execute(EVENTS.insert().values(values))
                if ends(event):
                    self._finish(connection, given_up=False)
            self._events.append(event)
            self.finished = self.finished or ends(event)

    def finish(self, *, given_up: bool) -> None:
        """Note that the trial is over; one that is over already is left alone."""
        with self._lock:
            if self.finished:
                return
            with self._database.writing() as connection:
                self._touch(connection)
                self._finish(connection, given_up=given_up)
            self.finished, self.given_up = True, given_up

    def note_clock(self, time: float) -> None:
        """Note the time (s) on the trial's clock: it goes on there when its person has left and comes back."""
        with self._lock, self._database.writing() as connection:
            connection.execute(TRIALS.update().where(TRIALS.c.id == self._row.trial).values(clock=time))
            self.clock = time

    def keep_sound(self, start: float, pcm: bytes) -> None:
        """Add sound that began at a time (s) of the trial's clock: 16 bit, mono, 16 kHz."""
        with self._lock, self._database.writing() as connection:
            number, size = self._sounds or _kept(connection, self._row.trial)
            self._sounds = number, size
            if size + len(pcm) > MOST_SOUND * SECOND:
                return
            values = {"trial": self._row.trial, "number": number, "start": start, "pcm": pcm}
            connection.execute(SOUNDS.insert().values(values))
            self._sounds = number + 1, size + len(pcm)

    def close(self) -> None:
        """Do nothing: everything is in the database already."""

    def _touch(self, connection: Connection) -> None:
        if time.monotonic() - self._touched < FRESH:
            return
        connection.execute(PARTICIPANTS.update().where(PARTICIPANTS.c.id == self._row.participant).values(last=now()))
        self._touched = time.monotonic()

    def _finish(self, connection: Connection, *, given_up: bool) -> None:
        over = {"finished": now(), "given_up": given_up}
        connection.execute(TRIALS.update().where(TRIALS.c.id == self._row.trial).values(over))


def opened(database: Database, participant: int, part: str, order: int, header: Header) -> StoredTrial:
    """Begin a trial, or go on with the one that is there, which keeps its own header.

    A trial whose clock ran and that was not over is counted as interrupted once more.
    """
    with database.writing() as connection:
        place = (TRIALS.c.participant == participant, TRIALS.c.part == part, TRIALS.c.number == order)
        found = connection.execute(TRIALS.select().where(*place)).one_or_none()
        if found is None:
            values = {"participant": participant, "part": part, "number": order, "interruptions": 0, "given_up": False}
            line = as_json(header_to_json(header), "header")
            added = connection.execute(TRIALS.insert().values(**values, header=line))
            return StoredTrial(database, Row(key_of(added), participant), header)
        journal = _read(database, connection, found)
        if journal.clock is not None and not journal.finished:
            again = {"interruptions": TRIALS.c.interruptions + 1}
            connection.execute(TRIALS.update().where(TRIALS.c.id == found.id).values(again))
    return journal


def _read(database: Database, connection: Connection, found: sa.Row[Any]) -> StoredTrial:
    header = header_from_json(json.loads(found.header))
    events = events_of(connection, found.id, header)
    journal = StoredTrial(database, Row(found.id, found.participant), header, events, found.clock)
    journal.finished, journal.given_up = found.finished is not None, found.given_up
    return journal


def events_of(connection: Connection, trial: int, header: Header) -> tuple[Event, ...]:
    """Return the events of a trial. Raises StoreError, naming the event, for one that cannot be read."""
    rows = connection.execute(EVENTS.select().where(EVENTS.c.trial == trial).order_by(EVENTS.c.number))
    return tuple(_event(row.line, row.number, header) for row in rows)


def _event(line: str, number: int, header: Header) -> Event:
    try:
        document = Document(f"event {number}", json.loads(line), lambda _: None)
        return document.build(lambda data: event_from_json(data, header.scene))
    except ValueError as cause:
        raise StoreError(f"cannot be read: {cause}", field=f"events[{number}]") from None


def _kept(connection: Connection, trial: int) -> tuple[int, int]:
    """Return how many pieces of sound are kept of a trial, and their bytes."""
    size = sa.func.coalesce(sa.func.sum(sa.func.length(SOUNDS.c.pcm)), 0)
    pieces, there = connection.execute(sa.select(sa.func.count(), size).where(SOUNDS.c.trial == trial)).one()
    return int(pieces), int(there)
