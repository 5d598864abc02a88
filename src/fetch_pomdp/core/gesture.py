"""Pointing: Eq. 7, its likelihood beside its sampler.

Choice: the paper draws "an added noise term from the Gaussian" and says no more; our rays lie at an angle |N(0,
sigma)| off the item, at a uniform roll around it. A ray so drawn has density per solid angle proportional to exp(-t^2
/ 2 sigma^2) / sin t, which Eq. 7 is not: "eq7" judges rays by the paper's equation, "exact" by that density.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp import checks
from fetch_pomdp.checks import Point3
from fetch_pomdp.core.compiled import Vector, lean
from fetch_pomdp.core.problem import Problem, Tables
from fetch_pomdp.core.rays import angles_from, turned
from fetch_pomdp.core.turns import StepChances
from fetch_pomdp.errors import ObservationError

SMALLEST_ANGLE = 1e-3  # rad: the exact density is infinite on the axis, so angles are floored here


@dataclass(frozen=True, slots=True)
class Ray:
    """A pointing arm: from the head through the wrist, both in metres. Raises ObservationError for one without
    length.
    """

    head: Point3
    wrist: Point3

    def __post_init__(self) -> None:
        object.__setattr__(self, "head", checks.point(self.head, "head", ObservationError))
        object.__setattr__(self, "wrist", checks.point(self.wrist, "wrist", ObservationError))
        if math.dist(self.head, self.wrist) < 1e-9:
            raise ObservationError("found the position of the head, expected one away from it", field="wrist")


def angles(ray: Ray, problem: Problem) -> Vector:
    """Return the angle (rad) between the ray and the direction from its head to each item, (n_items,).

    An item in the middle of the head is at angle 0: it is where every ray goes.
    """
    return angles_from(np.array(ray.head), np.array(ray.wrist), problem.positions)


def is_pointing(ray: Ray, problem: Problem) -> bool:
    """Whether the ray is within the gesture threshold of an item (Section III-C-2)."""
    return bool(angles(ray, problem).min() <= problem.model.gesture_threshold)


def log_likelihood(ray: Ray | None, problem: Problem, width: float = 1.0) -> Vector:
    """Log density of a pointing ray, given each item as the desired one, log p(g | i_d) (Eq. 7).

    The density is per radian for "eq7" and per steradian for "exact". A ray beyond the threshold of every item is null,
    like None. width: what sigma is multiplied by. Returns (n_items,) in scene order.

    Choice: where p_g is 0 nobody points, so that any ray is an arm that moves for another reason: null.
    """
    if ray is not None and problem.model.p_g > 0.0:
        found = angles(ray, problem)
        if found.min() <= problem.model.gesture_threshold:
            return log_density(found, problem, width)
    return np.log(problem.tables.null_chance)


def log_density(found: Vector, problem: Problem, width: float = 1.0) -> Vector:
    """Log density of a ray that points, at each of some angles (rad) from the desired item (Eq. 7, upper case).

    Per radian for "eq7" and per steradian for "exact"; p_g above 0. found: (n,). width: what sigma is multiplied by.
    Returns (n,).
    """
    model, sigma = problem.model, problem.model.sigma * width
    normal = math.log(model.p_g) - 0.5 * (found / sigma) ** 2 - math.log(sigma * math.sqrt(math.tau))
    if model.gesture_likelihood == "eq7":
        return np.asarray(normal)
    # |N(0, sigma)| has twice the density of N(0, sigma), and the roll spreads it over a circle of 2 pi sin t.
    return np.asarray(normal + math.log(2.0 / math.tau) - np.log(np.sin(np.maximum(found, SMALLEST_ANGLE))))


def sample(desired: int, problem: Problem, chances: StepChances, rng: Generator) -> Ray | None:
    """Draw the gesture of one step: a ray of 1 m from the scene's head, or None (Section III-D-2).

    chances: of the step, see `Problem.step_chances`.
    """
    if rng.random() >= chances.points:
        return None
    angle, roll = abs(rng.normal(0.0, problem.model.sigma * chances.width)), rng.uniform(0.0, math.tau)
    x, y, z = turned(problem.tables.directions[desired], angle, roll)
    head = problem.scene.head
    ray = Ray(head, (head[0] + x, head[1] + y, head[2] + z))
    return ray if is_pointing(ray, problem) else None


@lean
def ray_likelihood(angle: float, sigma: float, tables: Tables) -> float:
    """Return the likelihood of a ray at `angle` from an item, up to a factor that all items share (Eq. 7); rad."""
    likelihood = math.exp(-0.5 * (angle / sigma) ** 2)
    if tables.exact:
        likelihood /= math.sin(max(angle, SMALLEST_ANGLE))
    return likelihood
