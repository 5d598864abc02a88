"""A study written into a folder, as logs and tables that the analysis reads (docs/study-with-people.md).

Choice: `logs` has the trials that are over; a trial that its person has not ended is under `unfinished`, so that it is
not taken for one in which the robot never picked.

Choice: in tables a text that a spreadsheet would take for a formula begins with an apostrophe; logs have it as it is.
"""

from __future__ import annotations

import csv
import dataclasses
import json
import tempfile
import wave
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sqlalchemy as sa
from sqlalchemy import Connection

from fetch_pomdp.errors import StoreError
from fetch_pomdp.files.recordings import read_recording
from fetch_pomdp.study.trial import trials_of
from fetch_pomdp.user_study.store.participants import Progress, progress_of, study_named
from fetch_pomdp.user_study.store.schema import ANSWERS, EVENTS, PARTICIPANTS, SOUNDS, STUDIES, TRIALS

RATE, WIDTH = 16_000, 2  # Hz, bytes
JITTER = 0.1  # s that a piece of sound may come late and still follow the one before it
FORMULA = ("=", "+", "-", "@", "\t")  # what a spreadsheet takes for the beginning of a formula
PRIVATE = 0o700
PEOPLE = (
    "person", "code", "language", "stage", "joined", "consented", "consent_text", "finished", "trials_done", "of",
    "interruptions", "given_up", "completion",
)  # fmt: skip
CONDITIONS = ("person", "order", "interruptions", "given_up")  # of each trial that is over


@dataclass(frozen=True, slots=True)
class Exported:
    """What was written."""

    study: str
    people: int
    trials: int  # that are over
    unfinished: int
    practice: int


def export(connection: Connection, folder: Path, study: str | None) -> Exported:
    """Write a study into a new folder; None: the only study of the database.

    Raises StoreError if `folder` exists already or cannot be written, or for an unknown study.
    """
    name = study_named(connection, study)
    if folder.exists():
        raise StoreError("exists already, expected a new folder", source=str(folder))
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}-") as beside:
            made = Path(beside) / "export"
            made.mkdir(PRIVATE)
            exported = _written(connection, made, name)
            made.rename(folder)  # there wholly or not at all
    except OSError as cause:
        reason = cause.strerror or cause
        raise StoreError(f"cannot be written: {reason}", source=str(folder)) from None
    return exported


def _written(connection: Connection, folder: Path, study: str) -> Exported:
    people, rows = progress_of(connection, study), _trials(connection, study)
    counts = dict.fromkeys(("logs", "practice", "unfinished"), 0)
    for row in rows:
        part = _part(row)
        counts[part] += 1
        path = folder / part / f"{row.person:04}-{row.number:03}.jsonl"
        path.parent.mkdir(exist_ok=True)
        path.write_text("".join(f"{line}\n" for line in _lines(connection, row)), encoding="utf-8")
        sound = folder / "sound" / path.relative_to(folder / "logs" if part == "logs" else folder)
        write_wav(sound.with_suffix(".wav"), _sounds(connection, row.id))
    logs = sorted((folder / "logs").glob("*.jsonl"))
    _table(folder / "participants.csv", PEOPLE, (_person(one) for one in people))
    over = sorted((row for row in rows if _part(row) == "logs"), key=lambda row: (row.person, row.number))
    conditions = ((row.person, row.number, row.interruptions, bool(row.given_up)) for row in over)
    _table(folder / "conditions.csv", CONDITIONS, conditions)
    _table(folder / "answers.csv", ("person", "question", "value"), _answers(connection, study))
    if attention := list(_attention(connection, study)):
        _table(folder / "attention.csv", ("person", "passed", "of"), attention)
    trials = [dataclasses.asdict(trial) for trial in trials_of((str(log), read_recording(log)) for log in logs)]
    if trials:
        _table(folder / "trials.csv", tuple(trials[0]), (tuple(trial.values()) for trial in trials))
    return Exported(study, len(people), counts["logs"], counts["unfinished"], counts["practice"])


