"""The world that the robot acts in: MuJoCo's model and state of a layout, by the names of arms and items,
and the pacer that makes its time that of the wall.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.contacts import ContactLog, Owners
from fetch_pomdp.adapters.robot.mujoco.description import Arm, RobotDescription
from fetch_pomdp.adapters.robot.mujoco.layout import Body, Layout
from fetch_pomdp.adapters.robot.mujoco.model import EXTRA, LAG, body_of, tcp, world_model
from fetch_pomdp.adapters.robot.mujoco.trajectory import Target
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.extras import load

GRAVITY = 9.81  # m/s^2
PULL, TUG = 3.0, 1.5  # N, of somebody who takes what they are handed, and before that
SETTLE = 0.4  # s in which the items come to rest
CAUGHT_UP = 0.25  # s behind the wall at the most: what is lost beyond is not caught up


@dataclass(frozen=True, slots=True)
class Pose:
    """Where a body or a hand is. place: (3,) m. axes: (3, 3), its x, y and z axes as columns."""

    place: Vector
    axes: Vector


@dataclass(frozen=True, slots=True)
class ArmIndex:
    """Where an arm's joints, servos and fingers are in MuJoCo's arrays."""

    arm: Arm
    qpos: Vector  # (n_joints,) int
    dofs: Vector  # (n_joints,) int
    servos: Vector  # (n_joints,) int
    fingers: Vector  # (n_drives,) int, of the gripper's servos
    lowest: Vector  # (n_joints,) rad
    highest: Vector  # (n_joints,) rad


class World:
    """The simulated robot, table, items and person, at rest at the beginning."""

    def __init__(self, robot: RobotDescription, layout: Layout) -> None:
        mujoco = load("mujoco", EXTRA)
        self.robot, self.layout = robot, layout
        self.model = world_model(robot, layout)
        self.data = mujoco.MjData(self.model)
        self.items = {body.id: body for body in layout.bodies}
        self.arms = {arm.name: _index(self.model, arm, len(robot.gripper.drives)) for arm in robot.arms}
        self.owners = Owners(self.model, robot.root, self.items, self.arms)
        self.log = ContactLog(self.owners)
        self._step, self._inertia = mujoco.mj_step, mujoco.mj_mulM
        self._touches: dict[str, tuple[Any, Any]] = {}  # bits of the collisions of items that the person has
        self._commanded = {arm.name: np.array(arm.home) for arm in robot.arms}
        for arm in self.arms.values():
            self.data.qpos[arm.qpos] = arm.arm.home
            self.data.ctrl[arm.servos] = arm.arm.home
            self.command_fingers(arm.arm.name, closed=0.0)
        mujoco.mj_forward(self.model, self.data)
        for _ in range(round(SETTLE / self.timestep)):
            self._step(self.model, self.data)

    @property
    def timestep(self) -> float:
        """Length (s) of a step."""
        return float(self.model.opt.timestep)

    @property
    def time(self) -> float:
        """The world's clock, s."""
        return float(self.data.time)

    def step(self) -> None:
        """Let one timestep pass."""
        self._step(self.model, self.data)

    def joints(self, arm: str) -> Vector:
        """Return the angles (n_joints,) of an arm, rad."""
        return np.array(self.data.qpos[self.arms[arm].qpos])

    def fastest(self, arm: str) -> float:
        """Return the speed of an arm's fastest joint, rad/s."""
        return float(np.abs(self.data.qvel[self.arms[arm].dofs]).max())

    def command(self, arm: str, target: Target) -> None:
        """Have an arm's servos follow a target.

        As real arms' controllers do, it knows the torques that the movement itself needs (computed torque) and the
        servos' damping, and adds both.
        """
        index = self.arms[arm]
        self._commanded[arm] = target.angles
        wanted = np.zeros(self.model.nv)
        wanted[index.dofs] = target.accelerations
        torques = np.empty(self.model.nv)
        self._inertia(self.model, self.data, torques, wanted)
        torques += self.data.qfrc_bias - self.data.qfrc_gravcomp
        ahead = LAG * target.velocities + torques[index.dofs] / index.arm.stiffness
        self.data.ctrl[index.servos] = target.angles + ahead

    def command_fingers(self, arm: str, closed: float) -> None:
        """Have the fingers go to a place from 0, open, to 1, closed."""
        for servo, drive in zip(self.arms[arm].fingers, self.robot.gripper.drives, strict=True):
            self.data.ctrl[servo] = drive.open + closed * (drive.closed - drive.open)

    def lag(self, arm: str) -> Vector:
        """Return how far an arm's joints are behind what was commanded last, (n_joints,) rad."""
        return self._commanded[arm] - self.joints(arm)

    def tug(self, item: str, arm: str) -> None:
        """Have the person pull gently at an item in a hand."""
        self.data.xfrc_applied[self.model.body(body_of(item)).id, :3] = TUG * self.hand_pose(arm).axes[:, 2]

    def pull(self, item: str, arm: str) -> None:
        """Have the person pull an item out of a hand, and bear its weight."""
        weight = np.array([0.0, 0.0, self._weight(item)])
        self.data.xfrc_applied[self.model.body(body_of(item)).id, :3] = PULL * self.hand_pose(arm).axes[:, 2] + weight

    def let_be(self, item: str) -> None:
        """Have the person let go of an item."""
        self.data.xfrc_applied[self.model.body(body_of(item)).id] = 0.0

    def hand_over(self, item: str) -> None:
        """Let the person have an item: it is before their chest, and nothing touches it any more."""
        geoms = self.owners.geoms(item)
        self._touches[item] = self.model.geom_contype[geoms].copy(), self.model.geom_conaffinity[geoms].copy()
        self.model.geom_contype[geoms] = self.model.geom_conaffinity[geoms] = 0
        joint = self.model.joint(body_of(item))
        place, velocity = int(joint.qposadr[0]), int(joint.dofadr[0])
        head, (x, y) = np.array(self.layout.head), self.layout.forward
        self.data.qpos[place : place + 3] = head - [0.3 * x, 0.3 * y, 0.45]
        self.data.qvel[velocity : velocity + 6] = 0.0
        self.data.xfrc_applied[self.model.body(body_of(item)).id, :3] = [0.0, 0.0, self._weight(item)]

    def lay_back(self, item: str) -> None:
        """Lay an item that the person has back where it was in the beginning."""
        body, joint = self.model.body(body_of(item)), self.model.joint(body_of(item))
        place, velocity = int(joint.qposadr[0]), int(joint.dofadr[0])
        self.data.qpos[place : place + 7] = self.model.qpos0[place : place + 7]
        self.data.qvel[velocity : velocity + 6] = 0.0
        self.data.xfrc_applied[body.id] = 0.0
        geoms = self.owners.geoms(item)
        self.model.geom_contype[geoms], self.model.geom_conaffinity[geoms] = self._touches.pop(item)
        for _ in range(round(SETTLE / self.timestep)):
            self._step(self.model, self.data)

    def _weight(self, item: str) -> float:
        return float(self.model.body(body_of(item)).mass[0]) * GRAVITY

    def item_pose(self, id: str) -> Pose:
        """Return where an item is; its origin is below its middle when it stands."""
        body = self.data.body(body_of(id))
        return Pose(np.array(body.xpos), np.array(body.xmat).reshape(3, 3))

    def hand_pose(self, arm: str) -> Pose:
        """Return where the point between an arm's fingers is; z is the way the hand looks."""
        site = self.data.site(tcp(self.arms[arm].arm))
        return Pose(np.array(site.xpos), np.array(site.xmat).reshape(3, 3))

    def shoulder(self, arm: str) -> Vector:
        """Return where an arm begins, (3,) m."""
        return np.array(self.data.body(self.arms[arm].arm.shoulder).xpos)

    def middle(self, item: Body) -> Vector:
        """Return the middle of an item, (3,) m."""
        pose = self.item_pose(item.id)
        return pose.place + pose.axes[:, 2] * item.kind.top / 2


def _index(model: Any, arm: Arm, drives: int) -> ArmIndex:
    joints = [model.joint(name) for name in arm.joints]
    ranges = np.array([joint.range for joint in joints])
    return ArmIndex(
        arm,
        np.array([joint.qposadr[0] for joint in joints]),
        np.array([joint.dofadr[0] for joint in joints]),
        np.array([model.actuator(name).id for name in arm.joints]),
        np.array([model.actuator(f"{arm.name}/fingers{index}").id for index in range(drives)]),
        ranges[:, 0],
        ranges[:, 1],
    )


class RealTimePacer:
    """Waits, after a step of the world, until as much time has passed outside as inside."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._offset = time.monotonic() - world.time

    def __call__(self) -> None:
        """Wait; begin anew after a pause in which the world stood still."""
        early = self._world.time + self._offset - time.monotonic()
        if early > 0.0:
            time.sleep(early)
        elif early < -CAUGHT_UP:
            self._offset = time.monotonic() - self._world.time
