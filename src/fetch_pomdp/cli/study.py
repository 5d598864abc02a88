"""The commands of a study: run it, go on with it, report it."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from fetch_pomdp.adapters.speech.spoken import SpokenWords
from fetch_pomdp.cli.curves import curves, price_lists
from fetch_pomdp.cli.options import Json, ModelFile, RobotName, Seed, as_json
from fetch_pomdp.cli.reproduce import compare, fit, stories
from fetch_pomdp.cli.terminal import Terminal, trials_bar
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.planners.catalogue import planner_named
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.files.models import with_model
from fetch_pomdp.study.analysis.cells import Cell, cells
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import checked
from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.design import Study
from fetch_pomdp.study.experiment import run
from fetch_pomdp.study.record import NAME, read_trials
from fetch_pomdp.study.report import write_report
from fetch_pomdp.study.table import read_table, write_table

FOLDER, REPORT = Path("study"), "report"

app = typer.Typer(rich_markup_mode=None)
app.command()(fit)
app.command()(compare)
app.command()(stories)
app.command()(curves)
app.command("prices")(price_lists)


@app.callback(invoke_without_command=True)
def study(
    context: typer.Context,
    config: Annotated[
        Path | None, typer.Option(metavar="F.toml", help="The study (docs/study.md).  [default: the paper's]")
    ] = None,
    people: Annotated[int | None, typer.Option(min=1, help="How many people take part.  [default: 16]")] = None,
    seed: Seed = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder of the trials: a new one, or one to go on with.")
    ] = FOLDER,
    model: ModelFile = None,
    robot: RobotName = None,
    reader: Annotated[
        str | None,
        typer.Option(metavar="words|table", help="What reads what people say (docs/reading.md).  [default: words]"),
    ] = None,
    logs: Annotated[bool, typer.Option("--logs", help="Keep every interaction, event by event, in DIR/logs.")] = False,
    real_speech: Annotated[
        bool, typer.Option("--real-speech", help="Say every word with espeak-ng and hear it with PocketSphinx.")
    ] = False,
    workers: Annotated[int, typer.Option(min=0, help="Processes; 0: one a core.")] = 0,
    backend: Annotated[str, typer.Option(help="What runs trials side by side: loky, threading, dask or ray.")] = "loky",
    address: Annotated[str | None, typer.Option(help="Address of a running Dask or Ray cluster.")] = None,
    json_lines: Json = False,
) -> None:
    """Run a study with simulated people, and print its times and accuracies.

    Stopped at any moment, it goes on where it was when the same command is given again. The same seed gives the same
    trials, whoever does the work. fetch-pomdp study report DIR writes pictures and tests.
    """
    if context.invoked_subcommand is not None:
        return
    given = {"people": people, "seed": seed, "reader": reader, "logs": logs or None, "real_speech": real_speech or None}
    chosen = _chosen(config, model, given)
    if robot is not None:
        from fetch_pomdp.cli.robot import with_robot

        chosen = with_robot(chosen, robot)
    crew = Crew(workers=workers, backend=backend, address=address)  # type: ignore[arg-type]
    _play(chosen, out, crew)
    for ending in (".csv", ".parquet"):
        write_table(read_trials(out / NAME), (out / NAME).with_suffix(ending))
    found = cells(checked(read_table(out)), Plan())
    if as_json(json_lines):
        for cell in found:
            print(json.dumps(dataclasses.asdict(cell)))
    else:
        _show(found)


@app.command()
def report(
    trials: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a study, or a table of trials: .jsonl, .csv or .parquet.")
    ],
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Where the report goes.  [default: report, beside the trials]")
    ] = None,
    system: Annotated[
        str, typer.Option(metavar="NAME", help="The paradigm that is compared with never and always.")
    ] = Plan().system,
) -> None:
    """Write what a study found: pictures, tests and the answers to the paper's hypotheses, as one HTML page."""
    beside = trials if trials.is_dir() else trials.parent
    print(f"wrote {write_report(read_table(trials), out or beside / REPORT, Plan(system=system))}")


def _chosen(config: Path | None, model: Path | None, given: Mapping[str, object]) -> Study:
    """Return the study of a file, or the paper's, with what was given beside it."""
    planned = load_study(config) if config else Study()
    changes = {name: value for name, value in given.items() if value is not None}
    if model is not None:
        changes["layouts"] = {name: with_model(scene, model) for name, scene in planned.layouts.items()}
    return dataclasses.replace(planned, **changes)  # type: ignore[arg-type]


def _play(chosen: Study, out: Path, crew: Crew) -> None:
    for name, paradigm in chosen.paradigms.items():
        first = next(iter(chosen.layouts))
        prepare(planner_named(paradigm.planner, **paradigm.parameters), Problem(chosen.scene(first, name)))
    speech = SpokenWords if chosen.real_speech else None
    with trials_bar(chosen.size) as told:
        run(chosen, out, crew, speech=speech, told=told)


def _show(found: tuple[Cell, ...]) -> None:
    table = Table(
        "layout", "paradigm", "time (s)", "right", "questions", "waits", "people", "trials",
        title="Means over people, 95 % intervals",
    )  # fmt: skip
    for cell in found:
        table.add_row(
            cell.layout,
            cell.paradigm,
            f"{cell.time:.2f}{_interval(cell.time_low, cell.time_high, '.2f')}",
            f"{cell.accuracy:.1%}{_interval(cell.accuracy_low, cell.accuracy_high, '.1%')}",
            f"{cell.questions:.2f}",
            f"{cell.waits:.2f}",
            str(cell.people),
            str(cell.trials),
        )
    Terminal().print(table)


def _interval(low: float | None, high: float | None, form: str) -> str:
    return "" if low is None or high is None else f" ({low:{form}} to {high:{form}})"
