"""Robots as description files name them."""

from __future__ import annotations

from pathlib import Path

import pytest

from fetch_pomdp.adapters.robot.mujoco.description import HERE, KNOWN, RobotDescription
from fetch_pomdp.errors import MissingExtraError, RobotDescriptionError


def changed(tmp_path: Path, old: str, new: str) -> Path:
    """A file of Baxter's with one thing changed."""
    text = (HERE / "baxter.toml").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return path


def test_two_robots_come_with_the_package() -> None:
    assert sorted(path.stem for path in HERE.glob("*.toml")) == sorted(KNOWN)
    assert [arm.name for arm in RobotDescription.load("baxter").arms] == ["right", "left"]
    assert len(RobotDescription.load("ur5e").arms[0].joints) == 6


def test_a_file_of_ones_own_is_read(tmp_path: Path) -> None:
    path = changed(tmp_path, "speed = 1.0", "speed = 0.4")
    assert RobotDescription.load(path).speed == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("speed = 1.0", 'speed = "fast"', r"mine.toml:\d+: speed: found 'fast', expected a finite number"),
        ("height = 0.93", "hight = 0.93", r"mine.toml:\d+: hight: unknown field, .*did you mean 'height'"),
        (
            "home = [0.08, -1.0",
            "home = [-1.0",
            r"mine.toml:\d+: arms\[0\].home: found 6 numbers, expected one a joint, 7",
        ),
        (
            'joint = "l_finger_joint"',
            "",
            r"mine.toml:\d+: gripper.drives\[0\].joint: expected either a joint or a tendon",
        ),
        (
            "tcp = [0.0, 0.0, 0.113]",
            "tcp = [0.113]",
            r"mine.toml:\d+: gripper.tcp: found \[0.113\], expected \[x, y, z\]",
        ),
        ("point = 1.86", "", r"mine.toml:\d+: durations.point: found no such field"),
    ],
)
def test_what_is_wrong_with_a_file_is_one_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(RobotDescriptionError, match=message):
        RobotDescription.load(changed(tmp_path, old, new))


def test_a_misspelt_robot_is_answered_with_the_one_that_was_meant() -> None:
    with pytest.raises(
        RobotDescriptionError, match="expected one of baxter, ur5e, or a TOML file, did you mean 'baxter'"
    ):
        RobotDescription.load("bakster")


def test_a_package_that_is_not_there_says_what_installs_it(tmp_path: Path) -> None:
    robot = RobotDescription.load(changed(tmp_path, 'package = "robosuite"', 'package = "no_such_package"'))
    with pytest.raises(MissingExtraError, match=r'pip install --no-deps "robosuite==1.5.2"'):
        robot.file(robot.model)
