"""The commands explain and fit-reader: what the robot makes of what is said about a table, and how it learns to."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.markup import escape
from rich.progress import track
from rich.table import Table

from fetch_pomdp.adapters.reading.choice import reader_named
from fetch_pomdp.adapters.reading.endpoint import EndpointReader
from fetch_pomdp.cli.options import Json, ReaderName, SceneName, as_json, counted
from fetch_pomdp.cli.show import MOST_BARS
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.calibration import Calibration
from fetch_pomdp.core.language.reading.catalogue import DEFAULT
from fetch_pomdp.core.language.reading.reader import Context, Heard, Reader, TableReader
from fetch_pomdp.core.language.reading.telling import told
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EndpointError, InputError, StudyError
from fetch_pomdp.study.requests.calibration import Record, fitted, log_loss, write_calibration
from fetch_pomdp.study.requests.corpus import Corpus, load_corpus
from fetch_pomdp.study.requests.fit import Learner, write_weights

Says = Annotated[list[str], typer.Option("--says", metavar="TEXT", help="What is said; repeatable, in order.")]
OURS = Calibration(own=1.0 - 1e-9, even=1e-9)  # our own reader alone
WeightsFile = Annotated[
    Path | None,
    typer.Option("--weights", metavar="F.toml", help="What fit-reader learnt for that reader, in place of ours."),
]


def explain(
    scene: SceneName,
    says: Says,
    reader: ReaderName = DEFAULT,
    weights: WeightsFile = None,
    json_lines: Json = False,
) -> None:
    """Print what is understood of a request: its readings, and how likely it means each item.

    With --json, or into a file or pipe, one JSON object for each --says.
    """
    table, reads, context = Scene.load(scene), _reader(reader, weights), Context()
    for text in says:
        heard = reads.read(words_of(text), table, context)
        context = heard.context
        chances = np.exp(heard.log_likelihood)
        if as_json(json_lines):
            print(json.dumps(_as_json(heard, table, chances), ensure_ascii=False))
        else:
            _show(heard, table, chances)


def fit_reader(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A corpus: tables.json and requests.csv.")],
    out: Annotated[Path, typer.Option(metavar="F.toml", help="Where the weights go.")],
    reader: ReaderName = DEFAULT,
    source: Annotated[str, typer.Option(help="Where the requests come from, for the file.")] = "a corpus of requests",
    steps: Annotated[int, typer.Option(min=1, help="Steps of the fit.")] = 14,
) -> None:
    """Learn the reader's weights from requests whose target is known (docs/reading.md); some minutes.

    Of a language model it is learnt how far to believe it. Needs pip install "fetch-pomdp[study]". How good the weights
    are on tables that they were not learnt from: benchmarks/requests.py.
    """
    corpus, found = load_corpus(folder), _reader(reader, None)
    if isinstance(found, EndpointReader):
        _calibrate(found, corpus, out, source)
    elif isinstance(found, TableReader):
        theta = Learner(corpus, found.language).fit(list(corpus.scenes), steps=steps)
        write_weights(out, theta, corpus, source)


def _reader(name: str, weights: Path | None) -> Reader:
    found = reader_named(name, weights=weights)
    if found is None:
        raise InputError(
            f"found {name!r}, expected a reader of more than single words: {DEFAULT} or another", field="reader"
        )
    return found


def _calibrate(reader: EndpointReader, corpus: Corpus, out: Path, source: str) -> None:
    """Fit how far to believe a model to the requests that it answers, write it and print what it is worth."""
    console, records, failed = Terminal(stderr=True), list[Record](), list[str]()
    for each in track(corpus.requests, "requests", console=console):
        words, scene = words_of(each.text), corpus.scenes[each.table]
        own = np.exp(reader.own.read(words, scene, Context()).log_likelihood)
        try:
            records.append(Record(reader.asked(words, scene, Context()).chances, own, each.target))
        except EndpointError as error:
            failed.append(f"{reader.model} {error}")
    if failed:
        console.print(escape(f"{len(failed)} of {counted(len(corpus.requests), 'request')} not read: {failed[-1]}"))
    if not records:
        raise StudyError(f"found no request that {reader.model} read, expected one or more", field="reader")
    found = fitted(records)
    write_calibration(out, found, count=len(records), source=source)
    for name, calibration in (("as it is", Calibration()), ("calibrated", found), ("ours", OURS)):
        Terminal().print(f"log loss {name}: {log_loss(records, calibration):.3f} nats")


def _as_json(heard: Heard, scene: Scene, chances: Vector) -> dict[str, Any]:
    return {
        "understood": told(heard),
        "readings": [{"meaning": str(each.meaning), "chance": each.chance} for each in heard.readings],
        "unknown": list(heard.unknown),
        "lost": heard.lost,
        "note": heard.note,
        "items": {item.id: float(chance) for item, chance in zip(scene.items, chances, strict=True)},
    }


def _show(heard: Heard, scene: Scene, chances: Vector) -> None:
    console = Terminal()
    console.print(escape(told(heard)))
    for each in heard.readings[:3]:
        console.print(f"  {each.chance:4.0%}  {escape(str(each.meaning))}")
    table = Table("item", box=None, padding=(0, 2, 0, 0))
    table.add_column("chance", justify="right")
    for index in np.argsort(-chances, kind="stable")[:MOST_BARS]:
        table.add_row(escape(scene.items[index].id), f"{chances[index]:.1%}")
    console.print(table)
