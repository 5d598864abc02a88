"""The command calibrate: the model's parameters from recorded interactions."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from fetch_pomdp.cli.options import Json, Seed, as_json, counted
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.planners.catalogue import DEFAULT, planner_named
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import Summary
from fetch_pomdp.core.turns import Turns
from fetch_pomdp.files.models import write_model
from fetch_pomdp.files.recordings import read_recording
from fetch_pomdp.study.calibrate import calibration
from fetch_pomdp.study.calibrate.calibration import Calibration
from fetch_pomdp.study.calibrate.estimate import Estimate
from fetch_pomdp.study.calibrate.limits import Limit, limits
from fetch_pomdp.study.calibrate.steps import Interaction, interaction_of
from fetch_pomdp.study.calibrate.turns import tally

Limits = tuple[Summary, tuple[Limit, ...]]
MOST_CONFUSED = 10  # words said, in the table

Logs = Annotated[
    list[Path], typer.Argument(metavar="LOG...", help="Recorded interactions with `target` (docs/events.md).")
]
Out = Annotated[Path | None, typer.Option(metavar="MODEL.toml", help="Write a new model file, for --model.")]
TurnsToo = Annotated[
    bool, typer.Option("--turns", help="Write also how people take turns: when they speak, point and answer.")
]
Episodes = Annotated[int, typer.Option(min=0, help="Simulated interactions for what limits accuracy; 0 leaves it out.")]


def calibrate(
    logs: Logs,
    out: Out = None,
    episodes: Episodes = 20_000,
    turns: TurnsToo = False,
    seed: Seed = None,
    json_lines: Json = False,
) -> None:
    """Estimate the model's parameters from interactions whose desired items are known, with 90 % intervals.

    For all people together and for each, if the logs say who it was. See docs/calibrate.md.
    """
    interactions = [_read(path) for path in logs]
    found = calibration.calibrate(interactions)
    people = calibration.by_person(interactions) if found.people > 1 else {}
    limiting = _limits(interactions, found, episodes, seed or 0) if episodes else {}
    if out is not None:
        _write(out, found, interactions if turns else [])
    if as_json(json_lines):
        print(json.dumps(_to_json(found, people, limiting), ensure_ascii=False))
        return
    _show(found, people, limiting, Terminal())


def _read(path: Path) -> Interaction:
    recording = read_recording(path)
    return interaction_of(recording.header, recording.events, str(path))


def _limits(interactions: list[Interaction], found: Calibration, episodes: int, seed: int) -> dict[str, Limits]:
    """Return what limits accuracy on each table of the logs; the built-in ones are named, others numbered."""
    scenes = list(dict.fromkeys(one.scene for one in interactions))
    planner = planner_named(DEFAULT)
    return {
        _named(scene, number): limits(scene, found.changes(), planner, episodes=episodes, seed=seed)
        for number, scene in enumerate(scenes, start=1)
    }


def _named(scene: Scene, number: int) -> str:
    built_in = (name for name in LAYOUTS if Scene.load(name) == scene)
    return next(built_in, f"table {number}")


def _write(out: Path, found: Calibration, of_turns: list[Interaction]) -> None:
    comments = [
        f"Fitted to {_size(found)}; 90 % intervals (docs/calibrate.md).",
        *(
            f"{one.name} {one.value:.4f} rad, {one.low:.4f} to {one.high:.4f}: the model has none."
            for one in found.bias
        ),
        *(f"{name} has no bound on one side; to find one would take {what}." for name, what in found.unknown().items()),
    ]
    told = {one.name: one for one in found.estimates if one.known != "none"}
    values = {name: (one.value, _range(one)) for name, one in told.items()}
    write_model(out, comments, values, _turns(of_turns) if of_turns else None)


def _turns(interactions: list[Interaction]) -> dict[str, tuple[object, str]]:
    """Return the chances of turn-taking, rounded, with the steps that each was counted in."""
    start = interactions[0].scene.model.turns or Turns()
    counted = tally(interactions, start)
    fields = dataclasses.asdict(counted.turns(start))
    fitted: dict[str, tuple[object, str]] = {}
    for name, value in fields.items():
        if name == "held":
            fitted[name] = list(value), "times sigma, as before"
        elif isinstance(value, tuple):
            fitted[name] = [min(float(f"{chance:.3g}"), 0.999) for chance in value], counted.counted(name)
        else:
            fitted[name] = value, "steps, as before"
    return fitted


def _size(found: Calibration) -> str:
    people = "1 person" if found.people == 1 else f"{found.people:,} people"
    return f"{counted(found.interactions, 'interaction')} with {people}"


def _range(one: Estimate) -> str:
    return f"{one.low:.4g} to {one.high:.4g}{' ' + one.unit if one.unit else ''}"


def _to_json(found: Calibration, people: Mapping[str, Calibration], limiting: Mapping[str, Limits]) -> dict[str, Any]:
    return {
        **_one_to_json(found),
        "each": {name: _one_to_json(one) for name, one in people.items()},
        "limits": {
            scene: {"base": dataclasses.asdict(base), "ideal": [dataclasses.asdict(limit) for limit in ordered]}
            for scene, (base, ordered) in limiting.items()
        },
    }


def _one_to_json(found: Calibration) -> dict[str, Any]:
    return {
        "interactions": found.interactions,
        "people": found.people,
        "steps": found.steps,
        "estimates": {one.name: dataclasses.asdict(one) for one in found.estimates},
        "bias": {one.name: dataclasses.asdict(one) for one in found.bias},
        "unknown": found.unknown(),
        "confusion": found.confusion.rows(),
    }


def _show(
    found: Calibration, people: Mapping[str, Calibration], limiting: Mapping[str, Limits], console: Console
) -> None:
    console.print(f"{_size(found)}, {counted(found.steps, 'step')}")
    table = Table("parameter", "value", "90 % interval", "the logs bound it", box=None, padding=(0, 2, 0, 0))
    for one in found.estimates:
        bounded = {"both": "", "none": "not at all", "low": "from below only", "high": "from above only"}[one.known]
        table.add_row(one.name, f"{one.value:.4g} {one.unit}", f"{one.low:.4g} to {one.high:.4g}", bounded)
    for offset in found.bias:
        table.add_row(offset.name, f"{offset.value:.4g} rad", f"{offset.low:.4g} to {offset.high:.4g}", "")
    console.print(table)
    for name, what in found.unknown().items():
        console.print(f"{name} has no bound on one side; to find one would take {what}")
    if people:
        console.print(_each(people))
    for scene, (base, ordered) in limiting.items():
        best = ordered[0]
        console.print(f"\n{escape(scene)}: {base.accuracy:.1%} right in simulation; {best.name} limits it most")
        for limit in ordered:
            ideal = f"  {limit.name} {limit.ideal:g}: {100 * limit.accuracy:+.2f} points right"
            console.print(f"{ideal}, {limit.mean_return:+.2f} return, {limit.steps:+.2f} steps")
    _show_confusion(found, console)


def _each(people: Mapping[str, Calibration]) -> Table:
    first = next(iter(people.values()))
    table = Table("person", "interactions", *(one.name for one in first.estimates), box=None, padding=(0, 2, 0, 0))
    for name, one in people.items():
        table.add_row(
            escape(name or "unnamed"),
            str(one.interactions),
            *(f"{each.value:.3g} ({_range(each)})" for each in one.estimates),
        )
    return table


def _show_confusion(found: Calibration, console: Console) -> None:
    if not found.confusion.said:
        return
    console.print(
        f"\n{counted(found.confusion.said, 'word')} said, {found.confusion.word_error:.1%} word error; heard for each:"
    )
    for said, heard in list(found.confusion.rows().items())[:MOST_CONFUSED]:
        shares = ", ".join(f"{word or 'nothing'} {share:.0%}" for word, share in heard.items())
        console.print(f"  {escape(said or 'nothing')}: {escape(shares)}")
