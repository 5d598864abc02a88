"""The command robocup: planners scored by RoboCup@Home's "Hand Me That"."""

from __future__ import annotations

import dataclasses
import json
from typing import Annotated, Any

import typer
from rich.table import Table

from fetch_pomdp.cli.options import Json, Seed, as_json
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.planners.catalogue import PLANNERS, planner_named
from fetch_pomdp.study.robocup.contest import Contest, Standing
from fetch_pomdp.study.robocup.operators import Guests

SCORED = ("fitted", "sparse", "paper-never", "paper-always")

Planners = Annotated[
    list[str] | None,
    typer.Option("--planner", help=f"Repeatable: {', '.join(PLANNERS)}.  [default: {', '.join(SCORED)}]"),
]
Games = Annotated[int, typer.Option(min=2, help="Games to play for each planner.")]
Unknown = Annotated[float, typer.Option(help='Chance that the operator answers a question with "I don\'t know".')]
Bias = Annotated[float, typer.Option(help="How far an operator's arm is off throughout a group (rad, spread).")]


def robocup(
    planner: Planners = None,
    games: Games = 200,
    unknown: Unknown = 0.1,
    bias: Bias = 0.05,
    seed: Seed = None,
    json_lines: Json = False,
) -> None:
    """Score planners by the rules of RoboCup@Home's "Hand Me That", against simulated operators (docs/robocup.md).

    Five groups of two to five objects that the operator points at and cannot name; the best score is 2,500.
    """
    contest = Contest(games=games, seed=seed or 0, operators=Guests(unknown, bias))
    chosen = {name: planner_named(name) for name in planner or SCORED}
    for one in chosen.values():
        prepare(one, next(contest.courses())[0])
    standings = contest.standings(chosen)
    if as_json(json_lines):
        print(json.dumps(to_json(contest, standings)))
        return
    show(contest, standings)


def to_json(contest: Contest, standings: list[Standing]) -> dict[str, Any]:
    """Return the result as an object for programs."""
    planners = [dataclasses.asdict(one) for one in standings]
    return {"games": contest.games, "seed": contest.seed, "rules": dataclasses.asdict(contest.rules),
            "planners": planners}  # fmt: skip


def show(contest: Contest, standings: list[Standing]) -> None:
    """Print the result as a table; errors are standard errors."""
    most = contest.rules.groups * contest.rules.right
    title = f"Hand Me That, {contest.games:,} games of at most {most:,} points"
    table = Table("planner", "score", "right", "at first guess", "questions a group", "waits a group", title=title)
    for one in standings:
        table.add_row(
            one.planner,
            f"{one.mean_score:.0f} ± {one.standard_error:.0f}",
            f"{one.right:.1%}",
            f"{one.first:.1%}",
            f"{one.questions:.2f}",
            f"{one.waits:.1f}",
        )
    Terminal().print(table)
