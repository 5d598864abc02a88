"""The options --robot and --video, as far as they go without MuJoCo; with it: tests/adapters/robot."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from fetch_pomdp.adapters.robot.mujoco.description import RobotDescription
from fetch_pomdp.cli.robot import timing_of, with_robot
from fetch_pomdp.study.design import Study
from tests.cli.conftest import Run


def test_a_film_needs_a_body(run: Run, tmp_path: Path) -> None:
    code, _, error = run("fetch", "ambiguous", "--video", tmp_path / "out.mp4")
    assert code == 2
    assert "--video: a film needs a body; add --robot baxter" in error


def test_a_misspelt_robot_is_answered_with_the_one_that_was_meant(run: Run) -> None:
    code, _, error = run("fetch", "ambiguous", "--robot", "ur5")
    assert code == 2
    assert "ur5: found no such robot, expected one of baxter, ur5e, or a TOML file, did you mean 'ur5e'" in error


def test_without_mujoco_the_line_that_installs_it_is_said(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    code, _, error = run("fetch", "ambiguous", "--robot", "baxter")
    assert code == 2
    assert 'mujoco is not installed; install it with: pip install "fetch-pomdp[robot]"' in error


def test_a_study_takes_the_time_of_a_robot_and_prices_a_question_by_it() -> None:
    study = with_robot(Study(), "baxter")
    arm = RobotDescription.load("baxter").durations.point
    assert (study.clock.arm, study.clock.speak) == (arm, 0.8)
    question = 0.1 + arm + 0.8 + 0.1 + 1.0  # s: think, point, "this one?", think, listen
    wait = 0.1 + 0.5815
    for scene in study.layouts.values():
        assert scene.rewards.point == pytest.approx(-question / wait)
        assert scene.rewards.wait == -1.0


def test_a_question_lasts_as_long_as_the_robot_takes_to_ask_it() -> None:
    timing = timing_of("ur5e")
    assert timing.question - timing.listen == pytest.approx(RobotDescription.load("ur5e").durations.point + 0.8)
