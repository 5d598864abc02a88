"""The command export: a scene for other people's planners."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fetch_pomdp.cli.options import ModelFile, SceneName, loaded
from fetch_pomdp.core.discrete import MOST_RINGS, Discrete
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.files.export import export
from fetch_pomdp.files.pomdp import DISCOUNT

Out = Annotated[Path, typer.Argument(metavar="OUT", help="A new file, OUT.pomdp (Cassandra's format) or OUT.pomdpx.")]
Discount = Annotated[float, typer.Option(help="Above 0 and at most 1; most solvers need less than 1.")]
Rings = Annotated[int, typer.Option(min=1, max=MOST_RINGS, help="Classes of how near to an item a gesture points.")]


def export_scene(
    scene: SceneName, out: Out, discount: Discount = DISCOUNT, rings: Rings = 1, model: ModelFile = None
) -> None:
    """Write a scene as a file for POMDP solvers, with its observations in finitely many classes.

    Nothing is random: the same scene gives the same file. See docs/planning-doors.md.
    """
    export(Discrete(Problem(loaded(scene, model)), rings), out, discount)
    print(f"wrote {out}")
