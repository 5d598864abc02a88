"""Where people point beside what they mean: the constant part of their pointing error.

The model has none (Eq. 7 has mean zero), so a model file cannot hold it; who moves the robot's eyes can correct it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core import gesture
from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.extras import load
from fetch_pomdp.study.calibrate.estimate import LEVEL
from fetch_pomdp.study.calibrate.steps import Interaction, steps_of

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class Offset:
    """The mean of one coordinate of the pointing error (rad), with its 90 % interval; of `rays` gestures."""

    name: str  # bias_right or bias_up
    value: float
    low: float
    high: float
    rays: int

    def covers(self, value: float) -> bool:
        """Whether the interval holds a value."""
        return self.low <= value <= self.high


def offsets(interactions: Sequence[tuple[int, Interaction]], stratum: Integers) -> tuple[Offset, ...]:
    """Return how far right of the item and above it people point (rad), as they see it; none where too few point.

    interactions: with the number of the independent piece (person, or interaction) that each is of. stratum: of each
    piece, (n_pieces,). The mean is the maximum-likelihood estimate for normal errors; its interval is that of a t-test
    on the pieces, within strata, which is right whatever the errors within a piece have in common.
    """
    errors = [(number, error) for number, one in interactions for error in _errors(one)]
    numbers, piece = np.unique([number for number, _ in errors], return_inverse=True)
    strata = np.unique(stratum[numbers.astype(np.int64)], return_inverse=True)[1]
    if len(strata) - len(np.bincount(strata)) < 1:
        return ()
    found = np.array([error for _, error in errors])
    return tuple(_mean(name, found[:, axis], piece, strata) for axis, name in enumerate(("bias_right", "bias_up")))


def _errors(one: Interaction) -> Iterator[tuple[float, float]]:
    problem = Problem(one.scene)
    for step in steps_of(one.events, problem):
        ray = step.observation.ray
        if ray is not None and gesture.is_pointing(ray, problem):
            yield error_of(ray, problem.positions[one.desired])


def error_of(ray: Ray, item: Vector) -> tuple[float, float]:
    """Return how far right of an item and above it a ray points (rad), along the sphere around its head.

    An item straight above or below has no right: its error counts towards x and y. item: (3,) m.
    """
    head = np.array(ray.head)
    aim, arm = (_unit(np.asarray(place) - head) for place in (item, ray.wrist))
    side = np.cross(aim, UP)
    right = _unit(side) if np.linalg.norm(side) > 1e-9 else np.array([1.0, 0.0, 0.0])
    above = np.cross(right, aim)
    off = float(np.hypot(arm @ right, arm @ above))
    angle = math.atan2(off, float(arm @ aim))
    scale = angle / off if off > 0.0 else 0.0
    return float(arm @ right) * scale, float(arm @ above) * scale


def _unit(vector: Vector) -> Vector:
    return np.asarray(vector / np.linalg.norm(vector))


def _mean(name: str, errors: Vector, piece: Integers, strata: Integers) -> Offset:
    """Return the mean and its interval; a piece counts by its rays (linearised ratio of sums)."""
    mean = float(errors.mean())
    sums, sizes = np.bincount(piece, weights=errors - mean), np.bincount(strata)
    apart = (sums - (np.bincount(strata, weights=sums) / sizes)[strata]) ** 2
    spread = math.sqrt(float((apart * (sizes / np.maximum(sizes - 1, 1))[strata]).sum())) / len(errors)
    free = len(strata) - len(sizes)
    reach = spread * float(load("scipy.stats", "study").t.ppf((1.0 + LEVEL) / 2.0, free))
    return Offset(name, mean, mean - reach, mean + reach, len(errors))
