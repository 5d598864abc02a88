"""Where a hand may be to point at an item, to take it, and to hand it over; the best first. Pure functions."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.kinds import Across, Along, Kind, Rim
from fetch_pomdp.adapters.robot.mujoco.world import Pose
from fetch_pomdp.core.compiled import Vector

AROUND = tuple(math.pi * part for part in (1.0, 0.75, -0.75, 0.5, -0.5, 0.25, -0.25, 0.0))  # rad, of a rim
POINTING_GAP = (0.14, 0.2, 0.35, 0.6)  # m, from the point between the fingers to the item's middle, the best first
ELEVATIONS = (55.0, 70.0, 40.0, 85.0)  # degrees, of a pointing hand's axis, down from the horizontal
ASIDE = (0.0, 0.5, -0.5)  # rad, of its direction from that of the shoulder
TILTS = (0.0, 20.0, 40.0, 60.0)  # degrees, of a taking hand from straight down
FLOORS = 0.004  # m, that the fingertips stay above the table
UPRIGHT = 0.9  # cosine of the steepest lean at which a cup or a bowl still stands
UP, DOWN = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
PERSON_ROOM = 0.5  # m along the floor, that a giving hand leaves before the person's head
GIVING = ((0.85, 0.1, 0.30), (0.8, 0.25, 0.28), (0.75, 0.2, 0.23), (0.65, 0.2, 0.23), (0.5, 0.25, 0.3))  # m


def axes(look: Vector, close: Vector) -> Vector:
    """Return the axes (3, 3) of a hand that looks along `look` and closes along `close`, made square to it."""
    z = look / np.linalg.norm(look)
    x = close - z * (close @ z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


def pointing(target: Vector, shoulder: Vector) -> Iterator[Pose]:
    """Yield poses whose z axis goes through a target (3,), with a gap; any turn about it will do."""
    away = math.atan2(target[1] - shoulder[1], target[0] - shoulder[0])
    for gap in POINTING_GAP:
        for elevation in np.radians(ELEVATIONS):
            for aside in ASIDE:
                flat = math.cos(elevation)
                look = np.array([flat * math.cos(away + aside), flat * math.sin(away + aside), -math.sin(elevation)])
                across = np.array([-math.sin(away), math.cos(away), 0.0])
                yield Pose(target - gap * look, axes(look, across))


def grasps(kind: Kind, item: Pose, shoulder: Vector, depth: float) -> Iterator[Pose]:
    """Yield poses of the point between the fingers that take an item.

    item: its pose; the origin is on the table. depth: m, of the fingertips beyond the point between them.
    """
    for tilt in np.radians(TILTS):
        for place, angle in _places(kind, item, shoulder, depth):
            close = np.array([math.cos(angle), math.sin(angle), 0.0])
            side = np.array([-close[1], close[0], 0.0])
            leans = (1.0, -1.0) if side @ (place - shoulder) > 0 else (-1.0, 1.0)  # away from the shoulder first
            for lean in leans if tilt else (1.0,):
                look = math.cos(tilt) * DOWN + lean * math.sin(tilt) * side
                for sign in (1.0, -1.0):
                    yield Pose(place, axes(look, sign * close))


def _places(kind: Kind, item: Pose, shoulder: Vector, depth: float) -> Iterator[tuple[Vector, float]]:
    """Yield places (3,) of the point between the fingers and angles (rad) of the line along which they close."""
    take, low = kind.take, depth + FLOORS
    away = math.atan2(item.place[1] - shoulder[1], item.place[0] - shoulder[0])
    if not isinstance(take, Along) and item.axes[2, 2] < UPRIGHT:
        return  # it lies on its side
    if isinstance(take, Across):
        for turn in (math.pi / 2, 0.0, math.pi / 4, -math.pi / 4):
            yield item.place + max(take.height, low) * UP, away + turn
    elif isinstance(take, Rim):
        for turn in AROUND:
            angle = away + turn
            out = take.radius * np.array([math.cos(angle), math.sin(angle), 0.0])
            yield item.place + out + max(take.height, low) * UP, angle
    else:
        along = item.axes[:, 0] * [1.0, 1.0, 0.0]
        length = float(np.linalg.norm(along))
        if length < UPRIGHT:
            return  # it stands on its end
        across = math.atan2(along[1], along[0]) + math.pi / 2
        for offset in take.offsets:
            flat = item.place * [1.0, 1.0, 0.0] + offset * along / length
            yield flat + (item.place[2] + max(take.height, low)) * UP, across


def giving(base: Vector, forward: Vector, head: Vector, side: float) -> Iterator[Pose]:
    """Yield poses of a hand that offers something to the person; any turn about z will do.

    base: (3,) m, the robot's root. forward: (2,), to the person. side: -1 for an arm on the robot's right, 1 left.
    """
    ahead = np.array([forward[0], forward[1], 0.0])
    left = np.array([-forward[1], forward[0], 0.0])
    room = float((head - base) @ ahead) - PERSON_ROOM
    for far, aside, high in GIVING:
        place = np.array(base) + min(far, room) * ahead + side * aside * left
        place[2] = head[2] * 0.5 + 0.05 + high  # between the waist and the chest
        for flat, down in ((0.5, 0.85), (0.8, 0.6), (0.0, 1.0)):
            yield Pose(place, axes(flat * ahead + down * DOWN, left))
