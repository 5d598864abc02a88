"""Which sensors do what they should."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock

from fetch_pomdp.core.live.inbox import Inbox
from fetch_pomdp.core.live.updates import SensorState, SensorStatus

SILENT = 2.0  # s without a sign of life
LOST = 10.0  # s
TEXTS = {
    SensorState.OK: "{name}: works again",
    SensorState.SILENT: "{name}: nothing has come for a moment",
    SensorState.SLOW: "{name}: too slow, going on without it",
    SensorState.LOST: "{name}: lost, going on without it",
}


class SensorMonitor:
    """The states of the sensors of an inbox, of the robot and of the model; tells what changes."""

    def __init__(self, inbox: Inbox, tell: Callable[[SensorStatus], None]) -> None:
        self._inbox, self._tell, self._lock = inbox, tell, Lock()
        self._states: dict[str, SensorState] = {}

    def report(self, name: str, state: SensorState) -> None:
        """Tell how something does, if that has changed."""
        with self._lock:
            changed = self._states.get(name, SensorState.OK) is not state
            self._states[name] = state
        if changed:
            self._tell(SensorStatus(name, state, TEXTS[state].format(name=name)))

    def examine(self, now: float) -> None:
        """Tell which sensors have given no sign of life for too long, or give them again."""
        for name, last in self._inbox.signs_of_life().items():
            missed = SensorState.LOST if now - last >= LOST else SensorState.SILENT if now - last >= SILENT else None
            if missed or self._states.get(name) is not SensorState.SLOW:
                self.report(name, missed or SensorState.OK)

    def next_examination(self, now: float) -> float:
        """Return when (s) a sensor's state changes if it gives no further sign of life; infinite if none does."""
        ends = (last + limit for last in self._inbox.signs_of_life().values() for limit in (SILENT, LOST))
        return min((end for end in ends if end > now), default=float("inf"))
