"""The arithmetic of pointing with an arm (calibration.js), run by a JavaScript engine, against NumPy."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import playwright
import pytest
from numpy.typing import NDArray

import fetch_pomdp.adapters.web

MODULE = Path(fetch_pomdp.adapters.web.__file__).parent / "page" / "calibration.js"
ENGINE = Path(playwright.__file__).parent / "driver" / "node"
MARKS = np.array([[x, y] for y in (-0.3, 0.4) for x in (-0.8, 0.0, 0.8)])
SLOPE, OFFSET = np.array([[1.3, -0.2], [0.1, 1.6]]), np.array([0.2, -0.9])
Array = NDArray[np.float64]


def js(expression: str, data: Any = None) -> Any:
    """The value of an expression in which `c` is the module and `data` is data."""
    source = (
        f"import * as c from {json.dumps(MODULE.as_uri())}; const data = {json.dumps(data)}; "
        f"console.log(JSON.stringify({expression}));"
    )
    command = [str(ENGINE), "--input-type=module", "--no-warnings", "-e", source]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout)


def samples(hands: Array, places: Array = MARKS) -> list[dict[str, Any]]:
    return [{"hand": hand, "place": place} for hand, place in zip(hands.tolist(), places.tolist(), strict=True)]


def hands_of(places: Array) -> Array:
    """Where the hand is seen when a place is pointed at, if the map is affine."""
    return np.asarray((places - OFFSET) @ np.linalg.inv(SLOPE).T)


def noisy(seed: int, spread: float) -> Array:
    return hands_of(MARKS) + np.random.default_rng(seed).normal(0.0, spread, MARKS.shape)


def affine(hands: Array, places: Array) -> tuple[Array, Array]:
    """Ridge regression with a free offset: the offset and slope of the least squares with two more rows."""
    centre = hands.mean(axis=0)
    left = np.vstack([np.column_stack([np.ones(len(hands)), hands - centre]), np.diag([0, 1e-3**0.5, 1e-3**0.5])[1:]])
    weights = np.linalg.lstsq(left, np.vstack([places, np.zeros((2, 2))]), rcond=None)[0]
    return weights[0] - centre @ weights[1:], weights[1:]


def test_an_affine_arm_is_found() -> None:
    elsewhere = np.array([[0.35, 0.1], [-0.6, 0.2]])
    found = js("data[1].map(c.fit(data[0]))", [samples(hands_of(MARKS)), hands_of(elsewhere).tolist()])
    assert np.allclose(found, elsewhere, atol=0.005)


def test_the_fit_is_the_ridge_regression() -> None:
    hands, probe = noisy(3, 0.1), np.array([[0.2, -0.4], [-1.0, 1.0]])
    offset, slope = affine(hands, MARKS)
    found = js("data[1].map(c.fit(data[0]))", [samples(hands), probe.tolist()])
    assert np.allclose(found, offset + probe @ slope, atol=1e-9)


def test_an_error_is_that_of_marks_that_were_not_seen() -> None:
    hands = noisy(5, 0.08)
    off, guessed = [], []
    for index in range(len(MARKS)):
        rest = np.arange(len(MARKS)) != index
        offset, slope = affine(hands[rest], MARKS[rest])
        off.append(offset + hands[index] @ slope - MARKS[index])
        guessed.append(MARKS[rest].mean(axis=0) - MARKS[index])
    flat = "c.judge(data, ([x, y], index) => Math.hypot(x - data[index].place[0], y - data[index].place[1]))"
    found = js(flat, samples(hands))
    assert found["error"] == pytest.approx(np.sqrt(np.mean(np.sum(np.square(off), axis=1))), rel=1e-9)
    assert found["guess"] == pytest.approx(np.sqrt(np.mean(np.sum(np.square(guessed), axis=1))), rel=1e-9)


def test_an_error_tells_what_new_gestures_will_be_off_by() -> None:
    """Over 200 calibrations: stated error against that of the same map at 50 new gestures, root mean squares."""
    stated, true = [], []
    rng = np.random.default_rng(7)
    calibrations = [samples(noisy(seed, 0.1)) for seed in range(200)]
    flat = "([x, y], index) => Math.hypot(x - each[index].place[0], y - each[index].place[1])"
    places = rng.uniform([-0.8, -0.3], [0.8, 0.4], (50, 2))
    probes = hands_of(places) + rng.normal(0.0, 0.1, places.shape)
    found = js(
        f"data[0].map((each) => [c.judge(each, {flat}).error, data[1].map(c.fit(each))])",
        [calibrations, probes.tolist()],
    )
    for error, guesses in found:
        stated.append(error**2)
        true.append(np.mean(np.sum((np.array(guesses) - places) ** 2, axis=1)))
    # A corner that is left out is judged from farther away than most of the table: the statement is on the safe side.
    assert 1.0 < np.sqrt(np.mean(stated) / np.mean(true)) < 1.5


@pytest.mark.parametrize(
    ("error", "guess", "expected"),
    [
        (0.123, 0.9, 0.12),
        (0.004, 0.9, 0.02),
        (0.3, 0.9, 0.3),
        (0.301, 0.9, None),
        (0.08, 0.1, None),  # no better than the middle of the marks
        (float("nan"), 0.9, None),
    ],
)
def test_a_coarse_arm_has_no_sigma(error: float, guess: float, expected: float | None) -> None:
    number = "NaN" if np.isnan(error) else error
    assert js(f"c.sigma({{ error: {number}, guess: {guess} }})") == expected


def joints(left: tuple[float, float], right: tuple[float, float], **unseen: bool) -> list[dict[str, float]]:
    """A person in a picture twice as wide as high: shoulders 0.2 heights wide, hands at places in heights."""
    at = {2: (1.02, 0.2), 5: (0.98, 0.2), 11: (1.1, 0.4), 12: (0.9, 0.4)}
    at |= {15: left, 19: left, 16: right, 20: right}
    found = [{"x": 0.0, "y": 0.0, "visibility": 0.0} for _ in range(33)]
    for index, (x, y) in at.items():
        found[index] = {"x": x / 2, "y": y, "visibility": 0.1 if f"joint_{index}" in unseen else 0.9}
    return found


DOWN_LEFT, DOWN_RIGHT, UP = (1.15, 0.75), (0.85, 0.75), (0.94, 0.45)


def test_which_arm_is_up_and_where_its_hand_is() -> None:
    seen = js("c.arms(data, 2)", joints(DOWN_LEFT, UP))
    assert (seen["person"], seen["raised"]) == (True, ["right"])
    assert np.allclose(seen["hands"]["right"], [(0.94 - 1.0) / 0.2, (0.45 - 0.2) / 0.2])
    assert js("c.arms(data, 2).raised", joints(DOWN_LEFT, DOWN_RIGHT)) == []
    assert js("c.arms(data, 2).raised", joints(UP, UP)) == ["left", "right"]
    # A hand 0.9 shoulder widths (0.18) below the shoulders rests.
    assert js("c.arms(data, 2).raised", joints(DOWN_LEFT, (0.9, 0.57))) == ["right"]
    assert js("c.arms(data, 2).raised", joints(DOWN_LEFT, (0.9, 0.59))) == []


def test_a_person_who_is_not_seen_points_at_nothing() -> None:
    nobody = {"person": False, "raised": [], "hands": {}}
    assert js("c.arms(null, 2)") == nobody
    assert js("c.arms(data, 2)", joints(DOWN_LEFT, UP, joint_11=True)) == nobody
    assert js("c.arms(data, 2)", joints(DOWN_LEFT, UP, joint_2=True)) == nobody
    assert js("c.arms(data, 2).raised", joints(DOWN_LEFT, UP, joint_16=True)) == []


def test_a_hand_is_where_it_is_however_near_the_person_sits() -> None:
    one = joints(DOWN_LEFT, UP)
    other = [{**joint, "x": 0.3 + 0.6 * joint["x"], "y": 0.1 + 0.6 * joint["y"]} for joint in one]
    found = js("data.map((each) => c.arms(each, 2).hands.right)", [one, other])
    assert np.allclose(found[0], found[1])


def taken(moments: Sequence[tuple[float, list[float] | None]]) -> list[tuple[float, list[float]]]:
    """When a hand was taken, and where, if it is seen at these moments (ms)."""
    take = "data.map(([t, hand]) => [t, still.take(t, hand)]).filter(([, place]) => place)"
    expression = f"(() => {{ const still = new c.Stillness(); return {take}; }})()"
    return [tuple(each) for each in js(expression, moments)]


def test_a_hand_is_taken_when_it_has_been_still_for_a_second() -> None:
    trembling = [(100.0 * step, [0.5 + 0.04 * (-1) ** step, 0.2]) for step in range(30)]
    assert [time for time, _ in taken(trembling)] == [1000.0]  # and not again at the same place
    ((_, place),) = taken(trembling)
    assert place == pytest.approx([0.54, 0.2])  # six of the eleven pictures
    moving = [(100.0 * step, [0.05 * step, 0.2]) for step in range(30)]
    assert taken(moving) == []


def test_the_same_place_is_taken_again_after_the_arm_was_down_or_elsewhere() -> None:
    still = [(100.0 * step, [0.5, 0.2]) for step in range(12)]
    again = [(time + 1300.0, hand) for time, hand in still]
    assert len(taken([*still, *again])) == 1
    assert len(taken([*still, (1200.0, None), *again])) == 2
    assert [place for _, place in taken([*still, *[(time, [0.75, 0.2]) for time, _ in again]])] == [
        [0.5, 0.2],
        [0.75, 0.2],
    ]


def test_a_slow_camera_takes_longer() -> None:
    assert [time for time, _ in taken([(700.0 * step, [0.5, 0.2]) for step in range(6)])] == [2100.0]


def test_two_pictures_are_too_few_to_know_that_a_hand_is_still() -> None:
    assert taken([(0.0, [0.5, 0.2]), (600.0, [0.5, 0.2]), (1200.0, [0.5, 0.2])]) == []
