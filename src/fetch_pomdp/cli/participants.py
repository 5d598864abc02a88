"""The commands participants list, export and forget: the people of a study over the page."""

from __future__ import annotations

import contextlib
import dataclasses
import itertools
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.box import SIMPLE
from rich.console import Console
from rich.table import Column, Table

from fetch_pomdp.cli.options import Json, as_json
from fetch_pomdp.errors import StoreError

if TYPE_CHECKING:
    from fetch_pomdp.user_study.store.participants import Progress
    from fetch_pomdp.user_study.store.store import Store

app = typer.Typer(
    help="People who take part in a study over the page: how far they are, their data.", no_args_is_help=True
)

DATABASE = "sqlite:///participants.db"
Database = Annotated[
    str, typer.Option(metavar="URL", help="sqlite:///FILE or postgresql://USER:PASSWORD@HOST/DATABASE.")
]
StudyName = Annotated[
    str | None, typer.Option("--study", metavar="NAME", help="Name of the study, if the database has several.")
]


@app.command("list")
def show(database: Database = DATABASE, study: StudyName = None, json_lines: Json = False) -> None:
    """Print how far everybody is: a table, or JSON Lines."""
    with _store(database) as store:
        people = store.progress(study)
    if not people:
        raise StoreError(f"nobody takes part{f' in {study!r}' if study else ''} yet", field="study")
    if as_json(json_lines):
        for one in people:
            print(json.dumps(dataclasses.asdict(one)))
        return
    for name, group in itertools.groupby(people, key=lambda one: one.study):
        Console(highlight=False).print(_table(name, group))


def _table(study: str, people: Iterable[Progress]) -> Table:
    plain = [Column(name, no_wrap=True) for name in ("person", "code", "stage", "last (UTC)")]
    counts = [Column(name, justify="right") for name in ("trials", "breaks", "given up")]
    table = Table(*plain, *counts, title=study, box=SIMPLE)
    for one in people:
        last, trials = one.last.replace("T", " ")[:16], f"{one.trials_done} of {one.of}"
        row = (one.person, one.code, one.stage, last, trials, one.interruptions, one.given_up)
        table.add_row(*map(str, row))
    return table


@app.command()
def export(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A new folder.")],
    database: Database = DATABASE,
    study: StudyName = None,
) -> None:
    """Write a study into a folder, which `fetch-pomdp study report DIR` reads: logs, tables, and sound where kept."""
    with _store(database) as store:
        done = store.export(folder, study)
    more = f", {done.unfinished} unfinished, {done.practice} of practice"
    print(f"wrote {folder}: {done.study}, {done.people} people, {done.trials} trials{more}")


@app.command()
def forget(
    code: Annotated[str, typer.Argument(metavar="CODE", help="The code that the person was shown, such as K7Q-2MP.")],
    database: Database = DATABASE,
) -> None:
    """Delete everything that is kept of one person, at once."""
    with _store(database) as store:
        gone = store.forget(code)
    rows = ", ".join(f"{number} {table}" for table, number in gone.rows.items() if table != "participants")
    print(f"deleted {gone.code}: {rows}")


@app.command("template")
def show_template() -> None:
    """Print a study with people to begin with, for serve --study (docs/study-with-people.md)."""
    from fetch_pomdp.user_study.config import template

    print(template(), end="")


@contextlib.contextmanager
def _store(url: str) -> Iterator[Store]:
    from fetch_pomdp.user_study.store.store import Store

    store = Store.existing(url)
    try:
        yield store
    finally:
        store.close()
