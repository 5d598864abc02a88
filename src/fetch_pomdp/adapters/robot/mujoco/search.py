"""The search for a plan: how long it may go on, what came in the way, and why there is none."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable

from fetch_pomdp.adapters.robot.mujoco.collisions import ITSELF
from fetch_pomdp.adapters.robot.mujoco.model import TABLE

SEARCH = 1.5  # s, in which a plan is looked for
COULD_NOT_REACH = "could not reach"
NO_WAY = "found no way"
STRETCHED = "its own reach"  # on the straight way from an item that it reaches


class CannotError(Exception):
    """There is no plan, or it did not work out; `reason` as a person reads it."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class StoppedError(Exception):
    """Somebody stopped the robot."""


class Search:
    """What came in the way of the plans that were tried, and for how long they are."""

    def __init__(self, stopped: Callable[[], bool]) -> None:
        self._stopped, self._until = stopped, time.monotonic() + SEARCH
        self._culprits: Counter[str] = Counter()
        self.reached = False

    def over(self) -> bool:
        """Return whether the time is up. Raises StoppedError where somebody stopped the robot."""
        if self._stopped():
            raise StoppedError
        return time.monotonic() > self._until

    def blocked(self, culprit: str) -> None:
        """Count what was in the way of one plan."""
        self._culprits[culprit] += 1

    def reason(self) -> str:
        """Return why nothing was found: what was in the way most often, if the place could be reached at all."""
        if not self.reached:
            return COULD_NOT_REACH
        culprits = [culprit for culprit, _ in self._culprits.most_common()]
        named = [culprit for culprit in culprits if culprit not in {ITSELF, TABLE, NO_WAY, STRETCHED}]
        if named:
            return blocked_by(named[0])
        return NO_WAY if NO_WAY in culprits else COULD_NOT_REACH


def blocked_by(culprit: str) -> str:
    """Return the reason of a plan that something is in the way of; the robot itself and the table are out of reach."""
    return COULD_NOT_REACH if culprit in {ITSELF, TABLE} else f"blocked by {culprit}"
