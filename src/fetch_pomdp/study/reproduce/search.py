"""A search for people and a clock that give the paper's cells."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.checks import within
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.errors import StudyError
from fetch_pomdp.extras import load
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.reproduce.cells import cell, loss, reduced, residuals, simulate
from fetch_pomdp.study.reproduce.free import OVERHEAD, Free, changed
from fetch_pomdp.study.reproduce.targets import Targets

COARSE, FINE = 32, 96  # people a layout, each with 18 trials in every cell
STEP = 0.06  # for derivatives, in coordinates: what it changes must be more than what is left to chance
GAIN = 1e-3  # of the loss, below which a step is the last
Told = Callable[[int, float], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """What a search found."""

    values: Mapping[str, float]  # of the free parameters
    loss: float  # at these, with FINE people a layout
    evaluations: int


@dataclass(frozen=True, slots=True)
class Objective:
    """How far the fitted cells are from their targets, at a point of coordinates from 1 to 2.

    Everybody met is drawn with one seed, so that points differ by their parameters. Coordinates are those of Free and 1
    more: a relative step of SciPy's is then about as long anywhere. `overhead` is no coordinate but solved for.
    """

    targets: Targets
    seed: int
    crew: Crew

    @property
    def moving(self) -> tuple[Free, ...]:
        """Return the free parameters that have a coordinate."""
        return tuple(free for free in self.targets.free if free.name != OVERHEAD)

    @property
    def start(self) -> Vector:
        """Return the point that a search begins at."""
        return np.array([1.0 + free.beginning for free in self.moving])

    def at(self, point: Vector, people: int) -> tuple[Vector, dict[str, float]]:
        """Return the distances in standard errors and the values of the free parameters; people: a layout."""
        targets = self.targets
        fitted = [target for target in targets.cells if target.fitted]
        values = {free.name: free.value(float(x) - 1.0) for free, x in zip(self.moving, point, strict=True)}
        solved = [free for free in targets.free if free.name == OVERHEAD]
        study = changed(targets.study, {**values, **{free.name: 0.0 for free in solved}})
        trials = simulate(dataclasses.replace(reduced(study, fitted, people), seed=self.seed), self.crew)
        cells = [cell(trials, target) for target in fitted]
        for free in solved:
            missing = np.mean([target.time - ours.time for ours, target in zip(cells, fitted, strict=True)])
            values[free.name] = float(np.clip(missing, free.low, free.high))
            cells = [dataclasses.replace(ours, time=ours.time + values[free.name]) for ours in cells]
        return residuals(cells, fitted, targets.time_error, targets.trials), values


def fit(
    targets: Targets, budget: int, seed: int, crew: Crew | None = None, told: Told = lambda _count, _loss: None
) -> Fit:
    """Search for the free parameters; the same seed and budget give the same fit.

    A quarter of the evaluations goes to the start and a Latin hypercube over the ranges, half to least squares from
    the best of them, a quarter to least squares with three times as many people.

    The fit is the best point that so many people met, which may be one of a derivative: the loss is not smooth.

    Choice: Gauss-Newton's derivatives (SciPy's trust region) rather than a simplex or an evolution: there are few
    parameters, each evaluation is thousands of interactions, and the loss is a sum of squares.

    budget: evaluations, about; derivatives included. Raises StudyError for one too small or no parameter to move.
    """
    objective = Objective(targets, seed, crew or Crew())
    size = len(objective.moving)
    if size == 0:
        raise StudyError("found none besides the overhead, expected one or more", field="free")
    within(budget, 8, 1e6, "budget", "a whole number from 8", StudyError)
    counted = _Counted(objective, told)
    explored = load("scipy.stats.qmc", "study").LatinHypercube(size, rng=seed).random(max(1, budget // 4 - 1))
    points = [objective.start, *(1.0 + explored)]
    best = min(points, key=lambda point: loss(counted.residuals(point, COARSE)))
    for people, share in ((COARSE, budget // 2), (FINE, budget // 4)):
        best = _descended(counted, best, people, max(1, share // (size + 1)))
    return counted.fit()


class _Counted:
    """The objective, telling how often it was asked and how well it went, and keeping the best with many people."""

    def __init__(self, objective: Objective, told: Told) -> None:
        self._objective, self._told = objective, told
        self._count, self._best = 0, (float("inf"), dict[str, float]())

    def residuals(self, point: Vector, people: int) -> Vector:
        off, values = self._objective.at(point, people)
        self._count += 1
        if people == FINE and loss(off) < self._best[0]:
            self._best = loss(off), values
        self._told(self._count, loss(off))
        return off

    def fit(self) -> Fit:
        least, values = self._best
        return Fit(values=values, loss=least, evaluations=self._count)


def _descended(counted: _Counted, start: Vector, people: int, steps: int) -> Vector:
    """Return where least squares get in so many steps, each with derivatives."""
    found = load("scipy.optimize", "study").least_squares(
        counted.residuals, np.clip(start, 1.0 + 1e-6, 2.0 - 1e-6), args=(people,), bounds=(1.0, 2.0),
        diff_step=STEP, ftol=GAIN, max_nfev=steps + 1,
    )  # fmt: skip
    return np.asarray(found.x)
