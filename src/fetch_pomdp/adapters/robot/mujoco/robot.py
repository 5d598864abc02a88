"""A robot in MuJoCo behind the `Robot` protocol: it points, takes, lifts, carries, gives and puts down again."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.collisions import Carried
from fetch_pomdp.adapters.robot.mujoco.motion import Doing, Mover
from fetch_pomdp.adapters.robot.mujoco.planning import Planner, Take, relative
from fetch_pomdp.adapters.robot.mujoco.search import CannotError, StoppedError
from fetch_pomdp.adapters.robot.mujoco.world import Pose, World
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.ports import Failure, Outcome
from fetch_pomdp.core.scene import Item

ASKS, GIVES = "This one?", "Here you are."
SPEAK = 0.8  # s, "this one?"
SLOW = 0.5  # of the robot's speed, near an item
SLIPPED = 0.03  # m, that an item in the hand may move before it counts as dropped
TUG = 0.3  # s, for which the person pulls gently before the hand opens
GONE = 0.05  # m from the hand: there the person has it
TRIES = 2  # at taking an item that is still on the table
AT_REST = 0.02  # rad
DROPPED, STUCK = "dropped it", "could not let go"
POINT, ASK, REACH, DESCEND, GRASP, LIFT = "point", "ask", "reach", "descend", "grasp", "lift"
CARRY, TUGGED, GIVE, RETURN = "carry", "tug", "give", "return"
LOWER, RELEASE, RETREAT = "lower", "release", "retreat"

Plan = TypeVar("Plan")


@dataclass(frozen=True, slots=True)
class Planned:
    """How long (s) planning took, and what for."""

    phase: str
    seconds: float


@dataclass(frozen=True, slots=True)
class Given:
    """An item that the person took. slip: m, that a gentle pull moved it in the closed hand."""

    item: str
    slip: float


@dataclass(frozen=True, slots=True)
class Load:
    """What a hand holds, and how it was taken."""

    carried: Carried
    taken: Take


class MujocoRobot:
    """Implements Robot in a World, as fast as the world is simulated unless `each_step` waits.

    `stop` may be called from any thread; the arm then stands within 0.2 s of the world's time. What the hand holds then
    is put back where it was when the next action begins, unless that is to hand over the same item. say: is given each
    sentence when it is said. each_step: is called after every step of the world.
    """

    def __init__(
        self,
        world: World,
        say: Callable[[str], None] = print,
        each_step: Callable[[], None] | None = None,
        *,
        seed: int = 0,
    ) -> None:
        self.world = world
        self._say = say
        self._stop = threading.Event()
        self._planner = Planner(world, self._stop.is_set, seed)
        self.mover = Mover(world, self._stop.is_set, each_step)
        self._at: Take | None = None  # the item's plan on whose straight ways a hand is
        self._load: Load | None = None
        self.plans: list[Planned] = []
        self.given: list[Given] = []

    def point(self, item: Item) -> Outcome | Failure:
        """Point at an item and ask."""
        return self._attempt(lambda: self._point(item.id))

    def pick(self, item: Item) -> Outcome | Failure:
        """Take an item to the person."""
        return self._attempt(lambda: self._pick(item.id))

    def take_back(self, item: Item) -> Outcome:
        """Have the person lay an item back where it was.

        Choice: they do it themselves. Taking something out of a person's hand is not simulated.
        """
        self.world.lay_back(item.id)
        return Outcome.DONE

    def say(self, text: str) -> Outcome:
        """Say something; the arms stay as they are."""
        self._say(text)
        return Outcome.DONE

    def stop(self) -> None:
        """Stop what is going on, from any thread."""
        self._stop.set()

    def rest(self) -> Outcome | Failure:
        """Put back what the hand holds, and bring the arms to where they rest."""
        return self._attempt(self._rest)

    def _attempt(self, action: Callable[[], None]) -> Outcome | Failure:
        self._stop.clear()
        try:
            action()
        except StoppedError:
            return Outcome.STOPPED
        except CannotError as error:
            return Failure(error.reason)
        return Outcome.DONE

    def _point(self, item: str) -> None:
        self._tidy()
        self._make_room(item)
        plan = self._planned(POINT, lambda: self._planner.point(self.world.items[item]))
        self.mover.follow(plan.arm, plan.path, Doing(POINT))
        self._say(ASKS)
        self.mover.wait(SPEAK, Doing(ASK))

    def _pick(self, item: str) -> None:
        load = self._load
        if load is None or load.carried.id != item:
            self._tidy()
            self._make_room(item)
            load = self._take(item)
        self._carry(load)
        self._give(load)
        with contextlib.suppress(CannotError, StoppedError):  # the person has it, wherever the arms are
            self._rest()

    def _take(self, item: str) -> Load:
        for tries_left in reversed(range(TRIES)):
            plan = self._planned(REACH, lambda: self._planner.take(self.world.items[item]))
            try:
                return self._lift(plan)
            except CannotError:
                if not tries_left:
                    raise
                self._tidy()
        raise CannotError(DROPPED)

    def _lift(self, plan: Take) -> Load:
        arm, item = plan.arm, plan.item
        self.mover.follow(arm, plan.path, Doing(REACH, item))
        self._at = plan
        self.mover.follow(arm, plan.down, Doing(DESCEND, item), speed=SLOW)
        self.mover.fingers(arm, 1.0, Doing(GRASP, item))
        self._load = Load(Carried(item, arm, self._in_hand(arm, item)), plan)
        self.mover.follow(arm, plan.up, Doing(LIFT, item, item), speed=SLOW)
        self._check(self._load)
        self._at = None
        return self._load

    def _carry(self, load: Load) -> None:
        """Bring what a hand holds to the person."""
        if self._at is not None:  # stopped while it was lifted
            up = load.taken.up
            self.mover.follow(
                load.carried.arm, self._on(load.carried.arm, up), Doing(LIFT, load.carried.id, load.carried.id)
            )
            self._at = None
        plan = self._planned(GIVE, lambda: self._planner.give(load.carried))
        self.mover.follow(plan.arm, plan.path, Doing(CARRY, carried=load.carried.id))
        self._check(load)

    def _give(self, load: Load) -> None:
        """Let the person pull, open the hand, and see whether they have it. Raises CannotError if they have not."""
        arm, item = load.carried.arm, load.carried.id
        self._say(GIVES)
        before = self._in_hand(arm, item)
        self.world.tug(item, arm)
        try:
            self.mover.wait(TUG, Doing(TUGGED, item))
        except StoppedError:
            self.world.let_be(item)
            raise
        slip = _apart(self._in_hand(arm, item), before)
        self.world.pull(item, arm)
        self.mover.release(arm, Doing(GIVE, item))
        self._load = None
        if _apart(self._in_hand(arm, item), before) < GONE:
            self.world.let_be(item)
            raise CannotError(STUCK)
        self.world.hand_over(item)
        self.given.append(Given(item, slip))

    def _rest(self) -> None:
        self._tidy()
        for arm in self.world.arms:
            self._return(arm)

    def _return(self, arm: str) -> None:
        home = np.array(self.world.arms[arm].arm.home)
        if np.abs(self.world.joints(arm) - home).max() < AT_REST:
            return
        plan = self._planned(RETURN, lambda: self._planner.move(arm, home))
        self.mover.follow(arm, plan.path, Doing(RETURN))

    def _make_room(self, item: str) -> None:
        """Bring those arms to where they rest that are not the nearest to an item; one that cannot is in the way."""
        for arm in self._planner.nearest_arms(self.world.item_pose(item).place)[1:]:
            with contextlib.suppress(CannotError):
                self._return(arm)

    def _tidy(self) -> None:
        """Put back what is in the hand, and leave the item that a hand is on."""
        if self._load is not None:
            self._put_back(self._load)
        if self._at is not None:
            plan = self._at
            self.mover.fingers(plan.arm, 0.0, Doing(RELEASE, plan.item))
            self.mover.follow(plan.arm, self._back(plan.arm, plan.down), Doing(RETREAT, plan.item), speed=SLOW)
            self._at = None

    def _put_back(self, load: Load) -> None:
        arm, item, plan = load.carried.arm, load.carried.id, load.taken
        if self._at is None:
            over = self._planned(LOWER, lambda: self._planner.move(arm, plan.up[-1], load.carried))
            self.mover.follow(arm, over.path, Doing(CARRY, carried=item))
            self._at = plan
        self.mover.follow(arm, self._back(arm, plan.up), Doing(LOWER, item, item), speed=SLOW)
        self._load = None

    def _back(self, arm: str, path: Vector) -> Vector:
        """Return the way back along a path from where on it an arm is."""
        here = self.world.joints(arm)
        return np.concatenate([here[None], path[_nearest(path, here) :: -1]])

    def _on(self, arm: str, path: Vector) -> Vector:
        """Return the rest of a path from where on it an arm is."""
        here = self.world.joints(arm)
        return np.concatenate([here[None], path[_nearest(path, here) :]])

    def _in_hand(self, arm: str, item: str) -> Pose:
        return relative(self.world.item_pose(item), self.world.hand_pose(arm))

    def _check(self, load: Load) -> None:
        """Raise CannotError, with an open hand, if an item is not where the hand took it."""
        if _apart(self._in_hand(load.carried.arm, load.carried.id), load.carried.pose) > SLIPPED:
            self._load = None
            self.world.command_fingers(load.carried.arm, 0.0)
            raise CannotError(DROPPED)

    def _planned(self, phase: str, make: Callable[[], Plan]) -> Plan:
        begun = time.perf_counter()
        try:
            return make()
        finally:
            self.plans.append(Planned(phase, time.perf_counter() - begun))


def _nearest(path: Vector, here: Vector) -> int:
    return int(np.abs(path - here).max(axis=1).argmin())


def _apart(first: Pose, second: Pose) -> float:
    return float(np.linalg.norm(first.place - second.place))
