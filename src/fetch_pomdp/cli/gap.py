"""The command gap: how far planners are from the best return there could be."""

from __future__ import annotations

import dataclasses
import json
import math
import statistics
import time
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import typer
from numpy.random import Generator
from rich.table import Table

from fetch_pomdp.cli.options import Json, ModelFile, SceneName, Seed, as_json, loaded
from fetch_pomdp.cli.terminal import Terminal
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.bounding.bounds import Bound, upper_bound
from fetch_pomdp.core.planners.base import Decision, Planner, PreparedPlanner
from fetch_pomdp.core.planners.catalogue import DEFAULT, PLANNERS, planner_named
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.simulation import run_episode, simulate

COMPARED = (DEFAULT, "sparse", "never", "always")
TIMED_EPISODES = 30
NUDGE = 1e-4  # m, of the head of the scene that planners are compiled on: no solution is kept for the real one

Planners = Annotated[
    list[str] | None,
    typer.Option("--planner", help=f"Repeatable: {', '.join(PLANNERS)}.  [default: {', '.join(COMPARED)}]"),
]


@dataclass(frozen=True, slots=True)
class Standing:
    """How a planner did, and how far below the bound; returns in points, times in seconds.

    A mean return may come out above the bound by chance: the gap is then below 0, within its error.
    """

    planner: str
    mean_return: float
    standard_error: float
    accuracy: float
    gap: float
    gap_error: float  # standard error of the gap
    solving_seconds: float  # once a scene, before the first decision
    decision_seconds: float  # the median


@dataclass(frozen=True, slots=True)
class Stopwatch:
    """A planner that notes how long another takes to decide."""

    planner: Planner
    seconds: list[float]

    def decide(
        self, problem: Problem, belief: Belief, asked: int | None, *, rng: Generator, phase: int = 0
    ) -> Decision:
        """Decide like the other."""
        begin = time.perf_counter()
        decision = self.planner.decide(problem, belief, asked, rng=rng, phase=phase)
        self.seconds.append(time.perf_counter() - begin)
        return decision


def gap(
    scene: SceneName,
    planner: Planners = None,
    episodes: Annotated[int, typer.Option(min=2, help="Interactions to play for each planner.")] = 50_000,
    scenarios: Annotated[int, typer.Option(min=2, help="Scenarios of the upper bound.")] = 1_000,
    model: ModelFile = None,
    seed: Seed = None,
    json_lines: Json = False,
) -> None:
    """Print how far each planner's return is from the best there could be on simulated people (docs/gap.md).

    No policy can have a mean return above the upper bound, up to the bound's own sampling error.
    """
    chosen = {name: planner_named(name) for name in planner or COMPARED}
    problem = Problem(loaded(scene, model))
    times = {name: timed(one, problem) for name, one in chosen.items()}
    begin = time.perf_counter()
    bound = upper_bound(problem, scenarios, seed or 0)
    bound_seconds = time.perf_counter() - begin
    standings = [
        standing(name, one, problem, episodes=episodes, seed=seed or 0, bound=bound, times=times[name])
        for name, one in chosen.items()
    ]
    if as_json(json_lines):
        print(json.dumps(to_json(scene, episodes, bound, bound_seconds, standings), ensure_ascii=False))
        return
    show(scene, bound, bound_seconds, standings)


def timed(planner: Planner, problem: Problem) -> tuple[float, float]:
    """Return the seconds that solving takes, and the median of a decision's, once the planner is compiled."""
    scene = problem.scene
    x, y, z = scene.head
    nudged = Problem(dataclasses.replace(scene, head=(x, y, z + NUDGE)))
    planner.decide(nudged, Belief.uniform(problem.n_items), None, rng=np.random.default_rng(0))
    begin = time.perf_counter()
    if isinstance(planner, PreparedPlanner):
        planner.prepare(problem)
    solving = time.perf_counter() - begin
    watch = Stopwatch(planner, [])
    for number in range(TIMED_EPISODES):
        person, robot = np.random.default_rng((number, 0)), np.random.default_rng((number, 1))
        run_episode(problem, watch, number % problem.n_items, person, robot)
    return solving, statistics.median(watch.seconds)


def standing(
    name: str, planner: Planner, problem: Problem, *, episodes: int, seed: int, bound: Bound, times: tuple[float, float]
) -> Standing:
    """Return how a planner does on simulated people, and how far that is below the bound."""
    summary = simulate(problem, planner, episodes, seed)
    return Standing(
        planner=name,
        mean_return=summary.mean_return,
        standard_error=summary.standard_error,
        accuracy=summary.accuracy,
        gap=bound.mean - summary.mean_return,
        gap_error=math.hypot(bound.standard_error, summary.standard_error),
        solving_seconds=times[0],
        decision_seconds=times[1],
    )


def to_json(scene: str, episodes: int, bound: Bound, seconds: float, standings: list[Standing]) -> dict[str, Any]:
    """Return the result as an object for programs."""
    return {
        "scene": scene,
        "episodes": episodes,
        "bound": {**dataclasses.asdict(bound), "seconds": seconds},
        "planners": [dataclasses.asdict(one) for one in standings],
    }


def show(scene: str, bound: Bound, seconds: float, standings: list[Standing]) -> None:
    """Print the result as a table; errors are standard errors."""
    how = f"{bound.scenarios:,} scenarios" if bound.kind == "relaxation" else "closed form, loose"
    told = f"{bound.mean:.3f} ± {bound.standard_error:.3f} ({bound.kind}: {how}, {seconds:.1f} s)"
    table = Table("planner", "return", "right", "gap", "solving", "a decision", title=f"{scene}: upper bound {told}")
    for one in standings:
        table.add_row(
            one.planner,
            f"{one.mean_return:.3f} ± {one.standard_error:.3f}",
            f"{one.accuracy:.1%}",
            f"{one.gap:.3f} ± {one.gap_error:.3f}",
            f"{one.solving_seconds:.2f} s",
            f"{one.decision_seconds * 1e6:.0f} µs",
        )
    Terminal().print(table)
