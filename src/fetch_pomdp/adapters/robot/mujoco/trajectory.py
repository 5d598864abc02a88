"""How an arm runs along a path: speeding up, cruising, slowing down; and braking where it is. Pure functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.compiled import Vector

ACCELERATION = 4.0  # rad/s^2, of the joint that moves most
BRAKING = 10.0  # rad/s^2, when it is stopped


@dataclass(frozen=True, slots=True)
class Trajectory:
    """A path with its arc length, counted by the joint that moves most in each piece, and a speed along it."""

    path: Vector  # (n, n_joints) rad
    lengths: Vector  # (n,) rad, from the beginning
    speed: float  # rad/s, at most

    @property
    def length(self) -> float:
        """Length of the path, rad."""
        return float(self.lengths[-1])

    @property
    def duration(self) -> float:
        """Time (s) that it takes, from rest to rest."""
        ramp = self.speed**2 / ACCELERATION
        if self.length >= ramp:
            return self.length / self.speed + self.speed / ACCELERATION
        return 2.0 * math.sqrt(self.length / ACCELERATION)

    def along(self, time: float) -> tuple[float, float]:
        """Return how far (rad) along the path it is at a time (s), and how fast (rad/s)."""
        end = self.duration
        time = min(max(time, 0.0), end)
        peak = min(self.speed, ACCELERATION * end / 2)
        ramp = peak / ACCELERATION
        if time < ramp:
            return ACCELERATION * time**2 / 2, ACCELERATION * time
        if time > end - ramp:
            left = end - time
            return self.length - ACCELERATION * left**2 / 2, ACCELERATION * left
        return peak * (time - ramp / 2), peak

    def at(self, along: float, speed: float) -> tuple[Vector, Vector]:
        """Return the angles (n_joints,) and their velocities (rad/s) at a place along the path."""
        piece = int(np.clip(np.searchsorted(self.lengths, along, side="right") - 1, 0, len(self.path) - 2))
        span = self.lengths[piece + 1] - self.lengths[piece]
        slope = (self.path[piece + 1] - self.path[piece]) / span
        return self.path[piece] + slope * (along - self.lengths[piece]), slope * speed


def trajectory(path: Vector, speed: float) -> Trajectory | None:
    """Return a trajectory along a path (n, n_joints); None where it leads nowhere."""
    steps = np.abs(np.diff(path, axis=0)).max(axis=1)
    kept = np.concatenate([[True], steps > 1e-9])
    if kept.sum() < 2:
        return None
    return Trajectory(path[kept], np.concatenate([[0.0], np.cumsum(steps[steps > 1e-9])]), speed)


def braked(along: float, speed: float, time: float) -> tuple[float, float]:
    """Return place (rad) and speed (rad/s) along a path, `time` (s) after braking began there at a speed."""
    time = min(time, speed / BRAKING)
    return along + speed * time - BRAKING * time**2 / 2, speed - BRAKING * time
