"""The time of a live interaction, in seconds since it began."""

from __future__ import annotations

import time as machine
from threading import Event
from typing import Protocol


class Clock(Protocol):
    """A clock that can be waited on."""

    def now(self) -> float:
        """Return the time (s) since the interaction began."""
        ...

    def wait_until(self, time: float, wake: Event) -> None:
        """Return when it is `time` (s) or when `wake` is set, whichever comes first."""
        ...


class RealClock:
    """The machine's own clock, which never goes back; when it is made it shows `time` (s)."""

    def __init__(self, time: float = 0.0) -> None:
        self._begun = machine.monotonic() - time

    def now(self) -> float:
        """Return the time (s) since the clock showed 0."""
        return machine.monotonic() - self._begun

    def wait_until(self, time: float, wake: Event) -> None:
        """Sleep until `time` (s) or until `wake` is set."""
        wake.wait(max(0.0, time - self.now()))
