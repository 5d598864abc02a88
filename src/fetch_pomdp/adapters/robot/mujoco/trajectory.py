"""How an arm runs along a path: speeding up, cruising, slowing down; and braking where it is. Pure functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.core.compiled import Vector

ACCELERATION = 4.0  # rad/s^2, of the joint that moves most
BRAKING = 10.0  # rad/s^2, when it is stopped


@dataclass(frozen=True, slots=True)
class Place:
    """A place along a path (rad), with speed (rad/s) and acceleration (rad/s^2) along it."""

    along: float
    speed: float
    acceleration: float


@dataclass(frozen=True, slots=True)
class Target:
    """What an arm's joints shall do at a moment, (n_joints,) each: rad, rad/s, rad/s^2."""

    angles: Vector
    velocities: Vector
    accelerations: Vector


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

    def along(self, time: float) -> Place:
        """Return where along the path it is at a time (s)."""
        end = self.duration
        time = min(max(time, 0.0), end)
        peak = min(self.speed, ACCELERATION * end / 2)
        ramp = peak / ACCELERATION
        if time < ramp:
            return Place(ACCELERATION * time**2 / 2, ACCELERATION * time, ACCELERATION)
        if time > end - ramp:
            left = end - time
            return Place(self.length - ACCELERATION * left**2 / 2, ACCELERATION * left, -ACCELERATION)
        return Place(peak * (time - ramp / 2), peak, 0.0)

    def at(self, place: Place) -> Target:
        """Return what the joints do at a place along the path."""
        piece = int(np.clip(np.searchsorted(self.lengths, place.along, side="right") - 1, 0, len(self.path) - 2))
        slope = (self.path[piece + 1] - self.path[piece]) / (self.lengths[piece + 1] - self.lengths[piece])
        angles = self.path[piece] + slope * (place.along - self.lengths[piece])
        return Target(angles, slope * place.speed, slope * place.acceleration)


def trajectory(path: Vector, speed: float) -> Trajectory | None:
    """Return a trajectory along a path (n, n_joints); None where it leads nowhere."""
    steps = np.abs(np.diff(path, axis=0)).max(axis=1)
    kept = np.concatenate([[True], steps > 1e-9])
    if kept.sum() < 2:
        return None
    return Trajectory(path[kept], np.concatenate([[0.0], np.cumsum(steps[steps > 1e-9])]), speed)


def braked(place: Place, time: float) -> Place:
    """Return the place along a path, `time` (s) after braking began at another."""
    until = place.speed / BRAKING
    slowing = BRAKING if time < until else 0.0
    time = min(time, until)
    return Place(place.along + place.speed * time - BRAKING * time**2 / 2, place.speed - BRAKING * time, -slowing)


def held(angles: Vector) -> Target:
    """Return what joints (n_joints,) do that stay where they are."""
    return Target(angles, np.zeros(len(angles)), np.zeros(len(angles)))
