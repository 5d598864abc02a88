"""The commands explain and fit-reader: what the robot makes of what is said about a table, and how it learns to."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.markup import escape
from rich.table import Table

from fetch_pomdp.cli.options import Json, SceneName, as_json
from fetch_pomdp.cli.show import MOST_BARS
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.grammar import LANGUAGES
from fetch_pomdp.core.language.reading.reader import Context, Heard, TableReader
from fetch_pomdp.core.language.reading.telling import told
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.language.reading.weights import Weights, weights_of
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import InputError
from fetch_pomdp.study.requests.corpus import load_corpus
from fetch_pomdp.study.requests.fit import Learner, write_weights

Says = Annotated[list[str], typer.Option("--says", metavar="TEXT", help="What is said; repeatable, in order.")]
Language = Annotated[str, typer.Option(help=f"One of {', '.join(LANGUAGES)}.")]


WeightsFile = Annotated[
    Path | None,
    typer.Option("--weights", metavar="F.toml", help="Weights in place of ours, of fit-reader."),
]


def explain(
    scene: SceneName,
    says: Says,
    language: Language = "english",
    weights: WeightsFile = None,
    json_lines: Json = False,
) -> None:
    """Print what is understood of a request: its readings, and how likely it means each item.

    With --json, or into a file or pipe, one JSON object for each --says.
    """
    if language not in LANGUAGES:
        raise InputError(f"found {language!r}, expected one of {', '.join(LANGUAGES)}", field="language")
    learnt = None if weights is None else Weights.of(weights_of(weights))
    table, reader, context = Scene.load(scene), TableReader(language, learnt), Context()
    for text in says:
        heard = reader.read(words_of(text), table, context)
        context = heard.context
        chances = np.exp(heard.log_likelihood)
        if as_json(json_lines):
            print(json.dumps(_as_json(heard, table, chances), ensure_ascii=False))
        else:
            _show(heard, table, chances)


def fit_reader(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A corpus: tables.json and requests.csv.")],
    out: Annotated[Path, typer.Option(metavar="F.toml", help="Where the weights go.")],
    source: Annotated[str, typer.Option(help="Where the requests come from, for the file.")] = "a corpus of requests",
    steps: Annotated[int, typer.Option(min=1, help="Steps of the fit.")] = 14,
) -> None:
    """Learn the reader's weights from requests whose target is known (docs/reading.md); some minutes.

    Needs pip install "fetch-pomdp[study]". How good they are on tables that they were not learnt from:
    benchmarks/requests.py.
    """
    corpus = load_corpus(folder)
    theta = Learner(corpus).fit(list(corpus.scenes), steps=steps)
    write_weights(out, theta, corpus, source)


def _as_json(heard: Heard, scene: Scene, chances: Vector) -> dict[str, Any]:
    return {
        "understood": told(heard),
        "readings": [{"meaning": str(each.meaning), "chance": each.chance} for each in heard.readings],
        "unknown": list(heard.unknown),
        "lost": heard.lost,
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
