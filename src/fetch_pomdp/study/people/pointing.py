"""A pointing arm, seen at 30 frames a second: it rises, is held with an error that drifts, and falls.

The error has two axes, to the right of the direction and up from it, each a constant bias and an Ornstein-Uhlenbeck
process.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp.checks import Point3
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.ports import Frame
from fetch_pomdp.core.scene import Item

RATE = 30.0  # frames a second
REST = (0.25, 0.1, -0.95)  # from the head to the wrist of an arm that hangs, in lengths of `reach`


@dataclass(frozen=True, slots=True, kw_only=True)
class PointingGesture:
    """One pointing: when, where to, and how far off."""

    start: float  # s, the arm leaves its rest
    rise: float  # s, on the way; as long on the way back
    held: float  # s
    bias: tuple[float, float]  # rad, to the right and up
    jitter: float  # rad, standard deviation of each axis
    jitter_time: float  # s

    @property
    def end(self) -> float:
        """When (s) the arm is at rest again."""
        return self.start + 2 * self.rise + self.held


def frames(episode: PointingGesture, head: Point3, target: Point3, reach: float, rng: Generator) -> list[Frame]:
    """Draw the frames of an arm of `reach` (m) that points from the head to the target (m)."""
    times = _times(episode)
    if not len(times):
        return []
    offsets = drift(len(times), episode.jitter, episode.jitter_time, rng) + episode.bias
    arms = reach * (directions(_unit(np.subtract(target, head)), offsets))
    up = _raised(times, episode)[:, None]
    wrists = head + up * arms + (1.0 - up) * (reach * np.array(REST))
    return [Frame(time, head, ((x, y, z),)) for time, (x, y, z) in zip(times.tolist(), wrists.tolist(), strict=True)]


def drift(count: int, size: float, time: float, rng: Generator) -> Vector:
    """Draw an Ornstein-Uhlenbeck process in two axes at the frames' rate, begun in its stationary distribution.

    size: standard deviation of each axis; time: s, after which the correlation is 1/e. Returns (count, 2).
    """
    kept = math.exp(-1.0 / (RATE * time))
    fresh = math.sqrt(1.0 - kept * kept)
    return size * np.array(list(_drifting(kept, fresh, rng.standard_normal((count, 2)).tolist())))


def _drifting(kept: float, fresh: float, noise: list[list[float]]) -> Iterator[tuple[float, float]]:
    x, y = noise[0]
    yield x, y
    for a, b in noise[1:]:
        x, y = kept * x + fresh * a, kept * y + fresh * b
        yield x, y


def directions(direction: Vector, offsets: Vector) -> Vector:
    """Return unit vectors off a unit direction (3,) by offsets (n, 2), rad to the right and up along great circles."""
    right, up = _axes(direction)
    angles = np.hypot(offsets[:, 0], offsets[:, 1])[:, None]
    sideways = offsets[:, :1] * right + offsets[:, 1:] * up
    return np.asarray(np.cos(angles) * direction + np.sinc(angles / math.pi) * sideways)


def item_at(head: Point3, item: Item, offset: tuple[float, float], items: Sequence[Item]) -> Item:
    """Return the item in whose direction a pointing at `item` appears from the head, off by an offset (rad)."""
    seen = directions(_unit(np.subtract(item.position, head)), np.array([offset]))[0]
    return max(items, key=lambda other: float(seen @ _unit(np.subtract(other.position, head))))


def _axes(direction: Vector) -> tuple[Vector, Vector]:
    """Return the horizontal unit vector to the right of a unit direction, and the one up from it.

    To the right is x for a direction that is straight up or down.
    """
    x, y, z = direction.tolist()
    level = math.hypot(x, y)
    a, b = (1.0, 0.0) if level < 1e-9 else (y / level, -x / level)
    return np.array((a, b, 0.0)), np.array((b * z, -a * z, a * y - b * x))


def _unit(vector: Vector) -> Vector:
    return np.asarray(vector / np.linalg.norm(vector))


def _times(episode: PointingGesture) -> Vector:
    """Return when there is a frame: the tracker's ticks do not wait for the arm."""
    return np.arange(math.ceil(episode.start * RATE), math.floor(episode.end * RATE) + 1) / RATE


def _raised(times: Vector, episode: PointingGesture) -> Vector:
    """Return how far the arm is up at each time, from 0 to 1: it starts and stops without a jerk."""
    if episode.rise == 0.0:
        return np.ones(len(times))
    way = np.minimum(times - episode.start, episode.end - times) / episode.rise
    share = np.clip(way, 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))
