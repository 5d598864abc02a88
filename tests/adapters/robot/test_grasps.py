"""Where hands may be."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from fetch_pomdp.adapters.robot.mujoco.grasps import PERSON_ROOM, giving, grasps, pointing
from fetch_pomdp.adapters.robot.mujoco.kinds import BOWL, CUP, KINDS, MARKER, Kind
from fetch_pomdp.adapters.robot.mujoco.world import Pose

SHOULDER = np.array([0.0, 0.26, 1.0])
DEPTH = 0.01


def lying(x: float, y: float, yaw: float) -> Pose:
    axes = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    return Pose(np.array([x, y, 0.75]), axes)


def test_a_pointing_hand_looks_through_the_item() -> None:
    target = np.array([0.7, 0.1, 0.78])
    for pose in pointing(target, SHOULDER):
        away = target - pose.place
        assert np.cross(pose.axes[:, 2], away) == pytest.approx(np.zeros(3), abs=1e-12)
        assert pose.axes[:, 2] @ away >= 0.14 - 1e-9
        assert pose.axes.T @ pose.axes == pytest.approx(np.eye(3), abs=1e-12)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
@pytest.mark.parametrize("yaw", [0.0, 1.1])
def test_fingers_stay_above_the_table(kind: Kind, yaw: float) -> None:
    item = lying(0.7, 0.1, yaw)
    found = list(grasps(kind, item, SHOULDER, DEPTH))
    assert found
    for pose in found:
        tip = pose.place + DEPTH * pose.axes[:, 2]
        assert tip[2] > item.place[2] + 0.003
        assert pose.axes[2, 2] < 0, "the hand looks down"
        assert np.linalg.det(pose.axes) == pytest.approx(1.0)
        assert pose.axes[2, 0] == pytest.approx(0.0, abs=1e-12), "both fingers are at one height"


def test_a_marker_is_taken_across() -> None:
    item = lying(0.7, 0.1, 0.4)
    for pose in grasps(MARKER, item, SHOULDER, DEPTH):
        assert abs(pose.axes[:, 0] @ item.axes[:, 0]) == pytest.approx(0.0, abs=1e-9)


def test_a_bowl_is_taken_at_its_rim() -> None:
    item = lying(0.7, 0.1, 0.4)
    for pose in grasps(BOWL, item, SHOULDER, DEPTH):
        out = pose.place[:2] - item.place[:2]
        assert np.linalg.norm(out) == pytest.approx(0.062)
        assert abs(out @ pose.axes[:2, 0]) == pytest.approx(0.062), "one finger is inside"


def test_a_cup_on_its_side_is_not_taken_as_if_it_stood() -> None:
    fallen = Pose(np.array([0.7, 0.1, 0.78]), np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]))
    assert not list(grasps(CUP, fallen, SHOULDER, DEPTH))


def test_the_first_grasps_are_straight_from_above() -> None:
    first = itertools.islice(grasps(CUP, lying(0.7, 0.1, 0.0), SHOULDER, DEPTH), 8)
    assert all(pose.axes[:, 2] == pytest.approx([0.0, 0.0, -1.0]) for pose in first)


def test_a_giving_hand_leaves_the_person_room() -> None:
    base, forward, head = np.array([0.0, 0.0, 0.93]), np.array([1.0, 0.0]), np.array([1.2, 0.0, 1.6])
    places = np.array([pose.place for pose in giving(base, forward, head, 1.0)])
    assert (head[0] - places[:, 0]).min() == pytest.approx(PERSON_ROOM)
    assert (places[:, 1] > 0).all(), "the left arm gives on its side"
