"""What a slow listener has not been told yet."""

from __future__ import annotations

from collections import deque
from threading import Condition

from fetch_pomdp.core.live.updates import BeliefChanged, Update


class Outbox:
    """A listener that only keeps, for another thread to take. Safe to use from any thread.

    A belief replaces one that nobody has taken, if nothing came between: a slow listener is told fewer of them, and
    every event. So it holds at most twice as many updates as there were events, two or three a second.
    """

    def __init__(self) -> None:
        self._updates: deque[Update] = deque()
        self._came = Condition()

    def __call__(self, update: Update) -> None:
        """Keep an update."""
        with self._came:
            if isinstance(update, BeliefChanged) and self._updates and isinstance(self._updates[-1], BeliefChanged):
                self._updates.pop()
            self._updates.append(update)
            self._came.notify_all()

    def take(self, timeout: float | None = None) -> list[Update]:
        """Wait for an update, at most `timeout` s, and take all there are; none after that time."""
        with self._came:
            self._came.wait_for(lambda: bool(self._updates), timeout)
            taken = list(self._updates)
            self._updates.clear()
            return taken
