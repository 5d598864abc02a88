"""The trials of a study on disk: a header with the study, then a line a trial, in the order of the assignments.

A trial counts as soon as its line is whole. After a kill the file is a beginning of the whole one, cut off anywhere:
what is left of a half-written line is cut off too, and the rest is played again.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.documents import Document, bounded, json_lines
from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.writing import append, unwritable
from fetch_pomdp.study.configuration import difference, digest, to_plain
from fetch_pomdp.study.design import Study, assignments
from fetch_pomdp.study.trial import Assignment, Trial

VERSION = 1
NAME = "trials.jsonl"
LOGS = "logs"  # the folder of interactions beside it
BLOCK = 1 << 16  # bytes
ASSIGNED = tuple(field.name for field in dataclasses.fields(Assignment))
COLUMNS = tuple(field.name for field in dataclasses.fields(Trial))


class Record:
    """A study's file of trials, open for more; `count` is how many it holds."""

    def __init__(self, stream: BinaryIO, count: int, path: Path) -> None:
        self._stream, self.count, self._path = stream, count, path

    @classmethod
    def open(cls, folder: Path, study: Study) -> Self:
        """Open the record of a study in a folder, new or from a run that was stopped.

        Raises StudyError if the folder cannot be written, another run is writing there, or what is there is of another
        study.
        """
        path = folder / NAME
        try:
            folder.mkdir(parents=True, exist_ok=True)
            stream = path.open("a+b", buffering=0)
        except (OSError, ValueError) as cause:
            reason = getattr(cause, "strerror", None) or cause
            raise StudyError(f"cannot be written: {reason}, expected a folder for a study", source=str(path)) from None
        try:
            _lock(stream, path)
            _cut_off_half_a_line(stream)
            record = cls(stream, 0, path)
            if stream.tell() == 0:
                record._write(header_of(study))
            record.count = _checked(stream, path, study)
        except BaseException:
            if stream.seek(0, 2) == 0:  # a new one that no line could be written to
                path.unlink()
            stream.close()
            raise
        return record

    def add(self, trial: Trial) -> None:
        """Add a trial, whole or not at all. Raises StudyError where the disk is full."""
        self._write(trial_to_json(trial))
        self.count += 1

    def _write(self, fields: Mapping[str, Any]) -> None:
        try:
            append(self._stream, json.dumps(fields, ensure_ascii=False).encode() + b"\n")
        except OSError as cause:
            raise unwritable(cause, self._path, StudyError) from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._stream.close()


def header_of(study: Study) -> dict[str, Any]:
    """Return the first line of a study's record."""
    plain = to_plain(study)
    return {"version": VERSION, "digest": digest(plain), "study": plain}


def read_trials(path: Path) -> Iterator[Trial]:
    """Yield the trials of a study's record as they are read, of one that is being written those that are whole.

    Raises StudyError with file, line and field.
    """
    try:
        with path.open("rb") as stream:
            lines = bounded(stream, str(path), StudyError)
            documents = json_lines((line for line in lines if line.endswith(b"\n")), str(path), StudyError)
            _header(documents, path)
            for document in documents:
                yield document.build(trial_from_json)
    except OSError as cause:
        raise StudyError(f"cannot be read: {cause.strerror}, expected a study's record", source=str(path)) from None


def trial_to_json(trial: Trial) -> dict[str, Any]:
    """Return the fields of a trial's line."""
    return {name: getattr(trial, name) for name in COLUMNS}


def trial_from_json(data: Mapping[str, Any]) -> Trial:
    """Build a trial from the fields of its line. Raises StudyError for a field that is missing, unknown or wrong."""
    if tuple(data) != COLUMNS:
        checks.known(data, COLUMNS, "field", StudyError)
        checks.required(data, COLUMNS, StudyError)
    for name in ("person", "order", "questions", "waits"):
        if type(data[name]) is not int or not 0 <= data[name] < 2**63:
            raise StudyError(f"found {shown(data[name])}, expected a whole number from 0", field=name)
    for name in ("layout", "paradigm", "desired"):
        checks.name(data[name], name, "a name", StudyError)
    if data["picked"] is not None:
        checks.name(data["picked"], "picked", "the id of an item, or null", StudyError)
    if type(data["correct"]) is not bool:
        raise StudyError(f"found {shown(data['correct'])}, expected true or false", field="correct")
    time = checks.number(data["time"], "time", "seconds", StudyError)
    return Trial(**{**data, "time": time})


def _header(documents: Iterator[Document], path: Path) -> Mapping[str, Any]:
    first = next(documents, None)
    found = None if first is None else first.data
    if found is None or set(found) != {"version", "digest", "study"} or found["version"] != VERSION:
        wanted = f"expected a first line with version {VERSION}, digest and study"
        raise StudyError(f"found {shown(found)}, {wanted}", source=str(path), line=1)
    return found


def _lock(stream: BinaryIO, path: Path) -> None:
    """Keep other runs from the file until this process ends, however it ends.

    Choice: where there is no flock (Windows) two runs at once are not noticed.
    """
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise StudyError("found another run writing there, expected one at a time", source=str(path)) from None


def _cut_off_half_a_line(stream: BinaryIO) -> None:
    """Truncate a file after its last line break, and leave its position there."""
    end = stream.seek(0, 2)
    while end > 0:
        begin = max(0, end - BLOCK)
        stream.seek(begin)
        found = stream.read(end - begin).rfind(b"\n")
        if found >= 0:
            end = begin + found + 1
            break
        end = begin
    stream.truncate(end)
    stream.seek(end)


def _checked(stream: BinaryIO, path: Path, study: Study) -> int:
    """Return how many trials a record holds. Raises StudyError unless they are the first ones of this study."""
    stream.seek(0)
    documents = json_lines(stream, str(path), StudyError)
    header, wanted = _header(documents, path), header_of(study)
    if header["digest"] != wanted["digest"]:
        where = difference(header["study"], wanted["study"])
        raise StudyError(f"found another study there ({where}), expected the same or a new folder", source=str(path))
    expected = assignments(study)
    count = 0
    for document in documents:
        trial, assigned = document.build(trial_from_json), next(expected, None)
        if assigned is None or any(getattr(trial, name) != getattr(assigned, name) for name in ASSIGNED):
            found = f"found {shown(trial)}, expected {shown(assigned)}"
            raise StudyError(found, source=str(path), line=document.line_of(""))
        count += 1
    return count
