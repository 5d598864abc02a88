"""A whole interaction with a body: `fetch --robot`, its film, and the example of the page. Needs the extra robot."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from fetch_pomdp.adapters.robot.mujoco.film import Film, choose_graphics
from fetch_pomdp.errors import InputError
from tests.adapters.robot.test_robot import MARKER, Stage, pytestmark  # noqa: F401

PAGE = Path(__file__).parents[3] / "docs" / "robot.md"


def test_a_person_at_the_keyboard_is_given_what_they_want() -> None:
    typed = "hand me the marker @marker-1\nyes\n"
    command = [sys.executable, "-m", "fetch_pomdp", "fetch", "ambiguous", "--robot", "ur5e"]
    done = subprocess.run(command, input=typed, capture_output=True, text=True, check=True)
    assert "robot: This one?" in done.stdout
    assert "robot: Here you are." in done.stdout
    assert "picks marker-1" in done.stdout


def test_the_example_of_the_page_runs() -> None:
    (example,) = re.findall(r"```py\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    done = subprocess.run([sys.executable, "-c", example], capture_output=True, text=True, check=True)
    assert "marker-1" in done.stdout


@pytest.mark.skipif(not find_spec("imageio_ffmpeg"), reason="needs imageio-ffmpeg")
def test_a_film_has_a_picture_for_each_twentieth_of_a_second(tmp_path: Path) -> None:
    import imageio_ffmpeg

    choose_graphics()
    stage = Stage()
    path = tmp_path / "out.mp4"
    begun = stage.world.time
    try:
        film = Film(stage.world, path)
    except InputError as error:
        pytest.skip(str(error))
    with film:
        stage.each_step = film
        stage.robot.point(MARKER)
    frames, _ = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert frames == pytest.approx(20 * (stage.world.time - begun), abs=2)


def test_a_film_in_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--video: found no such folder, expected one that is there"):
        Film(Stage().world, tmp_path / "none" / "out.mp4")
