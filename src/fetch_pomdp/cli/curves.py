"""The commands that vary a study: robustness curves, and price lists."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated, Any

import typer

from fetch_pomdp.cli.options import Seed
from fetch_pomdp.cli.terminal import Terminal, trials_bar
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.planners.catalogue import planner_named
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.writing import replaced
from fetch_pomdp.study import curve_plots, prices
from fetch_pomdp.study.analysis import words
from fetch_pomdp.study.analysis.hypotheses import Hypothesis
from fetch_pomdp.study.analysis.trials import Table
from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.curves import CURVES, points, trace, with_default
from fetch_pomdp.study.design import PAPER, Study
from fetch_pomdp.study.plots import svg

Config = Annotated[
    Path | None,
    typer.Option(metavar="F.toml", help="The study that is varied (docs/study.md).  [default: the paper's]"),
]
Workers = Annotated[int, typer.Option(min=0, help="Processes; 0: one a core.")]
Backend = Annotated[str, typer.Option(help="What runs trials side by side: loky, threading, dask or ray.")]
Address = Annotated[str | None, typer.Option(help="Address of a running Dask or Ray cluster.")]
DPI = 110


def curves(
    config: Config = None,
    curve: Annotated[list[str] | None, typer.Option(help=f"Repeatable: {', '.join(CURVES)}.  [default: all]")] = None,
    trials: Annotated[
        int, typer.Option(min=2, help="Trials of each paradigm at each point and layout, at least.")
    ] = 240,
    seed: Seed = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where trials, curves.csv and pictures go.")] = Path(
        "curves"
    ),
    workers: Workers = 0,
    backend: Backend = "loky",
    address: Address = None,
) -> None:
    """Draw time and accuracy against speech errors, pointing and the number of items, with right and wrong models.

    Stopped at any moment, it goes on where it was when the same command is given again (docs/robustness.md).
    """
    study = with_default(_study(config, seed))
    chosen = list(points(study, curve or list(CURVES), trials))
    crew = Crew(workers=workers, backend=backend, address=address)  # type: ignore[arg-type]
    _warm_up(study)
    with trials_bar(sum(point.study.size for point in chosen)) as told:
        table = trace(chosen, out, crew, told)
    _write(table, out / "curves.csv")
    for name in dict.fromkeys(table["curve"]):
        _draw(curve_plots.curve(table, CURVES[name]), out / name)


def price_lists(
    config: Config = None,
    trials: Annotated[
        int, typer.Option(min=2, help="Trials of each setting and layout in the search, at least.")
    ] = 480,
    fresh: Annotated[
        int, typer.Option(min=2, help="Trials of each of the two robots and layouts in the check, at least.")
    ] = 4800,
    seed: Seed = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where trials, tables and a picture go.")] = Path("prices"),
    workers: Workers = 0,
    backend: Backend = "loky",
    address: Address = None,
) -> None:
    """Look for prices at which our default is no slower and more accurate than the paper's search in every layout.

    If there are none, then where it is as accurate in every layout and more accurate in one. What is found is checked
    with fresh people (docs/robustness.md).
    """
    study = _study(config, seed)
    crew = Crew(workers=workers, backend=backend, address=address)  # type: ignore[arg-type]
    _warm_up(with_default(study))
    chosen = prices.candidates(study, trials)
    searched = _played(chosen, out, crew)
    shortlist = prices.ranked(searched, prices.somewhere)[: prices.SHORTLIST]
    again = _played([prices.second_round(study, shortlist, trials)], out, crew)
    found = prices.best(again, prices.everywhere) or prices.best(again, prices.somewhere)
    _write(prices.cell_table(searched), out / "prices.csv")
    _write(prices.cell_table(again), out / "second.csv")
    _draw(curve_plots.plane(prices.cell_table(searched), found, list(PAPER)), out / "prices")
    if found is None:
        claim = f"faster than {prices.SYSTEM} and as accurate in every layout, and more accurate in one"
        print(f"None of {len(chosen) - 1} settings was {claim}.")
        return
    print(f"Best of {len(chosen) - 1} settings: {found}")
    checked = _played([prices.final(study, found, fresh)], out, crew)
    _write(prices.cell_table(checked), out / "check.csv")
    _tell(prices.check(checked, found), found)


def _played(chosen: list[prices.Played], out: Path, crew: Crew) -> Table:
    with trials_bar(sum(one.study.size for one in chosen)) as told:
        return prices.play(chosen, out, crew, told)


def _study(config: Path | None, seed: int | None) -> Study:
    study = load_study(config) if config else Study()
    return study if seed is None else dataclasses.replace(study, seed=seed)


def _warm_up(study: Study) -> None:
    for name, paradigm in study.paradigms.items():
        first = next(iter(study.layouts))
        prepare(planner_named(paradigm.planner, **paradigm.parameters), Problem(study.scene(first, name)))


def _write(table: Table, path: Path) -> None:
    with replaced(path, StudyError) as file:
        file.write(table.to_csv(index=False, float_format="%.6g", lineterminator="\n").encode())
    print(f"wrote {path}")


def _draw(figure: Any, stem: Path) -> None:
    with replaced(stem.with_suffix(".svg"), StudyError) as file:
        file.write(svg(figure).encode())
    with replaced(stem.with_suffix(".png"), StudyError) as file:
        figure.savefig(file, dpi=DPI, format="png")
    print(f"wrote {stem}.svg and {stem}.png")


def _tell(checked: list[Hypothesis], name: str) -> None:
    console = Terminal(soft_wrap=True)
    for hypothesis in checked:
        for clause in hypothesis.clauses:
            console.print(f"{hypothesis.name}: {words.verdict(clause, prices.judge(name))}", markup=False)
    print(prices.conclusion(checked))
