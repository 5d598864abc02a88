"""A film of the robot's world, as it is simulated."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from fetch_pomdp.adapters.robot.mujoco.model import EXTRA, VISIBLE_GROUP
from fetch_pomdp.adapters.robot.mujoco.world import World
from fetch_pomdp.errors import InputError
from fetch_pomdp.extras import load

SIZE = (640, 480)
FPS = 20  # pictures a second of the world's clock
AZIMUTH, ELEVATION, DISTANCE = 145.0, -22.0, 2.6  # degrees from the robot's forward, degrees, m
LIBRARIES = "expected OpenGL: apt install libegl1 libegl-mesa0, or libosmesa6 and MUJOCO_GL=osmesa"


def choose_graphics() -> None:
    """Have MuJoCo draw without a screen where there is none. To be called before MuJoCo is loaded."""
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        os.environ.setdefault("MUJOCO_GL", "egl")


class Film:
    """Writes a picture whenever it is due; to be called after each step of the world, and closed.

    Raises InputError for a path that cannot be written, or without OpenGL.
    """

    def __init__(self, world: World, path: Path) -> None:
        mujoco, writer = load("mujoco", EXTRA), load("imageio_ffmpeg", EXTRA)
        if not path.parent.is_dir():
            raise InputError(
                "found no such folder, expected one that is there", field="--video", source=str(path.parent)
            )
        self._world, self._due = world, world.time
        try:
            self._renderer: Any = mujoco.Renderer(world.model, SIZE[1], SIZE[0])
        except Exception as cause:
            raise InputError(f"cannot draw ({cause}), {LIBRARIES}", field="--video") from None
        self._camera, self._options = mujoco.MjvCamera(), mujoco.MjvOption()
        x, y, top = world.layout.table
        self._camera.lookat[:] = [x, y, top + 0.2]
        self._camera.distance, self._camera.elevation = DISTANCE, ELEVATION
        self._camera.azimuth = AZIMUTH + np.degrees(world.layout.yaw)
        self._options.geomgroup[:] = 0
        self._options.geomgroup[VISIBLE_GROUP] = 1
        self._options.sitegroup[:] = 0
        self._frames = writer.write_frames(str(path), SIZE, fps=FPS, macro_block_size=8, ffmpeg_log_level="error")
        self._frames.send(None)

    def __call__(self) -> None:
        """Draw and write a picture if it is time."""
        if self._world.time < self._due:
            return
        self._due += 1.0 / FPS
        self._renderer.update_scene(self._world.data, self._camera, self._options)
        self._frames.send(np.ascontiguousarray(self._renderer.render()))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the film."""
        self._frames.close()
        self._renderer.close()
