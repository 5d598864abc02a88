"""The trials of a study as a table: pandas, CSV, Parquet, JSON Lines."""

from __future__ import annotations

import csv
import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, BinaryIO

from fetch_pomdp import checks
from fetch_pomdp.documents import Document, bounded
from fetch_pomdp.errors import StudyError
from fetch_pomdp.extras import load
from fetch_pomdp.files.recordings import read_recording
from fetch_pomdp.files.writing import replaced
from fetch_pomdp.study.record import COLUMNS, LOGS, NAME, read_trials, trial_from_json
from fetch_pomdp.study.trial import Trial, trials_of

CHUNK = 50_000  # trials in memory at once while a table is written
TYPES = {
    "person": "int64",
    "layout": "str",
    "paradigm": "str",
    "desired": "str",
    "order": "int64",
    "time": "float64",  # s
    "correct": "bool",
    "picked": "str",  # missing if the robot never picked
    "questions": "int64",
    "waits": "int64",
}
ENDINGS = (".jsonl", ".csv", ".parquet")


def to_frame(trials: Iterable[Trial]) -> Any:
    """Return trials as a pandas DataFrame: a row a trial, the fields of Trial as columns (`TYPES`)."""
    pandas = load("pandas", "study")
    rows = [tuple(getattr(trial, name) for name in COLUMNS) for trial in trials]
    return pandas.DataFrame(rows, columns=list(COLUMNS)).astype(TYPES)


def from_frame(frame: Any) -> Iterator[Trial]:
    """Yield the trials of a DataFrame.

    Raises StudyError for a column that is missing or unknown, or a value of a wrong kind; its line counts rows from 1.
    """
    checks.known(map(str, frame.columns), COLUMNS, "column", StudyError)
    checks.required(dict.fromkeys(frame.columns), COLUMNS, StudyError)
    plain = frame[list(COLUMNS)].astype(object)
    rows = plain.where(plain.notna(), None).itertuples(index=False, name=None)
    for number, row in enumerate(rows):
        document = Document("", dict(zip(COLUMNS, row, strict=True)), lambda _, line=number + 1: line)  # type: ignore[misc]
        yield document.build(trial_from_json)


def read_table(path: str | Path) -> Any:
    """Return the table of a study's folder, its trials.jsonl, or a CSV or Parquet file, as a pandas DataFrame.

    A folder without trials.jsonl has logs, as the export of a study with people: their trials are the table. Raises
    StudyError for any other file, or one that cannot be read or has other columns; EventError for a broken log.
    """
    source = Path(path)
    logs = sorted((source / LOGS).glob("*.jsonl")) if source.is_dir() and not (source / NAME).exists() else []
    source = source / NAME if source.is_dir() else source
    pandas = load("pandas", "study")
    if logs:
        trials = trials_of((str(log), read_recording(log)) for log in logs)
        return pandas.concat([to_frame([]), *_frames(trials)], ignore_index=True)
    ending = _ending(source)
    try:
        if ending == ".parquet":
            trials = from_frame(pandas.read_parquet(source))
        else:
            trials = read_trials(source) if ending == ".jsonl" else _read_csv(source)
        return pandas.concat([to_frame([]), *_frames(trials)], ignore_index=True)
    except StudyError as error:
        raise error.located(str(source), error.line) from None
    except (OSError, ValueError) as cause:
        reason = getattr(cause, "strerror", None) or cause
        raise StudyError(f"cannot be read: {reason}, expected a table of trials", source=str(source)) from None


def _read_csv(source: Path) -> Iterator[Trial]:
    """Yield the trials of a CSV file; a value that is not of its column's kind stays text, and is refused as such."""
    with source.open(encoding="utf-8", newline="") as stream:
        reader = csv.DictReader(bounded(stream, str(source), StudyError), restkey="more")
        try:
            checks.required(dict.fromkeys(reader.fieldnames or ()), COLUMNS, StudyError)
            for row in reader:
                fields = {name: _parsed(text, TYPES.get(name, "str")) for name, text in row.items()}
                yield Document(str(source), fields, lambda _: reader.line_num).build(trial_from_json)
        except csv.Error as cause:
            raise StudyError(f"broken CSV: {cause}, expected a table of trials", line=reader.line_num + 1) from None


def _parsed(text: str | None, kind: str) -> object:
    if kind == "str":
        return text or None
    if kind == "bool":
        return {"True": True, "False": False}.get(text or "", text)
    try:
        return int(text or "") if kind == "int64" else float(text or "")
    except ValueError:
        return text


def write_table(trials: Iterable[Trial], path: str | Path) -> None:
    """Write trials to a CSV or Parquet file, some at a time, over whatever was there.

    Raises StudyError for an ending that is neither, or a file that cannot be written; then what was there is kept.
    """
    target = Path(path)
    write = {".csv": _write_csv, ".parquet": _write_parquet}.get(_ending(target))
    if write is None:
        raise StudyError(f"found {target.suffix!r}, expected .csv or .parquet", source=str(target))
    with replaced(target, StudyError) as file:
        write(_frames(trials), file)


def _frames(trials: Iterable[Trial]) -> Iterator[Any]:
    rest = iter(trials)
    while chunk := list(itertools.islice(rest, CHUNK)):
        yield to_frame(chunk)


def _write_csv(frames: Iterator[Any], file: BinaryIO) -> None:
    file.write(to_frame([]).to_csv(index=False, lineterminator="\n").encode())
    for frame in frames:
        file.write(frame.to_csv(index=False, header=False, lineterminator="\n").encode())


def _write_parquet(frames: Iterator[Any], file: BinaryIO) -> None:
    arrow, parquet = load("pyarrow", "study"), load("pyarrow.parquet", "study")
    schema = arrow.Schema.from_pandas(to_frame([]), preserve_index=False)
    with parquet.ParquetWriter(file, schema) as writer:
        for frame in frames:
            writer.write_table(arrow.Table.from_pandas(frame, schema=schema, preserve_index=False))


def _ending(path: Path) -> str:
    if path.suffix not in ENDINGS:
        raise StudyError(f"found {path.suffix!r}, expected one of {', '.join(ENDINGS)}", source=str(path))
    return path.suffix
