"""Pages and sessions without a network, for what two of them do to each other."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from fetch_pomdp.adapters.web.connection_manager import ConnectionManager
from fetch_pomdp.adapters.web.page_connection import ConnectionLimits, PageConnection
from fetch_pomdp.adapters.web.page_messages import Hello
from fetch_pomdp.adapters.web.server_messages import Send, ServerMessage

Work = Callable[[str | bytes], None]
HELLO = {"type": "hello", "version": 1}


class FakeClock:
    """A clock that shows what it is set to."""

    time = 0.0

    def __call__(self) -> float:
        return self.time


class FakeSocket:
    """A WebSocket of one page: what the page sends is put in, what it is told and how it was closed is kept."""

    def __init__(self, address: str = "192.0.2.1", **hello: Any) -> None:
        self.headers = {"host": "127.0.0.1:8000", "origin": "http://127.0.0.1:8000"}
        self.client = SimpleNamespace(host=address)
        self.told: list[ServerMessage] = []
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


async def serve(manager: ConnectionManager, page: FakeSocket) -> None:
    """Let a manager serve a page."""
    socket: Any = page
    await manager.serve(socket)


def connected(page: FakeSocket, clock: Callable[[], float] = time.monotonic, **limits: float) -> PageConnection:
    """Return the connection of a page."""
    socket: Any = page
    return PageConnection(socket, None, ConnectionLimits(**limits), clock)


class FakeSession:
    """A PageSession that keeps what it takes. work: what `receive` does with each message; ends: whether it does."""

    def __init__(
        self,
        name: str,
        work: Work = lambda _: None,
        *,
        ends: Callable[[], bool] = lambda: True,
    ) -> None:
        self.name, self.taken, self._work, self._ends = name, list[str | bytes](), work, ends
        self.ended: Callable[[], None] = lambda: None

    def start(self, ended: Callable[[], None]) -> None:
        self.ended = ended

    def receive(self, message: str | bytes) -> None:
        self._work(message)
        self.taken.append(message)

    def close(self) -> None:
        if self._ends():
            self.ended()


class FakeOpener:
    """A SessionOpener whose sessions are called by what pages resume. meet: what is done before there is one."""

    def __init__(
        self,
        meet: Callable[[Hello], None] = lambda _: None,
        *,
        work: Work = lambda _: None,
        ends: Callable[[], bool] = lambda: True,
    ) -> None:
        self._meet, self._work, self._ends = meet, work, ends
        self.sessions: list[FakeSession] = []

    def session_name(self, hello: Hello) -> str | None:
        return hello.resume

    def resume(self, hello: Hello, send: Send) -> FakeSession | None:
        return self._session(hello, str(hello.resume), send)

    def new(self, hello: Hello, send: Send) -> FakeSession:
        return self._session(hello, f"new {len(self.sessions)}", send)

    def warm_up(self) -> None:
        pass

    def _session(self, hello: Hello, name: str, send: Send) -> FakeSession:
        self._meet(hello)
        session = FakeSession(name, self._work, ends=self._ends)
        self.sessions.append(session)
        send({"type": "welcome"})
        return session
