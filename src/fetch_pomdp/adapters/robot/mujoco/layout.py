"""Where robot, person, table and items are, in the frame of the scene: the floor at 0, the person's head above it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from fetch_pomdp.adapters.robot.mujoco.description import RobotDescription
from fetch_pomdp.adapters.robot.mujoco.kinds import Kind, Rgba, color_of, kind_of
from fetch_pomdp.checks import Point3
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.scene import Scene

EDGE = 0.13  # m of table around the outermost items
DEPTH = 0.66  # m, of the table from the robot's side to the person's, at least


@dataclass(frozen=True, slots=True)
class Body:
    """An item as a thing on the table. yaw: rad, of its x axis in the scene's frame."""

    id: str
    kind: Kind
    color: Rgba
    place: Point3  # m, on the table, below its middle
    yaw: float


@dataclass(frozen=True, slots=True)
class Layout:
    """All that is put into the world. forward: unit vector along the floor, from the robot to the person."""

    bodies: tuple[Body, ...]
    head: Point3  # m, the person's
    base: Point3  # m, the root of the robot
    forward: tuple[float, float]
    table: Point3  # m, the middle of its top
    table_half: tuple[float, float]  # m, half its size, along `forward` and across

    @property
    def yaw(self) -> float:
        """Angle (rad) of `forward` in the scene's frame."""
        return math.atan2(self.forward[1], self.forward[0])


def layout(scene: Scene, robot: RobotDescription, rng: Generator | None = None) -> Layout:
    """Return a layout of a scene: the robot stands across the table from the person, and faces them.

    rng: draws how things are turned; without it long things point away from the person.

    Choice: a scene does not say how high the table is, nor where the robot stands. Its top is at the height of the
    lowest item; the robot is beyond the middle of the items, as far from it as its description says.
    """
    places = np.array([item.position for item in scene.items])
    head = np.array(scene.head)
    forward = _forward(places, head)
    across = np.array([-forward[1], forward[0]])
    ahead, aside = places[:, :2] @ forward, places[:, :2] @ across
    middle = (ahead.min() + ahead.max()) / 2 * forward + (aside.min() + aside.max()) / 2 * across
    base = middle - robot.table_distance * forward
    bodies = []
    for item in scene.items:
        away = math.atan2(item.position[1] - head[1], item.position[0] - head[0])
        yaw = away if rng is None else float(rng.uniform(-math.pi, math.pi))
        words = item.vocabulary
        bodies.append(Body(item.id, kind_of(words), color_of(words), item.position, yaw))
    return Layout(
        tuple(bodies), scene.head, (float(base[0]), float(base[1]), robot.height),
        (float(forward[0]), float(forward[1])), (float(middle[0]), float(middle[1]), float(places[:, 2].min())),
        (max(DEPTH / 2, float(np.ptp(ahead)) / 2 + EDGE), float(np.ptp(aside)) / 2 + EDGE + 0.1),
    )  # fmt: skip


def _forward(places: Vector, head: Vector) -> Vector:
    """Return the direction along the floor from the middle of the items to the person."""
    towards = head[:2] - places[:, :2].mean(axis=0)
    length = float(np.linalg.norm(towards))
    return towards / length if length > 1e-9 else np.array([0.0, -1.0])
