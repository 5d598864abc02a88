"""Messages of a page, waited for by the thread that leads its person through a study.

Choice: who withdraws does so whatever else is going on: it counts though the page left right after it, and though too
much was sent before it.
"""

from __future__ import annotations

import queue
import time
from collections.abc import Callable
from typing import Any

from fetch_pomdp.adapters.web.participation.messages import Withdraw
from fetch_pomdp.adapters.web.tell import Told, complaint
from fetch_pomdp.errors import MessageError

MOST = 1_000  # messages that were not looked at yet


class LeftError(Exception):
    """The page has left; its person may come back."""


class WithdrawnError(Exception):
    """The person takes part no longer."""


class BrokenError(Exception):
    """What the person was led through cannot go on, by no fault of theirs."""


class Mailbox:
    """Messages in their order. tell: is told of those that nobody expects.

    withdrawn: whether the person has said that they take part no longer.
    """

    def __init__(self, tell: Callable[[Told], None]) -> None:
        self._tell = tell
        self._waiting: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._closed = False
        self.withdrawn = False

    def put(self, message: Any) -> None:
        """Leave a message of the page, from any thread. Raises MessageError when too many are there."""
        self.withdrawn = self.withdrawn or isinstance(message, Withdraw)
        if self._waiting.qsize() > MOST and not self.withdrawn:
            raise MessageError(f"found {MOST} messages waiting, expected fewer")
        self._waiting.put(message)

    def post(self, message: Any) -> None:
        """Leave a message of the server's own, from any thread; an exception is raised where messages are expected."""
        self._waiting.put(message)

    def close(self) -> None:
        """Let whoever waits know that the page has left; from any thread."""
        self._closed = True
        self._waiting.put(None)

    def expect(self, *kinds: type, within: float | None = None) -> Any:
        """Wait for a message of one of some kinds; others are refused. Return None if none comes within some seconds.

        Raises LeftError, WithdrawnError, or what was posted.
        """
        while True:
            try:
                message = self._next(within)
            except queue.Empty:
                return None
            if isinstance(message, kinds):
                return message
            self._refuse(message, kinds)

    def pause(self, seconds: float) -> None:
        """Let some time pass. Raises as `expect`."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                self._refuse(self._next(left), ())
            except queue.Empty:
                return

    def _next(self, timeout: float | None) -> Any:
        message = self._waiting.get(timeout=timeout)
        if self.withdrawn:
            raise WithdrawnError
        if self._closed:
            raise LeftError
        if isinstance(message, Exception):
            raise message
        return message

    def _refuse(self, message: object, kinds: tuple[type, ...]) -> None:
        names = ", ".join(kind.__name__ for kind in kinds) or "nothing"
        found = f"found {type(message).__name__}, expected {names} now"
        self._tell(complaint(MessageError(found, field="type")))
