"""The world's clock beside the wall's."""

from __future__ import annotations

import time

from fetch_pomdp.adapters.robot.mujoco.world import World

BEHIND = 0.25  # s, from which on what was lost is not caught up


class WallClock:
    """Waits, after a step of the world, until as much time has passed outside as inside."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._offset = time.monotonic() - world.time

    def __call__(self) -> None:
        """Wait; begin anew after a pause in which the world stood still."""
        early = self._world.time + self._offset - time.monotonic()
        if early > 0.0:
            time.sleep(early)
        elif early < -BEHIND:
            self._offset = time.monotonic() - self._world.time
