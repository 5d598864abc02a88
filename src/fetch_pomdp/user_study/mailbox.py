"""The messages of a participant's page, waiting for the thread that runs the participant's session.

Choice: a withdrawal counts whatever else is going on: also if the page left right after it, and if too many messages
came before it.
"""

from __future__ import annotations

import queue
import time
from typing import Any

from fetch_pomdp.adapters.web.server_messages import Send, error_message
from fetch_pomdp.errors import MessageError
from fetch_pomdp.user_study.messages import Withdraw

MOST = 1_000  # unread messages


class LeftError(Exception):
    """The page has left; its person may come back."""


class WithdrawnError(Exception):
    """The person has withdrawn."""


class BrokenError(Exception):
    """The trial cannot go on, through no fault of the person."""


class Mailbox:
    """Messages in order. send: gets an error for each message that is not expected.

    withdrawn: whether the person has withdrawn.
    """

    def __init__(self, send: Send) -> None:
        self._send = send
        self._waiting: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._closed = False
        self.withdrawn = False

    def put(self, message: Any) -> None:
        """Add a message of the page, from any thread. Raises MessageError if too many are waiting."""
        self.withdrawn = self.withdrawn or isinstance(message, Withdraw)
        if self._waiting.qsize() > MOST and not self.withdrawn:
            raise MessageError(f"too many messages at once (more than {MOST} are waiting)")
        self._waiting.put(message)

    def post(self, message: Any) -> None:
        """Add a message of the server's own, from any thread; `expect` raises one that is an exception."""
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
        self._send(error_message(MessageError(found, field="type")))
