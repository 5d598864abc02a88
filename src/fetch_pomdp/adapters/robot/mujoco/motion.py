"""Movements carried out in the world: an arm along a path, fingers, pauses; any of them can be stopped."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.model import PERSON
from fetch_pomdp.adapters.robot.mujoco.search import CannotError, StoppedError
from fetch_pomdp.adapters.robot.mujoco.trajectory import Target, braked, held, trajectory
from fetch_pomdp.adapters.robot.mujoco.world import World
from fetch_pomdp.core.compiled import Vector

STILL = 0.01  # rad/s: an arm that is slower has arrived
FELT = 1.0  # s, for which a contact that has begun may be what holds an arm up
SETTLE = 0.3  # s, after which it is not waited for any longer
LOST = 0.03  # rad, by which a joint that lags is held up by something; one that moves freely lags by 0.006 at most


@dataclass(frozen=True, slots=True)
class Doing:
    """What a movement is for. phase: as a log calls it. target: the item that may be touched. carried: that in hand."""

    phase: str
    target: str | None = None
    carried: str | None = None


@dataclass(frozen=True, slots=True)
class Movement:
    """A movement that was carried out, with the time that it should take and took, s."""

    phase: str
    planned: float
    executed: float
    completed: bool


class Mover:
    """Lets the world's time pass while the robot moves. each_step: is called after every step of the world."""

    def __init__(self, world: World, stopped: Callable[[], bool], each_step: Callable[[], None] | None = None) -> None:
        self._world, self._stopped, self._each_step = world, stopped, each_step or (lambda: None)
        self.movements: list[Movement] = []
        self.phase = ""  # of the movement that goes on, or went on last

    def follow(self, arm: str, path: Vector, doing: Doing, *, speed: float = 1.0) -> None:
        """Move an arm along a path (n, n_joints); speed: part of the robot's.

        Raises StoppedError once it stands, if it was stopped, and CannotError if something holds it up.
        """
        way = trajectory(path, speed * self._world.robot.speed)
        if way is None:
            return
        begun, elapsed, place = self._world.time, 0.0, way.along(0.0)
        try:
            while elapsed < way.duration:
                self._heed(arm)
                elapsed += self._world.timestep
                place = way.along(elapsed)
                self._command(arm, way.at(place), doing)
            self._settle(arm, held(way.path[-1]), doing)
        except (StoppedError, CannotError):
            self._brake(lambda time: way.at(braked(place, time)), arm, doing)
            self._note(doing, way.duration, begun, completed=False)
            raise
        self._note(doing, way.duration, begun, completed=True)

    def fingers(self, arm: str, closed: float, doing: Doing) -> None:
        """Open (0) or close (1) the fingers. Raises StoppedError if it was stopped."""
        self._world.command_fingers(arm, closed)
        self.wait(self._world.robot.gripper.time, doing)

    def release(self, arm: str, doing: Doing) -> None:
        """Open the fingers, whether it is stopped or not: what is in them is going already."""
        begun = self._world.time
        self._world.command_fingers(arm, 0.0)
        while self._world.time < begun + self._world.robot.gripper.time:
            self._step(doing)
        self._note(doing, self._world.robot.gripper.time, begun, completed=True)

    def wait(self, seconds: float, doing: Doing) -> None:
        """Let time pass. Raises StoppedError if it was stopped."""
        begun = self._world.time
        while self._world.time < begun + seconds:
            if self._stopped():
                self._note(doing, seconds, begun, completed=False)
                raise StoppedError
            self._step(doing)
        self._note(doing, seconds, begun, completed=True)

    def _heed(self, arm: str) -> None:
        if self._stopped():
            raise StoppedError
        log = self._world.log.contacts
        if log and log[-1].with_what == PERSON and log[-1].time == self._world.time:
            raise CannotError(f"blocked by {PERSON}")
        if np.abs(self._world.lag(arm)).max() > LOST:
            felt = log and log[-1].time > self._world.time - FELT
            raise CannotError(f"blocked by {log[-1].with_what}" if felt else "was held up")

    def _command(self, arm: str, target: Target, doing: Doing) -> None:
        self._world.command(arm, target)
        self._step(doing)

    def _settle(self, arm: str, end: Target, doing: Doing) -> None:
        begun = self._world.time
        while True:
            self._command(arm, end, doing)
            if self._world.time > begun + SETTLE or self._world.fastest(arm) < STILL:
                return
            self._heed(arm)

    def _brake(self, place: Callable[[float], Target], arm: str, doing: Doing) -> None:
        """Slow down along the path, and hold the arm where it comes to rest."""
        begun = self._world.time
        while self._world.time < begun + SETTLE:
            target = place(self._world.time + self._world.timestep - begun)
            self._command(arm, target, doing)
            if not target.accelerations.any() and self._world.fastest(arm) < STILL:
                break

    def _step(self, doing: Doing) -> None:
        self.phase = doing.phase
        self._world.step()
        self._world.log.watch(self._world.data, doing.phase, doing.target, carried=doing.carried)
        self._each_step()

    def _note(self, doing: Doing, planned: float, begun: float, *, completed: bool) -> None:
        self.movements.append(Movement(doing.phase, planned, self._world.time - begun, completed))
