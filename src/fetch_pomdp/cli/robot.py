"""A robot in MuJoCo for the commands: its world, what shows that it moves, its film, and its clock."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.markup import escape

from fetch_pomdp.adapters.robot.mujoco.description import RobotDescription
from fetch_pomdp.adapters.robot.mujoco.film import Film, choose_graphics
from fetch_pomdp.adapters.robot.mujoco.layout import layout
from fetch_pomdp.adapters.robot.mujoco.robot import SPEAK, MujocoRobot
from fetch_pomdp.adapters.robot.mujoco.world import RealTimePacer, World
from fetch_pomdp.core.interaction import Timing
from fetch_pomdp.core.ports import Failure, Outcome, Robot
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.study.design import Study


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """Where a robot acts. say: is given what it says. live: whether its time is that of the wall."""

    scene: Scene
    say: Callable[[str], None]
    console: Console
    video: Path | None = None
    live: bool = False


class Announced:
    """A Robot that shows what it is about while one waits for it."""

    def __init__(self, robot: MujocoRobot, name: str, console: Console) -> None:
        self._robot, self._name, self._console = robot, name, console

    def point(self, item: Item) -> Outcome | Failure:
        """Point at an item and ask."""
        with self._shown(f"points at {item.id}"):
            return self._robot.point(item)

    def pick(self, item: Item) -> Outcome | Failure:
        """Hand an item over."""
        with self._shown(f"fetches {item.id}"):
            return self._robot.pick(item)

    def take_back(self, item: Item) -> Outcome | Failure:
        """Take an item back that was handed over."""
        with self._shown(f"takes {item.id} back"):
            return self._robot.take_back(item)

    def say(self, text: str) -> Outcome | Failure:
        """Say something that is no question about an item."""
        return self._robot.say(text)

    def stop(self) -> None:
        """Stop what is going on."""
        self._robot.stop()

    def _shown(self, doing: str) -> contextlib.AbstractContextManager[object]:
        return self._console.status(f"{escape(self._name)} {escape(doing)}", spinner="dots")


@contextmanager
def opened_robot(name: str, stage: Stage) -> Iterator[Robot]:
    """Put a robot before a scene, until the interaction is over.

    Raises RobotDescriptionError, MissingExtraError, or InputError for a film that cannot be made.
    """
    description = RobotDescription.load(name)
    if stage.video is not None:
        choose_graphics()
    with contextlib.ExitStack() as open_files:
        with stage.console.status(f"building {escape(description.name)} and the table"):
            world = World(description, layout(stage.scene, description))
            each_step: Callable[[], None] | None = RealTimePacer(world) if stage.live else None
            if stage.video is not None:
                each_step = _both(each_step, open_files.enter_context(Film(world, stage.video)))
            robot = MujocoRobot(world, stage.say, each_step)
        yield Announced(robot, description.name, stage.console)


def timing_of(name: str) -> Timing:
    """Return how long a robot's steps last: a question with its measured way to an item."""
    listen = Timing().listen
    return Timing(question=RobotDescription.load(name).durations.point + SPEAK + listen, listen=listen)


def with_robot(study: Study, name: str) -> Study:
    """Return a study whose clock is a robot's, and in which a question costs what it takes, in waits."""
    clock = dataclasses.replace(study.clock, arm=RobotDescription.load(name).durations.point, speak=SPEAK)
    timing = clock.timing()
    layouts = {}
    for layout_name, scene in study.layouts.items():
        price = scene.rewards.wait * timing.question / timing.wait
        layouts[layout_name] = dataclasses.replace(scene, rewards=scene.rewards.with_changes({"point": price}))
    return dataclasses.replace(study, clock=clock, layouts=layouts)


def _both(first: Callable[[], None] | None, second: Callable[[], None]) -> Callable[[], None]:
    def each() -> None:
        if first is not None:
            first()
        second()

    return each
