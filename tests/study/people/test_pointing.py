from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import default_rng

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.ports import Frame
from fetch_pomdp.study.people.pointing import REST, PointingGesture, directions, drift, frames, item_at

from .plain import AMBIGUOUS, within

HEAD, TARGET = (0.0, 0.0, 1.6), (0.075, 3.2, 0.75)
AIM = np.subtract(TARGET, HEAD) / math.dist(TARGET, HEAD)


def episode(**changes: Any) -> PointingGesture:
    usual = {"start": 1.0, "rise": 0.3, "held": 1.0, "bias": (0.0, 0.0), "jitter": 0.0, "jitter_time": 0.3}
    return PointingGesture(**{**usual, **changes})


def drawn(seed: int = 0, **changes: Any) -> list[Frame]:
    return frames(episode(**changes), HEAD, TARGET, 0.65, default_rng(seed))


def arm(frame: Frame) -> Vector:
    return np.subtract(frame.wrists[0], frame.head)


def test_there_are_frames_only_while_the_arm_is_up_at_the_ticks_of_the_tracker() -> None:
    times = [frame.time * 30 for frame in drawn(start=1.01, held=1.0)]  # until 2.61
    assert times == pytest.approx(range(31, 79))


def test_an_arm_rises_is_held_and_falls() -> None:
    found = drawn()
    aims = [float(arm(frame) @ AIM / np.linalg.norm(arm(frame))) for frame in found]
    held = [aim for frame, aim in zip(found, aims, strict=True) if 1.3 <= frame.time <= 2.3]
    assert held == pytest.approx([1.0] * len(held))
    assert len(held) == 31
    way = [aim for frame, aim in zip(found, aims, strict=True) if frame.time < 1.3]
    assert way == sorted(way)
    assert arm(found[0]) == pytest.approx(0.65 * np.array(REST))
    assert arm(found[-1]) == pytest.approx(0.65 * np.array(REST))
    halfway = next(frame for frame in drawn(rise=2.0) if frame.time == pytest.approx(2.0))
    assert arm(halfway) == pytest.approx(0.65 * (AIM + np.array(REST)) / 2)


def test_an_arm_without_a_way_to_go_points_at_once() -> None:
    found = drawn(rise=0.0)
    assert len(found) == 31
    assert all(arm(frame) == pytest.approx(0.65 * AIM) for frame in found)


@given(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6))
def test_an_offset_is_that_far_off_to_the_right_and_up(right: float, up: float) -> None:
    found = directions(np.array((0.0, 1.0, 0.0)), np.array([(right, up)]))[0]
    angle = math.hypot(right, up)
    assert np.linalg.norm(found) == pytest.approx(1.0)
    assert found[1] == pytest.approx(math.cos(angle))
    assert found[0] * up == pytest.approx(found[2] * right, abs=1e-12)
    assert found[0] * right >= 0.0
    assert found[2] * up >= 0.0


def test_straight_down_has_a_right_too() -> None:
    found = directions(np.array((0.0, 0.0, -1.0)), np.array([(0.1, 0.0)]))[0]
    assert found == pytest.approx((math.sin(0.1), 0.0, -math.cos(0.1)))


def test_a_bias_is_in_every_frame() -> None:
    held = [frame for frame in drawn(bias=(0.05, -0.02)) if 1.3 <= frame.time <= 2.3]
    expected = directions(AIM, np.array([(0.05, -0.02)]))[0]
    assert all(arm(frame) / 0.65 == pytest.approx(expected) for frame in held)


def test_drift_has_its_size_and_correlation_from_its_first_frame_on() -> None:
    rng, count, lag = default_rng(8), 3000, 6  # 6 frames are 0.2 s
    series = np.array([drift(20, 0.04, 0.2, rng) for _ in range(count)])
    for axis in (0, 1):
        for time in (0, 19):
            assert within(np.square(series[:, time, axis]).mean(), 0.04**2, 0.04**2 * math.sqrt(2), count)
        products = series[:, 3, axis] * series[:, 3 + lag, axis]
        assert within(products.mean(), 0.04**2 * math.exp(-1.0), products.std(), count)
    assert within((series[:, 0, 0] * series[:, 0, 1]).mean(), 0.0, 0.04**2, count)


def test_frames_are_jittered_by_the_drift() -> None:
    rng, count = default_rng(2), 1500
    offs = []
    for _ in range(count):
        middle = frames(episode(jitter=0.03, held=0.1, rise=0.0), HEAD, TARGET, 0.65, rng)[1]
        offs.append(math.acos(min(1.0, float(arm(middle) @ AIM) / 0.65)))
    # Two axes: the square of the angle is exponential with mean 2 * 0.03 ** 2.
    assert within(float(np.square(offs).mean()), 2 * 0.03**2, 2 * 0.03**2, count)


def test_a_pointing_robot_is_read_as_the_item_nearest_in_direction() -> None:
    # Neighbours in the line are 0.15 m apart at 3.31 m: half of it is 0.0226 rad.
    items = AMBIGUOUS.items
    for right, index in ((0.0, 3), (0.021, 3), (0.024, 4), (-0.021, 3), (-0.024, 2), (0.5, 5)):
        assert item_at(HEAD, items[3], (right, 0.0), items) is items[index], right
