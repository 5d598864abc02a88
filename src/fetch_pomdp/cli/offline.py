"""Commands on recorded and simulated interactions: filter, decide, simulate."""

from __future__ import annotations

import dataclasses
import json
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from fetch_pomdp.cli.explain import show_decision
from fetch_pomdp.cli.options import (
    Budget,
    Depth,
    Json,
    ModelFile,
    PlannerName,
    SceneName,
    Seed,
    Width,
    as_json,
    built_planner,
    loaded,
)
from fetch_pomdp.cli.show import show_event
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.core.events import Observed
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import simulate as simulated
from fetch_pomdp.errors import EventError
from fetch_pomdp.files.decisions import belief_to_json, decision_to_json
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.models import with_model
from fetch_pomdp.files.recordings import Recording, read_recording

Events = Annotated[Path, typer.Argument(metavar="EVENTS.jsonl", help="A recorded interaction, one JSON object a line.")]


def filter_events(events: Events, model: ModelFile = None, json_lines: Json = False) -> None:
    """Print the belief after every observation of a recorded interaction.

    On a terminal as bars; with --json, or into a file or pipe, one JSON object a line:
    {"belief": {ID: probability, ...}, "asked": ID or null}.
    """
    recording = _read(events)
    agent = _under(recording.header, model).agent()
    console = Terminal()
    for event in recording.replay(agent):
        if not as_json(json_lines):
            show_event(event, agent, console)
        elif isinstance(event, Observed):
            print(json.dumps(belief_to_json(agent), ensure_ascii=False))


def _read(path: Path) -> Recording:
    """Return a recorded interaction; say on standard error what was left out of it."""
    recording = read_recording(path)
    if recording.torn is not None:
        print(f"fetch-pomdp: {path}:{recording.torn}: this last line is incomplete and was left out", file=sys.stderr)
    return recording


def _under(header: Header, model: Path | None) -> Header:
    """Return a header with the parameters of a model file, if there is one."""
    return header if model is None else dataclasses.replace(header, scene=with_model(header.scene, model))


def decide(
    events: Events,
    planner: PlannerName = None,
    depth: Depth = None,
    width: Width = None,
    budget: Budget = None,
    seed: Seed = None,
    model: ModelFile = None,
    explain: Annotated[bool, typer.Option("--explain", help="On a terminal: the numbers behind it too.")] = False,
    json_lines: Json = False,
) -> None:
    """Print what the robot would do at the end of a recorded interaction, and why.

    On a terminal a sentence; with --json, or into a file or pipe, an object with the value of every action too.
    Planner and seed are those of the recording unless given, so the decisions of a log come out again.
    """
    recording = _read(events)
    if recording.over:
        raise EventError("found an interaction that is over, expected one that is still going on", source=str(events))
    header = _under(recording.header, model)
    agent = header.agent(planner=planner, seed=seed, depth=depth, width=width, budget_ms=budget)
    for _ in recording.replay(agent):
        pass
    prepare(agent.planner, agent.problem)
    decision = agent.decide()
    if as_json(json_lines):
        print(json.dumps(decision_to_json(decision, agent.scene), ensure_ascii=False))
        return
    show_decision(decision, agent, Terminal(), explained=explain)


def simulate(
    scene: SceneName,
    planner: PlannerName = None,
    depth: Depth = None,
    width: Width = None,
    episodes: Annotated[int, typer.Option(min=1, help="How many interactions to play.")] = 10_000,
    seed: Seed = None,
    model: ModelFile = None,
    json_lines: Json = False,
) -> None:
    """Play interactions with a person sampled from the model itself, and print how well the planner did.

    The person says one word of the scene a step, points now and then, and answers questions. Each item is the desired
    one equally often; the same seed gives the same people to every planner.
    """
    problem = Problem(loaded(scene, model))
    chosen = built_planner(planner, depth=depth, width=width)
    prepare(chosen, problem)
    summary = dataclasses.asdict(simulated(problem, chosen, episodes, seed or 0))
    if as_json(json_lines):
        print(json.dumps(summary))
        return
    table = Table("figure", "value", title=f"{scene}, {chosen}")
    for name, value in summary.items():
        table.add_row(name.replace("_", " "), f"{value:.4g}" if isinstance(value, float) else f"{value:,}")
    Terminal().print(table)
