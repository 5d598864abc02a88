"""Messages that wait to be sent to a page."""

from __future__ import annotations

import asyncio
from collections import deque
from threading import Lock

from fetch_pomdp.adapters.web.server_messages import ServerMessage

MOST_WAITING = 1_000  # messages; a page that falls further behind is disconnected, and may come back


class SendQueue:
    """Messages from any thread to one page.

    A belief replaces an unsent one right before it: a slow page gets fewer beliefs, and every event.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop, self._came, self._lock = loop, asyncio.Event(), Lock()
        self._waiting: deque[ServerMessage] = deque()

    def put(self, message: ServerMessage) -> None:
        """Add a message; for a page that is gone it is dropped."""
        with self._lock:
            if message["type"] == "belief" and self._waiting and self._waiting[-1]["type"] == "belief":
                self._waiting.pop()
            self._waiting.append(message)
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._came.set)

    @property
    def overfull(self) -> bool:
        """Whether the page has fallen too far behind."""
        return len(self._waiting) > MOST_WAITING

    async def take(self) -> list[ServerMessage]:
        """Wait for messages and take all there are."""
        await self._came.wait()
        self._came.clear()
        with self._lock:
            taken = list(self._waiting)
            self._waiting.clear()
        return taken
