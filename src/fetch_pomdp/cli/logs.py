"""The commands log check, log replay, log schema and log trials."""

from __future__ import annotations

import dataclasses
import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from fetch_pomdp.cli.options import Json, counted
from fetch_pomdp.core.events import Acted
from fetch_pomdp.errors import InputError
from fetch_pomdp.files.checking import Relived, checked, differences, relived, schema
from fetch_pomdp.files.events import action_to_json
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.recordings import Recording, read_recording
from fetch_pomdp.study.trial import trials_of

app = typer.Typer(help="Check and replay recorded interactions.", no_args_is_help=True)

Logs = Annotated[list[Path], typer.Argument(metavar="LOG...", help="Recorded interactions (docs/events.md).")]
Log = Annotated[Path, typer.Argument(metavar="LOG", help="A recorded interaction (docs/events.md).")]
Replay = Annotated[bool, typer.Option("--replay", help="Decide every action again, too, and compare.")]


@app.command()
def check(logs: Logs, replay: Replay = False) -> None:
    """Print everything that is wrong with each file, a line for each fault; the exit code is 2 if there are any.

    A last line that a kill left half-written is named; readers leave it out, so it is no fault.
    """
    faulty = 0
    for path in logs:
        faults = _faults(path, replay=replay)
        faulty += bool(faults)
        for fault in faults:
            print(fault, file=sys.stderr)
    if faulty:
        print(f"{faulty} of {counted(len(logs), 'file')} had faults", file=sys.stderr)
        raise typer.Exit(2)


def _faults(path: Path, *, replay: bool) -> list[InputError]:
    try:
        found = checked(path)
        faults = list(found.faults)
        if replay and not faults and found.header is not None:
            faults += differences(Recording(found.header, found.events, found.documents, found.torn))
    except InputError as error:
        return [error]
    torn = "" if found.torn is None else f"; line {found.torn} is incomplete and was left out"
    if not faults:
        print(f"{path}: ok, {counted(len(found.events), 'event')}{torn}")
    elif torn:
        print(f"{path}{torn}")
    return faults


@app.command()
def replay(log: Log) -> None:
    """Live through an interaction again; print each event's belief and each action's decision, one JSON object a line.

    Exit code 2 if the recorded planner and seed decide another action anywhere.
    """
    recording = read_recording(log)
    same = True
    for step in relived(recording):
        fields = _step_to_json(step, recording.header)
        same = same and fields.get("same", True) is True
        print(json.dumps(fields, ensure_ascii=False))
    if not same:
        raise typer.Exit(2)


def _step_to_json(step: Relived, header: Header) -> dict[str, object]:
    ids = [item.id for item in header.scene.items]
    fields: dict[str, object] = {"line": step.line}
    if isinstance(step.event, Acted) and step.decided is not None:
        fields |= {
            "done": action_to_json(step.event.action, header.scene),
            "decided": action_to_json(step.decided, header.scene),
            "same": step.decided == step.event.action,
        }
    asked = None if step.asked is None else ids[step.asked]
    return {**fields, "belief": dict(zip(ids, step.belief.tolist(), strict=True)), "asked": asked}


@app.command("schema")
def print_schema() -> None:
    """Print the JSON Schema of a line."""
    print(json.dumps(schema(), indent=2, ensure_ascii=False))


@app.command()
def trials(logs: Logs, json_lines: Json = False) -> None:
    """Print how each recorded trial went, as rows for the analysis of a study: CSV, or JSON Lines with --json."""
    rows = [dataclasses.asdict(trial) for trial in trials_of((str(path), read_recording(path)) for path in logs)]
    if json_lines:
        for row in rows:
            print(json.dumps(row, ensure_ascii=False))
        return
    import csv

    writer = csv.DictWriter(sys.stdout, list(rows[0]) if rows else [], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
