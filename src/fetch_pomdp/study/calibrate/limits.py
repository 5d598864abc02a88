"""Which parameter keeps a robot from being right more often."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

from fetch_pomdp.core.planners.base import Planner
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.simulation import Summary, simulate

# As good as a parameter may get: people who point exactly, always, who speak at every step, and so on.
IDEAL: Mapping[str, float] = {"sigma": 0.01, "p_g": 0.99, "p_l": 0.999, "alpha": 0.001, "p_truth": 1.0}


@dataclass(frozen=True, slots=True)
class Limit:
    """What a robot would gain if one parameter were ideal, and it knew."""

    name: str
    value: float  # as fitted
    ideal: float
    accuracy: float  # more of it: a share of the interactions
    mean_return: float  # more of it, in points
    steps: float  # fewer of them are below 0


def limits(
    scene: Scene, changes: Mapping[str, float], planner: Planner, *, episodes: int, seed: int
) -> tuple[Summary, tuple[Limit, ...]]:
    """Return how a robot does with people of the fitted model, and the gain from each ideal parameter.

    People are drawn from the model itself, the same at each parameter; the largest gain of accuracy comes first,
    and of equal ones the largest gain of return.
    """
    model = scene.model.with_changes(changes)
    base = _played(scene, dataclasses.asdict(model), planner, (episodes, seed))
    found = []
    for name, ideal in IDEAL.items():
        better = _played(scene, {**dataclasses.asdict(model), name: ideal}, planner, (episodes, seed))
        found.append(
            Limit(
                name,
                getattr(model, name),
                ideal,
                better.accuracy - base.accuracy,
                better.mean_return - base.mean_return,
                better.mean_steps - base.mean_steps,
            )
        )
    return base, tuple(sorted(found, key=lambda limit: (-limit.accuracy, -limit.mean_return)))


def _played(scene: Scene, changes: Mapping[str, object], planner: Planner, people: tuple[int, int]) -> Summary:
    problem = Problem(dataclasses.replace(scene, model=scene.model.with_changes(changes)))
    return simulate(problem, planner, *people)
