"""What an arm would touch where it is not yet: a copy of the world in which only the robot and its load collide."""

from __future__ import annotations

import copy
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.contacts import FIRST_ITEM, FURNITURE, ROBOT, SOMEBODY, Numbers
from fetch_pomdp.adapters.robot.mujoco.model import EVERYTHING, EXTRA, body_of
from fetch_pomdp.adapters.robot.mujoco.world import Pose, World
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.extras import load

ITSELF = "its own body"


@dataclass(frozen=True, slots=True)
class Clearance:
    """Distances (m) that a movement keeps."""

    robot: float  # from the robot's own body
    table: float
    person: float
    items: float


FAR = Clearance(robot=0.01, table=0.012, person=0.05, items=0.012)
NEAR = Clearance(robot=0.005, table=0.001, person=0.05, items=0.003)  # on the last stretch to an item
AS_AT_REST = 0.002  # m
MARGIN = 0.055  # m, as far as the copy sees


@dataclass(frozen=True, slots=True)
class Carried:
    """An item in a hand. pose: in the frame of the hand."""

    id: str
    arm: str
    pose: Pose


class CollisionChecker:
    """Tells what blocks a configuration of an arm, while everything else stays as it is in the world."""

    def __init__(self, world: World) -> None:
        self._mujoco = load("mujoco", EXTRA)
        self._world, self._owners = world, world.owners
        self._model = copy.copy(world.model)
        self._data = self._mujoco.MjData(self._model)
        owner = self._owners.owner
        self._model.geom_contype[owner != ROBOT] = 0  # these meet the robot and not each other
        self._model.geom_margin[owner == ROBOT] = MARGIN / 2
        self._carried: Carried | None = None
        self._limits = np.zeros(FIRST_ITEM + len(self._owners.items))
        self._at_rest = self._distances_at_rest()
        self.refresh()

    def refresh(self, carried: Carried | None = None) -> None:
        """Take over how things are in the world now; carried: an item that goes along with a hand."""
        if self._carried is not None:
            self._set_bits(self._carried.id, 0, 0.0)
        self._carried = carried
        if carried is not None:
            self._set_bits(carried.id, EVERYTHING, MARGIN / 2)
        self._base = np.array(self._world.data.qpos)

    def blocked_by(self, arm: str, angles: Vector, clearance: Clearance, *, ignore: Collection[str] = ()) -> str | None:
        """Return what is in the way of an arm at `angles`: an item, the table, the person, ITSELF; None if nothing is.

        ignore: items that may be touched.
        """
        data, model = self._data, self._model
        data.qpos[:] = self._base
        data.qpos[self._world.arms[arm].qpos] = angles
        self._mujoco.mj_kinematics(model, data)
        if self._carried is not None:
            self._carry(self._carried)
        self._mujoco.mj_comPos(model, data)
        self._mujoco.mj_collision(model, data)
        if not data.ncon:
            return None
        pairs, distances = data.contact.geom[: data.ncon], data.contact.dist[: data.ncon]
        return self._nearest(pairs, distances, clearance, frozenset(ignore))

    def _nearest(self, pairs: Numbers, distances: Vector, clearance: Clearance, ignore: frozenset[str]) -> str | None:
        owner = self._owners.owner[pairs]
        mine = owner == ROBOT
        allowed = self._owners.within_a_hand(pairs)
        if self._carried is not None:
            held = owner == self._owners.number(self._carried.id)
            mine |= held
            allowed |= held.any(axis=1) & self._owners.of_hand[self._carried.arm][pairs].any(axis=1)
        other = np.where(mine.all(axis=1), ROBOT, np.where(mine[:, 0], owner[:, 1], owner[:, 0]))
        limits = self._limits
        limits[:] = clearance.items
        limits[ROBOT], limits[FURNITURE], limits[SOMEBODY] = clearance.robot, clearance.table, clearance.person
        for item in ignore:
            limits[self._owners.number(item)] = -np.inf
        wrong = np.flatnonzero(mine.any(axis=1) & ~allowed & (distances < limits[other]))
        for index in wrong[np.argsort(distances[wrong])]:
            if distances[index] < self._at_rest.get(self._bodies(pairs[index]), np.inf):
                return ITSELF if other[index] == ROBOT else self._owners.name(int(pairs[index][mine[index].argmin()]))
        return None

    def _distances_at_rest(self) -> dict[tuple[int, int], float]:
        """Return the distances (m) of the robot's bodies that are near each other where it rests, less a little: these
        may always be as near as that.
        """
        self._data.qpos[:] = self._world.data.qpos
        self._mujoco.mj_forward(self._model, self._data)
        found: dict[tuple[int, int], float] = {}
        for contact in self._data.contact[: self._data.ncon]:
            if (self._owners.owner[contact.geom] == ROBOT).all():
                bodies = self._bodies(contact.geom)
                found[bodies] = min(found.get(bodies, np.inf), float(contact.dist) - AS_AT_REST)
        return found

    def _bodies(self, pair: Numbers) -> tuple[int, int]:
        first, second = self._owners.body_of[pair]
        return (int(first), int(second)) if first < second else (int(second), int(first))

    def _carry(self, carried: Carried) -> None:
        """Put the item where the hand would have it."""
        mujoco, data = self._mujoco, self._data
        site = data.site(f"{carried.arm}/tcp")
        axes = np.array(site.xmat).reshape(3, 3)
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, (axes @ carried.pose.axes).ravel())
        address = int(self._model.joint(body_of(carried.id)).qposadr[0])
        data.qpos[address : address + 3] = site.xpos + axes @ carried.pose.place
        data.qpos[address + 3 : address + 7] = quaternion
        mujoco.mj_kinematics(self._model, data)

    def _set_bits(self, item: str, bits: int, margin: float) -> None:
        geoms = self._owners.geoms(item)
        self._model.geom_contype[geoms] = bits
        self._model.geom_margin[geoms] = margin
