"""The commands that hold a study against the paper's twelve cells: fit, compare, stories."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from fetch_pomdp.cli.options import Seed
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.reproduce.compare import compare as compared
from fetch_pomdp.study.reproduce.files import write_fit
from fetch_pomdp.study.reproduce.search import fit as searched
from fetch_pomdp.study.reproduce.stories import tell
from fetch_pomdp.study.reproduce.targets import Targets
from fetch_pomdp.study.reproduce.words import markdown, outcome, stories_head

TargetsFile = Annotated[
    Path, typer.Option(metavar="F.toml", help="The cells, and the parameters that a search may change.")
]
Config = Annotated[Path, typer.Option(metavar="F.toml", help="The study, with its people and clock (docs/study.md).")]
Workers = Annotated[int, typer.Option(min=0, help="Processes; 0: one a core.")]
TARGETS, FITTED, SEED = Path("studies/paper.toml"), Path("studies/fitted.toml"), 2017


def fit(
    targets: TargetsFile = TARGETS,
    budget: Annotated[int, typer.Option(min=8, help="Evaluations, of about 2000 to 5000 interactions each.")] = 100,
    seed: Seed = None,
    out: Annotated[
        Path, typer.Option(metavar="F.toml", help="File to write the people to; the study is written beside it.")
    ] = Path("people.toml"),
    workers: Workers = 1,
) -> None:
    """Search for people and a clock that give the paper's cells; writes them, and a study of them (fitted.toml).

    The same seed and budget give the same people.
    """
    wanted = Targets.load(targets)
    columns = (TextColumn("loss {task.fields[least]:.1f}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=Terminal(stderr=True)) as bar:
        task = bar.add_task("fit", total=budget, least=float("inf"))

        def told(count: int, loss: float) -> None:
            bar.update(task, completed=count, least=min(loss, bar.tasks[0].fields["least"]))

        found = searched(wanted, budget, seed or 0, Crew(workers=workers), told)
    for name, value in found.values.items():
        print(f"{name} {value:.4g}")
    print(f"loss {found.loss:.1f} after {found.evaluations} evaluations")
    for path in write_fit(wanted, found, out):
        print(f"wrote {path}")


def compare(
    targets: TargetsFile = TARGETS,
    config: Config = FITTED,
    studies: Annotated[int, typer.Option(min=1, help="Studies of the paper's size, with fresh people.")] = 40,
    seed: Seed = None,
    workers: Workers = 1,
) -> None:
    """Print our cells beside the paper's, how often H1 and H2 hold, and what does not fit (docs/reproduction.md)."""
    chosen = SEED if seed is None else seed
    print(markdown(compared(Targets.load(targets), load_study(config), studies, chosen, Crew(workers=workers))))


def stories(
    targets: TargetsFile = TARGETS,
    config: Config = FITTED,
    people: Annotated[int, typer.Option(min=1, help="People a layout, each with 18 trials in every cell.")] = 24,
    seed: Seed = None,
    workers: Workers = 1,
) -> None:
    """Print how kinds of error change the cells, and which makes the always-asking robot as wrong as the paper's."""
    wanted = Targets.load(targets)
    print(stories_head(wanted))
    for told in tell(wanted, load_study(config), people, SEED if seed is None else seed, Crew(workers=workers)):
        print(outcome(told), flush=True)
