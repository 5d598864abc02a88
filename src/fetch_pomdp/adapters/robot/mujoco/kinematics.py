"""Where an arm's joints have to be for its hand to be somewhere: inverse kinematics by mink."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.description import Arm, RobotDescription
from fetch_pomdp.adapters.robot.mujoco.layout import Layout
from fetch_pomdp.adapters.robot.mujoco.model import EXTRA, place_robot, robot_spec, tcp
from fetch_pomdp.adapters.robot.mujoco.world import Pose
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.extras import load

NEAR, STRAIGHT = 0.0005, 0.003  # m and rad: what is near enough
LONGEST = 0.4  # rad, of a joint in one iteration
ITERATIONS = 40
MOST_WITHOUT_GAIN = 8  # iterations without getting nearer, after which it is given up
STEP = 0.1  # s of mink's integration, whose length cancels out


@dataclass(frozen=True, slots=True)
class HandGoal:
    """Where a hand shall be. free: whether any turn about the way that it looks will do."""

    pose: Pose
    free: bool = False


class Kinematics:
    """Inverse kinematics of one arm, the rest of the robot as it stands in a layout."""

    def __init__(self, robot: RobotDescription, arm: Arm, layout: Layout) -> None:
        load("mink", EXTRA)
        import mink

        spec = robot_spec(robot)
        place_robot(spec, robot, layout)
        model = _skeleton(spec, arm).compile()
        self.model = model
        order = [int(model.joint(name).qposadr[0]) for name in arm.joints]
        self._order = np.array(order)
        self._mink = mink
        self._configuration = mink.Configuration(model)
        self._limits = [mink.ConfigurationLimit(model)]
        self._tasks = {
            free: mink.FrameTask(
                tcp(arm), "site", position_cost=1.0, orientation_cost=np.array([0.3, 0.3, 0.0 if free else 0.3]),
                lm_damping=1e-3,
            )
            for free in (False, True)
        }  # fmt: skip
        self._posture = mink.PostureTask(model, cost=1e-3)

    def solve(self, goal: HandGoal, seed: Vector) -> Vector | None:
        """Return angles (n_joints,) near `seed` that put the hand there, None if none were found."""
        mink, configuration, task = self._mink, self._configuration, self._tasks[goal.free]
        start = np.empty(len(self._order))
        start[self._order] = seed
        configuration.update(start)
        rotation = mink.SO3.from_matrix(goal.pose.axes)
        task.set_target(mink.SE3.from_rotation_and_translation(rotation, goal.pose.place))
        self._posture.set_target(start)
        best, since = np.inf, 0
        for _ in range(ITERATIONS):
            error = task.compute_error(configuration)
            turned = error[3:5] if goal.free else error[3:]
            far, tilt = float(np.linalg.norm(error[:3])), float(np.linalg.norm(turned))
            if far < NEAR and tilt < STRAIGHT:
                return np.array(configuration.q[self._order])
            since = 0 if far + 0.3 * tilt < 0.95 * best else since + 1
            best = min(best, far + 0.3 * tilt)
            if since > MOST_WITHOUT_GAIN:
                return None
            velocity = mink.solve_ik(
                configuration, [task, self._posture], STEP, "daqp", damping=1e-6, limits=self._limits
            )
            configuration.integrate_inplace(np.clip(velocity * STEP, -LONGEST, LONGEST), 1.0)
        return None


def _skeleton(spec: Any, arm: Arm) -> Any:
    """Leave of a robot its bodies and the joints of one arm."""
    fixed = [joint for joint in spec.joints if joint.name not in arm.joints]
    for part in (*spec.actuators, *spec.equalities, *spec.tendons, *spec.geoms, *spec.meshes, *fixed):
        spec.delete(part)
    return spec
