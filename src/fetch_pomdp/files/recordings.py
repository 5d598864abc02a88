"""Recorded interactions on disk: JSON Lines, the first line a header, each further one an event (`docs/events.md`)."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self, TextIO

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Event
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.documents import Document
from fetch_pomdp.errors import EventError
from fetch_pomdp.files.events import event_to_json
from fetch_pomdp.files.header import Header, header_to_json
from fetch_pomdp.files.scanning import ends, scanned
from fetch_pomdp.files.writing import LineFile


@dataclass(frozen=True, slots=True)
class Recording:
    """An interaction as it was recorded."""

    header: Header
    events: tuple[Event, ...]
    documents: tuple[Document, ...]  # the lines of the events
    torn: int | None = None  # number of a last line that a kill left half-written; it is left out

    @property
    def over(self) -> bool:
        """Whether an item was handed over, and nothing came after it."""
        return bool(self.events) and ends(self.events[-1])

    def replay(self, agent: Agent) -> Iterator[Event]:
        """Let an agent live through the interaction; yield each event after the agent has taken it in.

        Raises BeliefError or ObservationError, with file and line, for an event that the model holds impossible.
        """
        for event, document in zip(self.events, self.documents, strict=True):
            document.build(lambda _, event=event: agent.take(event))  # type: ignore[misc]
            yield event


class EventLog:
    """Writes an interaction as it happens: each line is flushed, so that a kill loses at most the one being written.

    A file that cannot be written any more raises EventError, and holds the lines before.
    """

    def __init__(self, stream: TextIO | LineFile, scene: Scene) -> None:
        self._stream, self._scene = stream, scene

    def write(self, event: Event) -> None:
        """Add an event."""
        self._write(event_to_json(event, self._scene))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def _write(self, fields: Mapping[str, Any]) -> None:
        self._stream.write(json.dumps(fields, ensure_ascii=False) + "\n")
        self._stream.flush()

    @classmethod
    def begin(cls, stream: TextIO | LineFile, header: Header) -> Self:
        """Start a log on an empty stream."""
        log = cls(stream, header.scene)
        log._write(header_to_json(header))
        return log

    @classmethod
    def create(cls, path: str | Path, header: Header) -> Self:
        """Start a log in a new file. Raises EventError if the file exists or cannot be written."""
        file = LineFile(path, "x", EventError)
        try:
            return cls.begin(file, header)
        except BaseException:
            file.close()
            file.path.unlink()
            raise

    @classmethod
    def resume(cls, path: str | Path) -> tuple[Recording, Self]:
        """Return what a log holds, and the log open to go on; a last line that a kill cut short is dropped.

        Raises InputError, with file, line and field, for a file that is not a log.
        """
        try:
            with Path(path).open("r+b") as file:
                whole = file.read().rfind(b"\n") + 1
                file.truncate(whole)
        except (OSError, ValueError) as cause:
            reason = getattr(cause, "strerror", None) or cause
            raise EventError(f"cannot be read: {reason}, expected a log", source=str(path)) from None
        recording = read_recording(path)
        return recording, cls(LineFile(path, "a", EventError), recording.header.scene)


def read_recording(path: str | Path) -> Recording:
    """Read a recorded interaction. Raises InputError, with file, line and field, for what cannot be one.

    A last line that was not written to its end is left out: whoever wrote it was killed there.
    """
    found = scanned(path)
    if found.faults or found.header is None:
        raise found.faults[0]
    return Recording(found.header, found.events, found.documents, found.torn)
