"""What a page sent before it left is taken, though the server noticed first that it cannot be told any more."""

from __future__ import annotations

import asyncio
from typing import Any

from fetch_pomdp.adapters.web.outbox import Outbox
from fetch_pomdp.adapters.web.visit import Visit


class Gone:
    """The socket of a page that has left: nothing can be sent, and two messages are still to be read."""

    def __init__(self) -> None:
        self._left = [{"text": "one"}, {"text": "withdraw"}]

    async def send_text(self, _: str) -> None:
        raise RuntimeError("closed")

    async def receive(self) -> dict[str, Any]:
        await asyncio.sleep(0.02)  # the send fails first
        return {"type": "websocket.receive", **self._left.pop(0)} if self._left else {"type": "websocket.disconnect"}


class Listener:
    """A party that notes what it is told, in order."""

    name = "listener"

    def __init__(self) -> None:
        self.heard = list[str | bytes]()

    def start(self) -> None: ...

    def take(self, message: str | bytes) -> None:
        self.heard.append(message)

    def close(self) -> None:
        self.heard.append("closed")

    def join(self, timeout: float) -> None: ...


def test_the_last_messages_of_a_page_that_is_gone_are_taken() -> None:
    party = Listener()

    async def visited() -> None:
        outbox = Outbox(asyncio.get_running_loop())
        outbox.put({"type": "belief"})
        await Visit(Gone(), party, outbox, messages=10.0, sound=10.0).last()

    asyncio.run(visited())
    assert party.heard == ["one", "withdraw", "closed"]
