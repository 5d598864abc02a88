"""Options that several commands share."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from fetch_pomdp.adapters.robot.mujoco.description import KNOWN
from fetch_pomdp.core.planners.base import Planner
from fetch_pomdp.core.planners.catalogue import DEFAULT, PLANNERS, planner_named
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.files.models import with_model

SceneName = Annotated[
    str, typer.Argument(metavar="SCENE", help="ambiguous, unambiguous, or the path of a TOML file (docs/scenes.md).")
]
PlannerName = Annotated[str | None, typer.Option(help=f"One of {', '.join(PLANNERS)}.  [default: {DEFAULT}]")]
Depth = Annotated[int | None, typer.Option(help="Actions the planner looks ahead, for planners that search.")]
Width = Annotated[int | None, typer.Option(help="Observations sampled at each node, for planners that search.")]
Budget = Annotated[
    float | None,
    typer.Option("--budget", metavar="MS", help="Milliseconds a decision may take, for planners that refine."),
]
ModelFile = Annotated[
    Path | None,
    typer.Option(
        "--model", metavar="MODEL.toml", help="Parameters in place of the scene's, as `calibrate` writes them."
    ),
]
Ears = Annotated[
    str | None,
    typer.Option(
        metavar="NAME", help="What hears: sphinx, whisper:MODEL or vosk:DIR (docs/speech.md).  [default: sphinx]"
    ),
]
ReaderName = Annotated[
    str,
    typer.Option(
        "--reader", metavar="NAME", help="What reads words: table, table:LANGUAGE, openai:MODEL@URL (docs/reading.md)."
    ),
]
Seed = Annotated[int | None, typer.Option(min=0, help="The same seed gives the same result.  [default: 0]")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, for programs.")]
RobotName = Annotated[
    str | None,
    typer.Option(
        "--robot", metavar="NAME", help=f"A body in MuJoCo: {', '.join(KNOWN)}, or a TOML file (docs/robot.md)."
    ),
]
Video = Annotated[
    Path | None, typer.Option("--video", metavar="OUT.mp4", help="With --robot: a film of its movements.")
]


def built_planner(name: str | None, **parameters: Any) -> Planner:
    """Return a planner by name, with the parameters that were given."""
    return planner_named(DEFAULT if name is None else name, **parameters)


def loaded(scene: str, model: Path | None, load: Callable[[str], Scene] = Scene.load) -> Scene:
    """Return a scene by name or path, with the parameters of a model file if there is one. load: loads the scene."""
    table = load(scene)
    return table if model is None else with_model(table, model)


def counted(number: int, thing: str) -> str:
    """Return a number of things in words: "1 step", "1,000 steps"."""
    return f"{number:,} {thing}" if number == 1 else f"{number:,} {thing}s"


def as_json(asked: bool) -> bool:
    """Whether to print for a program: when asked to, or when the output is no terminal."""
    return asked or not sys.stdout.isatty()
