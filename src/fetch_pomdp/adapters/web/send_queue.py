"""What a page has not been told yet."""

from __future__ import annotations

import asyncio
from collections import deque
from threading import Lock

from fetch_pomdp.adapters.web.tell import Told

MOST_WAITING = 1_000  # messages; a page that has fallen so far behind is let go, and may come back


class Outbox:
    """Messages from any thread to one page.

    A belief replaces the one before it that was not sent yet: a slow page is told fewer of them, and of every event.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop, self._came, self._lock = loop, asyncio.Event(), Lock()
        self._waiting: deque[Told] = deque()

    def put(self, told: Told) -> None:
        """Leave a message; nothing is kept for a page that is gone."""
        with self._lock:
            if told["type"] == "belief" and self._waiting and self._waiting[-1]["type"] == "belief":
                self._waiting.pop()
            self._waiting.append(told)
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._came.set)

    @property
    def overfull(self) -> bool:
        """Whether the page has fallen too far behind."""
        return len(self._waiting) > MOST_WAITING

    async def take(self) -> list[Told]:
        """Wait for messages and take all there are."""
        await self._came.wait()
        self._came.clear()
        with self._lock:
            taken = list(self._waiting)
            self._waiting.clear()
        return taken
