"""A study written into a folder, as logs and tables that the analysis reads (docs/study-with-people.md).

Choice: `logs` has the trials that are over; a trial that its person has not ended is under `unfinished`, so that it is
not taken for one in which the robot never picked.
"""

from __future__ import annotations

import csv
import dataclasses
import json
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from fetch_pomdp.adapters.store.progress import Progress, known, progress
from fetch_pomdp.adapters.store.schema import EXTRA, schema
from fetch_pomdp.adapters.store.sound import write_wav
from fetch_pomdp.errors import StoreError
from fetch_pomdp.extras import load
from fetch_pomdp.files.recordings import Recording, read_recording

Scored: TypeAlias = Callable[[Iterable[tuple[str, Recording]]], Iterable[Any]]  # study.from_logs.trials_of
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


def export(connection: Any, folder: Path, study: str | None, scored: Scored) -> Exported:
    """Write a study into a new folder; the only study of the database if it is not said which.

    scored: makes rows of trials, dataclasses, from recordings with the names of their files. Raises StoreError if there
    is something at `folder` already, it cannot be written, or the study is not there.
    """
    name = known(connection, study)
    if folder.exists():
        raise StoreError("found something there already, expected a new folder", source=str(folder))
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}-") as beside:
            made = Path(beside) / "export"
            made.mkdir(PRIVATE)
            exported = _written(connection, made, name, scored)
            made.rename(folder)  # there wholly or not at all
    except OSError as cause:
        reason = cause.strerror or cause
        raise StoreError(f"cannot be written: {reason}, expected a folder for it", source=str(folder)) from None
    return exported


def _written(connection: Any, folder: Path, study: str, scored: Scored) -> Exported:
    people, rows = progress(connection, study), _trials(connection, study)
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
    trials = [dataclasses.asdict(trial) for trial in scored((str(log), read_recording(log)) for log in logs)]
    if trials:
        _table(folder / "trials.csv", tuple(trials[0]), (tuple(trial.values()) for trial in trials))
    return Exported(study, len(people), counts["logs"], counts["unfinished"], counts["practice"])


def _part(trial: Any) -> str:
    """Return the folder that a trial belongs to."""
    return "practice" if trial.part == "practice" else "unfinished" if trial.finished is None else "logs"


def _whose(study: str, *columns: Any) -> Any:
    """Return a query for what belongs to the people of a study."""
    sa, tables = load("sqlalchemy", EXTRA), schema()
    people, studies = tables.participants, tables.studies
    query = sa.select(people.c.person, *columns).join_from(people, studies, people.c.study == studies.c.id)
    return query.where(studies.c.name == study).order_by(people.c.person)


def _trials(connection: Any, study: str) -> Sequence[Any]:
    trials, people = schema().trials, schema().participants
    names = ("id", "part", "number", "header", "finished", "interruptions", "given_up")
    query = _whose(study, *(trials.c[name] for name in names)).join(trials, trials.c.participant == people.c.id)
    found: Sequence[Any] = connection.execute(query.order_by(trials.c.part, trials.c.number)).all()
    return found


def _lines(connection: Any, trial: Any) -> Iterator[str]:
    """Yield the lines of a trial's log, as they were written."""
    events = schema().events
    query = events.select().with_only_columns(events.c.line).where(events.c.trial == trial.id).order_by(events.c.number)
    yield trial.header
    yield from connection.execute(query).scalars()


def _sounds(connection: Any, trial: int) -> Iterator[tuple[float, bytes]]:
    sounds = schema().sounds
    for row in connection.execute(sounds.select().where(sounds.c.trial == trial).order_by(sounds.c.number)):
        yield row.start, row.pcm


def _person(one: Progress) -> tuple[object, ...]:
    return tuple(getattr(one, name) for name in PEOPLE)


def _answers(connection: Any, study: str) -> Iterator[tuple[object, ...]]:
    """Yield person, question and value; text as it is, anything else as JSON."""
    answers, people = schema().answers, schema().participants
    query = _whose(study, answers.c.question, answers.c.value).join(answers, answers.c.participant == people.c.id)
    for row in connection.execute(query.order_by(answers.c.question)):
        value = json.loads(row.value)
        yield row.person, row.question, value if isinstance(value, str) else row.value


def _table(path: Path, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)
