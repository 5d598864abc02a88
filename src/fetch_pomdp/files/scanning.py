"""All that is in a recorded interaction, and all that is wrong with it, in one reading."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from fetch_pomdp.core.action import Pick
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.documents import Document, json_line, read_raw
from fetch_pomdp.errors import EventError, InputError
from fetch_pomdp.files.events import event_from_json
from fetch_pomdp.files.header import Header, header_from_json

Made = TypeVar("Made")
ANCHORS = frozenset({"action", "observation"})  # without them a line is another line


@dataclass(frozen=True, slots=True)
class Scan:
    """What a file holds; every fault names file, line and field. `header` is None only where there are faults."""

    header: Header | None
    events: tuple[Event, ...]
    documents: tuple[Document, ...]  # the lines of the events
    faults: tuple[InputError, ...]
    torn: int | None  # number of a last line that was not written to its end, and is left out


def scanned(path: str | Path) -> Scan:
    """Read a recorded interaction to its end, whatever is wrong with it. Raises EventError for an unreadable file."""
    faults: list[InputError] = []
    lines, torn = _lines(path, faults)
    if not lines:
        if not faults:
            faults.append(EventError("found an empty file, expected a first line with the scene", source=str(path)))
        return Scan(None, (), (), tuple(faults), torn)
    found: list[InputError] = []
    header = _built(lines[0], header_from_json, found, {"scene": next(iter(LAYOUTS))})
    scene_known = not any(_first(fault.field) == "scene" for fault in found)
    faults += [fault for fault in found if scene_known or fault.field != "target"]
    if header is None:
        return Scan(None, (), (), tuple(faults), torn)
    scene, events, documents = header.scene, list[Event](), list[Document]()
    for document in lines[1:]:
        found = []
        event = _built(document, lambda data: event_from_json(data, scene), found, {"item": scene.items[0].id})
        faults += [fault for fault in found if scene_known or fault.field != "item"]
        misplaced = None if event is None else _misplaced(event, events)
        if misplaced is not None:
            faults.append(misplaced.located(document.source, document.line_of(misplaced.field)))
            break
        if event is not None:
            events.append(event)
            documents.append(document)
    return Scan(header, tuple(events), tuple(documents), tuple(faults), torn)


def _misplaced(event: Event, events: Sequence[Event]) -> EventError | None:
    """Return a complaint about an event that cannot come after those before, None for one that can.

    A hand-over ends all but what takes it back or begins anew; and nothing else does either.
    """
    last = events[-1] if events else None
    returned = isinstance(event, Acted) and event.outcome is Outcome.RETURNED
    if last is not None and ends(last):
        if event.anew if isinstance(event, Observed) else returned and _same_action(event, last):
            return None
        return EventError("found an event after the hand-over, expected the end, its return, or a request anew")
    if returned:
        return EventError("found 'returned', expected the same pick, done, before it", field="outcome")
    if isinstance(event, Observed) and event.anew:
        return EventError("found true, expected a pick that was done before another request", field="anew")
    return None


def _same_action(one: Event, other: Event) -> bool:
    return isinstance(one, Acted) and isinstance(other, Acted) and one.action == other.action


def ends(event: Event) -> bool:
    """Whether an interaction may end with this event: an item was handed over."""
    return isinstance(event, Acted) and event.done and isinstance(event.action, Pick)


def _lines(path: str | Path, faults: list[InputError]) -> tuple[list[Document], int | None]:
    """Return the lines that are JSON objects, and the number of a half-written last one.

    No proper beginning of a JSON object is one itself; so a line without its end is told from a whole one that only
    lacks the line break.
    """
    raw = read_raw(path, EventError).split(b"\n")
    documents: list[Document] = []
    for number, line in enumerate(raw, start=1):
        try:
            document = json_line(line, str(path), number, EventError)
        except EventError as error:
            if number == len(raw) and documents and not faults:
                return documents, number
            faults.append(error)
            continue
        if document is not None:
            documents.append(document)
    return documents, None


def _built(
    document: Document,
    make: Callable[[Mapping[str, Any]], Made],
    faults: list[InputError],
    stand_ins: Mapping[str, Any],
) -> Made | None:
    """Return what `make` builds of a line; what it refuses is noted, and left out or stood in for, until it takes it.

    A field that is missed once it is left out takes the one around it along.
    """
    data: Mapping[str, Any] = document.data
    fields: set[str] = set()
    while True:
        try:
            return Document(document.source, data, document.line_of).build(make)
        except InputError as error:
            field = error.field
            if field not in fields:
                faults.append(error)
            while field in fields:
                field = _parent(field)
            fields.add(field)
            smaller = {**data, field: stand_ins[field]} if field in stand_ins else _without(data, field)
            if smaller is None or field in ANCHORS:
                return None
            data = smaller


def _first(field: str) -> str:
    return re.split(r"[.\[]", field, maxsplit=1)[0]


def _parent(field: str) -> str:
    """Return the field that holds this one: a whole list for one of its elements."""
    return re.sub(r"(\.[^.\[\]]+|\[\d+\])$", "", field) if re.search(r"[.\]]", field) else ""


def _without(data: Mapping[str, Any], field: str) -> Mapping[str, Any] | None:
    """Return the data without a field, or None where there is no such field to leave out."""
    steps = re.findall(r"[^.\[\]]+", field)
    found, smaller = _left(data, steps) if steps else (False, None)
    return smaller if found else None


def _left(holder: Any, steps: list[str]) -> tuple[bool, Any]:
    """Return whether there is something at the end of `steps`, and a copy of what holds it without it."""
    key: Any = steps[0]
    if isinstance(holder, list) and len(key) < 9 and key.isdecimal() and int(key) < len(holder):
        key = int(key)
    elif not isinstance(holder, Mapping) or key not in holder:
        return False, None
    copied: Any = list(holder) if isinstance(holder, list) else dict(holder)
    if len(steps) == 1:
        del copied[key]
        return True, copied
    found, copied[key] = _left(holder[key], steps[1:])
    return found, copied
