"""How an arm runs along a path, and brakes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.adapters.robot.mujoco.trajectory import Place, Trajectory, braked, held, trajectory

CORNER = np.array([[0.0, 0.0], [1.0, 0.5], [1.0, 0.5], [1.0, -1.5]])


def run(path: list[list[float]], speed: float) -> Trajectory:
    way = trajectory(np.array(path), speed)
    assert way is not None
    return way


def test_a_path_is_as_long_as_its_fastest_joints_turn() -> None:
    way = trajectory(CORNER, 1.0)
    assert way is not None
    assert way.length == pytest.approx(1.0 + 2.0)
    assert len(way.path) == 3, "a point that is there twice counts once"


def test_a_path_that_leads_nowhere_is_none() -> None:
    assert trajectory(np.zeros((4, 2)), 1.0) is None


@given(st.floats(0.01, 6.0), st.floats(0.1, 2.0))
def test_it_keeps_its_speed_and_ends_at_rest(length: float, speed: float) -> None:
    way = run([[0.0], [length]], speed)
    times = np.linspace(0.0, way.duration, 3000)
    places = [way.along(float(time)) for time in times]
    speeds = np.array([place.speed for place in places])
    assert speeds.max() <= speed + 1e-9
    assert places[0].speed == pytest.approx(0.0)
    assert places[-1].speed == pytest.approx(0.0, abs=1e-9)
    assert places[-1].along == pytest.approx(length)
    assert np.trapezoid(speeds, times) == pytest.approx(length, rel=1e-3), "speed is the place's change"


def test_a_short_way_is_sped_up_and_slowed_down_at_once() -> None:
    way = run([[0.0], [0.04]], 1.0)
    assert way.duration == pytest.approx(2 * (0.04 / 4.0) ** 0.5)  # half the way at 4 rad/s^2
    assert way.along(way.duration / 2).speed == pytest.approx(4.0 * way.duration / 2)


def test_joints_move_along_the_pieces_of_the_path() -> None:
    way = trajectory(CORNER, 1.0)
    assert way is not None
    target = way.at(Place(2.0, 0.5, -1.0))
    assert target.angles == pytest.approx([1.0, -0.5])
    assert target.velocities == pytest.approx([0.0, -0.5])
    assert target.accelerations == pytest.approx([0.0, 1.0])


def test_braking_ends_within_a_tenth_of_a_second() -> None:
    begun = Place(0.7, 1.0, 0.0)
    assert braked(begun, 0.05).along == pytest.approx(0.7 + 0.05 - 0.0125)
    assert braked(begun, 0.05).speed == pytest.approx(0.5)
    assert braked(begun, 0.05).acceleration == -10.0
    assert braked(begun, 0.1).speed == pytest.approx(0.0)
    assert braked(begun, 3.0).along == pytest.approx(0.75)
    assert braked(begun, 3.0).acceleration == 0.0


def test_what_is_held_does_not_move() -> None:
    target = held(np.array([1.0, 2.0]))
    assert target.angles == pytest.approx([1.0, 2.0])
    assert not target.velocities.any()
    assert not target.accelerations.any()