def _part(trial: sa.Row[Any]) -> str:
    """Return the folder that a trial belongs to."""
    return "practice" if trial.part == "practice" else "unfinished" if trial.finished is None else "logs"


def _of_people(study: str, *columns: sa.Column[Any]) -> sa.Select[Any]:
    """Return a query for columns of the people of a study."""
    people, studies = PARTICIPANTS, STUDIES
    query = sa.select(people.c.person, *columns).join_from(people, studies, people.c.study == studies.c.id)
    return query.where(studies.c.name == study).order_by(people.c.person)


def _trials(connection: Connection, study: str) -> Sequence[sa.Row[Any]]:
    names = ("id", "part", "number", "header", "finished", "interruptions", "given_up")
    columns = (TRIALS.c[name] for name in names)
    query = _of_people(study, *columns).join(TRIALS, TRIALS.c.participant == PARTICIPANTS.c.id)
    return connection.execute(query.order_by(TRIALS.c.part, TRIALS.c.number)).all()


def _lines(connection: Connection, trial: sa.Row[Any]) -> Iterator[str]:
    """Yield the lines of a trial's log, as they were written."""
    query = sa.select(EVENTS.c.line).where(EVENTS.c.trial == trial.id).order_by(EVENTS.c.number)
    yield trial.header
    yield from connection.execute(query).scalars()


def _sounds(connection: Connection, trial: int) -> Iterator[tuple[float, bytes]]:
    for row in connection.execute(SOUNDS.select().where(SOUNDS.c.trial == trial).order_by(SOUNDS.c.number)):
        yield row.start, row.pcm


def _person(one: Progress) -> tuple[object, ...]:
    return tuple(getattr(one, name) for name in PEOPLE)


def _answers(connection: Connection, study: str) -> Iterator[tuple[object, ...]]:
    """Yield person, question and value; text as it is, anything else as JSON."""
    for row in _given(connection, study):
        value = json.loads(row.value)
        yield row.person, row.question, value if isinstance(value, str) else row.value


def _given(connection: Connection, study: str) -> sa.CursorResult[Any]:
    """Return person, question and value (JSON) of all answers."""
    query = _of_people(study, ANSWERS.c.question, ANSWERS.c.value)
    query = query.join(ANSWERS, ANSWERS.c.participant == PARTICIPANTS.c.id)
    return connection.execute(query.order_by(ANSWERS.c.question))


def _attention(connection: Connection, study: str) -> Iterator[tuple[int, int, int]]:
    """Yield person, attention checks passed, and how many they answered."""
    found: dict[int, list[bool]] = {}
    for row in _given(connection, study):
        given = json.loads(row.value)
        if isinstance(given, dict):  # the answers to other questions are none
            found.setdefault(row.person, []).append(given["passed"])
    for person, passed in found.items():
        yield person, sum(passed), len(passed)


def _table(path: Path, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([_cell(value) for value in row] for row in rows)


def _cell(value: object) -> object:
    """Return a value as a spreadsheet may read it: a text that would be a formula there begins with an apostrophe."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value


def write_wav(path: Path, pieces: Iterable[tuple[float, bytes]]) -> None:
    """Write pieces of sound, each with the time (s) it began at, with silence between; no file for no pieces.

    Choice: a piece that is late by less than JITTER follows at once: the network was late, not the person.
    """
    stream: wave.Wave_write | None = None
    for start, pcm in pieces:
        if stream is None:
            path.parent.mkdir(parents=True, exist_ok=True)
            stream = wave.open(str(path), "wb")  # noqa: SIM115
            stream.setparams((1, WIDTH, RATE, 0, "NONE", ""))
        gap = round(start * RATE) - stream.tell()
        if gap > JITTER * RATE:
            stream.writeframesraw(bytes(WIDTH * gap))
        stream.writeframesraw(pcm)
    if stream is not None:
        stream.close()
