"""Pages and parties without a network, for what two of them do to each other."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Callable
from typing import Any

from fetch_pomdp.adapters.web.protocol import Hello
from fetch_pomdp.adapters.web.tell import Told

HELLO = {"type": "hello", "version": 1}


class Socket:
    """A WebSocket of one page: what the page sends is put in, what it is told and how it was closed is kept."""

    def __init__(self, **hello: Any) -> None:
        self.headers = {"host": "127.0.0.1:8000", "origin": "http://127.0.0.1:8000"}
        self.told: list[Told] = []
        self.code: int | None = None
        self._sent: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self.send(json.dumps({**HELLO, **hello}))

    def send(self, message: str | bytes) -> None:
        kind = "text" if isinstance(message, str) else "bytes"
        self._sent.put_nowait({"type": "websocket.receive", kind: message})

    def leave(self) -> None:
        self._sent.put_nowait({"type": "websocket.disconnect"})

    async def accept(self) -> None:
        pass

    async def receive(self) -> dict[str, Any]:
        return await self._sent.get()

    async def send_text(self, text: str) -> None:
        self.told.append(json.loads(text))

    async def close(self, code: int) -> None:
        if self.code is None:
            self.code = code
        self.leave()


class Guest:
    """A Party that keeps what it takes. stay: what `take` does with each message."""

    def __init__(self, name: str, stay: Callable[[str | bytes], None] = lambda _: None) -> None:
        self.name, self.taken, self._stay = name, list[str | bytes](), stay
        self.joined = threading.Event()

    def start(self) -> None:
        pass

    def take(self, message: str | bytes) -> None:
        self._stay(message)
        self.taken.append(message)

    def close(self) -> None:
        pass

    def join(self, timeout: float) -> None:
        self.joined.set()


class Desk:
    """A Reception of guests, who are called by what they come back with. meet: what is done before there is one."""

    def __init__(self, meet: Callable[[Hello], None] = lambda _: None) -> None:
        self._meet = meet
        self.guests: list[Guest] = []

    def name(self, hello: Hello) -> str | None:
        return hello.resume

    def returning(self, hello: Hello, tell: Callable[[Told], None]) -> Guest | None:
        return self._guest(hello, str(hello.resume), tell)

    def newcomer(self, hello: Hello, tell: Callable[[Told], None]) -> Guest:
        return self._guest(hello, f"new {len(self.guests)}", tell)

    def get_ready(self) -> None:
        pass

    def _guest(self, hello: Hello, name: str, tell: Callable[[Told], None]) -> Guest:
        self._meet(hello)
        self.guests.append(Guest(name))
        tell({"type": "welcome"})
        return self.guests[-1]
