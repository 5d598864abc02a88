"""What a page sent before it left is taken, though the server noticed first that it cannot be told any more."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from fetch_pomdp.adapters.web.page_connection import ConnectionLimits, PageConnection


class Gone:
    """The socket of a page that has left: nothing can be sent, and two messages are still to be read."""

    def __init__(self) -> None:
        self._left = [{"text": "one"}, {"text": "withdraw"}]
        self._failed = asyncio.Event()

    async def send_text(self, _: str) -> None:
        self._failed.set()
        raise RuntimeError("closed")

    async def receive(self) -> dict[str, Any]:
        await self._failed.wait()  # the send fails first
        await asyncio.sleep(0)
        return {"type": "websocket.receive", **self._left.pop(0)} if self._left else {"type": "websocket.disconnect"}


class Listener:
    """A session that notes what it takes, in order."""

    name = "listener"

    def __init__(self) -> None:
        self.heard = list[str | bytes]()
        self._ended: Callable[[], None] = lambda: None

    def start(self, ended: Callable[[], None]) -> None:
        self._ended = ended

    def receive(self, message: str | bytes) -> None:
        self.heard.append(message)

    def close(self) -> None:
        self.heard.append("closed")
        self._ended()


def test_the_last_messages_of_a_page_that_is_gone_are_taken() -> None:
    session, gone = Listener(), Gone()

    async def connected() -> None:
        socket: Any = gone
        connection = PageConnection(socket, None, ConnectionLimits())
        connection.queue.put({"type": "belief"})
        await connection.run(session)

    asyncio.run(connected())
    assert session.heard == ["one", "withdraw", "closed"]
