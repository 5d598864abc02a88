"""The connection of one page: what it sends goes to its session, what the session sends goes to the page."""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeVar

from fetch_pomdp.adapters.web.access import RateLimit
from fetch_pomdp.adapters.web.page_messages import LARGEST_MESSAGE
from fetch_pomdp.adapters.web.send_queue import SendQueue
from fetch_pomdp.adapters.web.server_messages import BROKEN, ServerMessage, error_message
from fetch_pomdp.errors import InputError

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

logger = logging.getLogger(__name__)
Made = TypeVar("Made")

# Codes that close a WebSocket: of RFC 6455, and from 4000 our own.
POLICY, TRY_LATER, TAKEN_OVER = 1008, 1013, 4001
FAREWELL = 5.0  # s a session may take to end
LAST_WORDS = 1.0  # s in which what a page sent before it was disconnected is still taken: it may be a withdrawal
MOST_REFUSED = 200  # messages over the limit, after which a page is disconnected
LEAST_SOUND = 640  # bytes that a piece of sound counts for at least: 20 ms, half of what a microphone sends at once


class GoneError(Exception):
    """The page has left."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConnectionLimits:
    """What one page may send."""

    messages: float = 40.0  # a second; twice as many at once
    sound: float = 64_000.0  # bytes a second: twice what a microphone sends
    first_message: float = 600.0  # s after its hello within which a page must send something valid


class PageSession(Protocol):
    """What a page talks to: a conversation, or the session of a participant of a study."""

    @property
    def name(self) -> str:
        """The name under which it is found when its person comes back; it lets nobody in."""
        ...

    def start(self, ended: Callable[[], None]) -> None:
        """Start, in a thread of its own, which calls `ended` when the session is over and holds nothing any more."""
        ...

    def receive(self, message: str | bytes) -> None:
        """Take a message or sound; calls come one after the other. Raises InputError if it is invalid."""
        ...

    def close(self) -> None:
        """End soon; from any thread."""
        ...


async def received(socket: WebSocket) -> str | bytes:
    """Return the next message of a page. Raises GoneError when it has left."""
    message = await socket.receive()
    if message["type"] != "websocket.receive":
        raise GoneError
    text: str | None = message.get("text")
    pcm: bytes | None = message.get("bytes")
    return text if text is not None else pcm or b""


async def send(socket: WebSocket, message: ServerMessage) -> None:
    """Send a message. Raises GoneError when the page has left."""
    try:
        await socket.send_text(json.dumps(message, ensure_ascii=False, allow_nan=False))
    except Exception as error:  # every server has its own
        raise GoneError from error


async def close(socket: WebSocket, code: int) -> None:
    """Close a page's WebSocket. Raises GoneError when the page has left."""
    try:
        await socket.close(code)
    except Exception as error:  # every server has its own
        raise GoneError from error


class PageConnection:
    """A page that has a seat. name: of its session, as soon as that is known.

    What the page sends is taken in a thread of the connection's own, so that nobody else waits for it; the page's next
    message is read when that is done, so that what is too much waits with the page.
    """

    def __init__(
        self, socket: WebSocket, name: str | None, limits: ConnectionLimits, now: Callable[[], float] = time.monotonic
    ) -> None:
        self.name, self._socket, self._limits, self._now = name, socket, limits, now
        self._loop = asyncio.get_running_loop()
        self.queue = SendQueue(self._loop)
        self._messages = RateLimit(limits.messages, 2 * limits.messages, now)
        self._sound = RateLimit(limits.sound, limits.sound + LARGEST_MESSAGE, now)
        self._refused = 0
        self._heard_at, self.has_spoken = now(), False
        self._code = TRY_LATER
        self._let_go, self._session_over, self._gone = asyncio.Event(), asyncio.Event(), asyncio.Event()
        self._thread = ThreadPoolExecutor(1, thread_name_prefix=f"page {(name or 'new')[:8]}")

    @property
    def leaving(self) -> bool:
        """Whether the page was disconnected; its session may still be ending."""
        return self._let_go.is_set()

    def silence(self) -> float:
        """Return for how long (s) the page has sent nothing valid."""
        return self._now() - self._heard_at

    async def in_thread(self, work: Callable[[], Made]) -> Made:
        """Run something in the connection's own thread; nobody else waits for that."""
        return await self._loop.run_in_executor(self._thread, work)

    def disconnect(self, code: int) -> None:
        """Disconnect the page soon."""
        if not self.leaving:
            self._code = code
            self._let_go.set()

    def release(self) -> None:
        """Let go of what the connection holds; nothing follows."""
        self._thread.shutdown(wait=False, cancel_futures=True)
        self._gone.set()

    async def gone(self) -> None:
        """Wait until the session has ended and everything is released."""
        await self._gone.wait()

    async def run(self, session: PageSession) -> None:
        """Carry messages both ways until the page has left, and end the session then."""
        session.start(self._session_ended)
        first = self._loop.call_later(self._limits.first_message, self._expect_first_message)
        ways = [asyncio.create_task(way) for way in (self._from_page(session), self._to_page(), self._until_let_go())]
        try:
            done, _ = await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
            await asyncio.wait(ways[:1], timeout=LAST_WORDS)
            for way in done:
                if not isinstance(way.exception(), GoneError):
                    way.result()
        finally:
            first.cancel()
            for way in ways:
                way.cancel()
            session.close()
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._session_over.wait(), FAREWELL)

    def _session_ended(self) -> None:
        with contextlib.suppress(RuntimeError):  # the server has ended before
            self._loop.call_soon_threadsafe(self._session_over.set)

    def _expect_first_message(self) -> None:
        if not self.has_spoken:
            self.disconnect(TRY_LATER)

    async def _until_let_go(self) -> None:
        """End when the page is disconnected, whether it answers or is dead."""
        await self._let_go.wait()
        await close(self._socket, self._code)

    async def _to_page(self) -> None:
        while True:
            if self.queue.overfull:
                await close(self._socket, TRY_LATER)
                return
            for message in await self.queue.take():
                await send(self._socket, message)
                if message.get("code") == BROKEN:  # the page comes back, to a session that goes on where this one was
                    await close(self._socket, TRY_LATER)
                    return

    def _allowed(self, message: str | bytes) -> bool:
        """Whether a message may come now; each piece of sound is work, however short it is."""
        if isinstance(message, bytes):
            return self._sound.take(max(len(message), LEAST_SOUND))
        return self._messages.take()

    async def _from_page(self, session: PageSession) -> None:
        while True:
            message = await received(self._socket)
            if not self._allowed(message):
                self._refused += 1
                if self._refused > MOST_REFUSED:
                    await close(self._socket, POLICY)
                    return
                continue
            try:
                await self._loop.run_in_executor(self._thread, session.receive, message)
            except InputError as error:
                self.queue.put(error_message(error))
            else:
                self._heard_at, self.has_spoken = self._now(), True
