"""Plans: which arm, by which path, with which grasp. What cannot be planned says why."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.collisions import FAR, NEAR, Carried, Clearance, CollisionChecker
from fetch_pomdp.adapters.robot.mujoco.grasps import giving, grasps, pointing
from fetch_pomdp.adapters.robot.mujoco.kinematics import HandGoal, Kinematics
from fetch_pomdp.adapters.robot.mujoco.layout import Body
from fetch_pomdp.adapters.robot.mujoco.paths import Space, find_path
from fetch_pomdp.adapters.robot.mujoco.search import NO_WAY, STRETCHED, CannotError, Search, StoppedError, blocked_by
from fetch_pomdp.adapters.robot.mujoco.world import Pose, World
from fetch_pomdp.core.compiled import Vector

APPROACH = 0.10  # m, of the straight way down to an item
LIFT = 0.12  # m, of the straight way up with it
STRETCH = 0.01  # m, between configurations of a straight way of the hand
FREE_BELOW = 0.02  # m of a lift in which what is lifted may be near the table
JUMP = 0.6  # rad, of a joint between two configurations of a straight way, that is none
PATH = 0.3  # s, for which OMPL looks for a single path
SEEDS = 4  # of a goal's inverse kinematics, beside where the arm is and where it rests
SPREAD = 0.5  # rad, of these around where the arm rests


@dataclass(frozen=True, slots=True)
class Reach:
    """A way of one arm to where it points or gives."""

    arm: str
    path: Vector  # (n, n_joints) rad


@dataclass(frozen=True, slots=True)
class Take:
    """A way of one arm to an item: over it, down to it, and up again with it."""

    arm: str
    item: str
    path: Vector  # (n, n_joints) rad
    down: Vector
    up: Vector
    held: Pose  # of the item in the frame of the hand


class Planner:
    """Plans in a world as it is at each call. stopped: whether to give up, which raises StoppedError."""

    def __init__(self, world: World, stopped: Callable[[], bool], seed: int = 0) -> None:
        self._world, self._stopped = world, stopped
        self._rng = np.random.default_rng(seed)
        self._checker = CollisionChecker(world)
        arms = world.robot.arms
        self._kinematics = {arm.name: Kinematics(world.robot, arm, world.layout) for arm in arms}

    def point(self, item: Body) -> Reach:
        """Plan to point at an item. Raises CannotError."""
        self._checker.refresh()
        target, search = self._world.middle(item), Search(self._stopped)
        goals = (
            (arm, HandGoal(pose, free=True))
            for arm in self.nearest_arms(target)
            for pose in pointing(target, self._world.shoulder(arm))
        )
        return self._reach(goals, search)

    def give(self, carried: Carried) -> Reach:
        """Plan to bring what a hand holds to the person. Raises CannotError."""
        self._checker.refresh(carried)
        return self._reach(self._giving(carried.arm), Search(self._stopped))

    def move(self, arm: str, end: Vector, carried: Carried | None = None) -> Reach:
        """Plan to bring an arm to a configuration (n_joints,). Raises CannotError."""
        self._checker.refresh(carried)
        culprit = self._checker.blocked_by(arm, end, FAR)
        if culprit is not None:
            raise CannotError(blocked_by(culprit))
        path = self._path(arm, end)
        if path is None:
            raise CannotError(NO_WAY)
        return Reach(arm, path)

    def take(self, item: Body) -> Take:
        """Plan to take an item and lift it. Raises CannotError."""
        self._checker.refresh()
        world, search = self._world, Search(self._stopped)
        pose = world.item_pose(item.id)
        for arm in self.nearest_arms(pose.place):
            for grasp in grasps(item.kind, pose, world.shoulder(arm), world.robot.gripper.depth):
                if search.over():
                    raise CannotError(search.reason())
                plan = self._take(arm, item, grasp, search)
                if plan is not None:
                    return plan
        raise CannotError(search.reason())

    def _take(self, arm: str, item: Body, grasp: Pose, search: Search) -> Take | None:
        above = Pose(grasp.place - APPROACH * grasp.axes[:, 2], grasp.axes)
        over = Pose(grasp.place + np.array([0.0, 0.0, LIFT]), grasp.axes)
        held = relative(self._world.item_pose(item.id), grasp)
        for there in self._solutions(arm, HandGoal(grasp), search):
            culprit = self._checker.blocked_by(arm, there, NEAR, ignore=(item.id,))
            if culprit is not None:
                search.blocked(culprit)
                continue
            away, up = self._straight(arm, there, grasp, above), self._straight(arm, there, grasp, over)
            if away is None or up is None:
                search.blocked(STRETCHED)
                continue
            down = away[::-1]
            free = round(0.3 * len(down))  # there the hand is still above the item
            culprit = self._blocked(arm, down[:free], NEAR) or self._blocked(arm, down[free:], NEAR, ignore=(item.id,))
            culprit = culprit or self._blocked_lift(arm, up, Carried(item.id, arm, held))
            if culprit is not None:
                search.blocked(culprit)
                continue
            path = self._path(arm, down[0])
            if path is not None:
                return Take(arm, item.id, path, down, up, held)
            search.blocked(NO_WAY)
        return None

    def _blocked_lift(self, arm: str, up: Vector, carried: Carried) -> str | None:
        self._checker.refresh(carried)
        skipped = round(FREE_BELOW / LIFT * len(up))
        culprit = self._blocked(arm, up[skipped:], NEAR)
        self._checker.refresh()
        return culprit

    def _reach(self, goals: Iterable[tuple[str, HandGoal]], search: Search) -> Reach:
        for arm, goal in goals:
            if search.over():
                break
            for angles in self._solutions(arm, goal, search):
                culprit = self._checker.blocked_by(arm, angles, FAR)
                path = None if culprit is not None else self._path(arm, angles)
                if path is not None:
                    return Reach(arm, path)
                search.blocked(culprit or NO_WAY)
        raise CannotError(search.reason())

    def _giving(self, arm: str) -> Iterator[tuple[str, HandGoal]]:
        layout = self._world.layout
        forward = np.array(layout.forward)
        base = np.array(layout.base)
        offset = self._world.shoulder(arm) - base
        side = float(np.sign(forward[0] * offset[1] - forward[1] * offset[0]))
        for pose in giving(base, forward, np.array(layout.head), side):
            yield arm, HandGoal(pose, free=True)

    def nearest_arms(self, target: Vector) -> list[str]:
        """Return the arms, that first whose shoulder is nearest to a target (3,)."""
        return sorted(self._world.arms, key=lambda arm: float(np.linalg.norm(self._world.shoulder(arm) - target)))

    def _solutions(self, arm: str, goal: HandGoal, search: Search) -> Iterator[Vector]:
        """Yield configurations that reach a goal: from where the arm is, from its rest, and from around that."""
        index = self._world.arms[arm]
        home = np.array(index.arm.home)
        found: list[Vector] = []
        for number in range(2 + SEEDS):
            seed = (
                (self._world.joints(arm), home)[number]
                if number < 2
                else home + self._rng.normal(0.0, SPREAD, len(home))
            )
            angles = self._kinematics[arm].solve(goal, np.clip(seed, index.lowest + 0.01, index.highest - 0.01))
            if angles is None or any(np.abs(angles - other).max() < 0.1 for other in found):
                if number >= 2 and not found:
                    return  # two seeds of three found nothing: it is out of reach
                continue
            search.reached = True
            found.append(angles)
            yield angles

    def _straight(self, arm: str, start: Vector, first: Pose, last: Pose) -> Vector | None:
        """Return configurations (n, n_joints) that lead the hand along a line, from `start` at its first pose."""
        pieces = max(1, round(float(np.linalg.norm(last.place - first.place)) / STRETCH))
        path = [start]
        for part in np.linspace(0.0, 1.0, pieces + 1)[1:]:
            pose = Pose(first.place + part * (last.place - first.place), last.axes)
            angles = self._kinematics[arm].solve(HandGoal(pose), path[-1])
            if angles is None or np.abs(angles - path[-1]).max() > JUMP:
                return None
            path.append(angles)
        return np.array(path)

    def _blocked(self, arm: str, path: Vector, clearance: Clearance, *, ignore: Collection[str] = ()) -> str | None:
        for angles in path:
            culprit = self._checker.blocked_by(arm, angles, clearance, ignore=ignore)
            if culprit is not None:
                return culprit
        return None

    def _path(self, arm: str, end: Vector) -> Vector | None:
        start, index = self._world.joints(arm), self._world.arms[arm]
        roomy = all(self._checker.blocked_by(arm, angles, FAR) is None for angles in (start, end))
        clearance = FAR if roomy else NEAR
        culprit = None if roomy else self._checker.blocked_by(arm, start, NEAR)
        if culprit is not None:
            raise CannotError(blocked_by(culprit))  # no plan leads away from here
        space = Space(
            index.lowest, index.highest, lambda angles: self._checker.blocked_by(arm, angles, clearance) is None,
            self._stopped,
        )  # fmt: skip
        path = find_path(start, end, space, via=np.array(index.arm.home), seconds=PATH)
        if self._stopped():
            raise StoppedError
        return path


def relative(item: Pose, hand: Pose) -> Pose:
    """Return an item's pose in the frame of a hand."""
    return Pose(hand.axes.T @ (item.place - hand.place), hand.axes.T @ item.axes)
