"""A page while it is connected: what it sends goes to its party, what that tells goes to the page."""

from __future__ import annotations

import asyncio
import json
import logging
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Protocol

from fetch_pomdp.adapters.web.gate import Allowance
from fetch_pomdp.adapters.web.outbox import Outbox
from fetch_pomdp.adapters.web.protocol import LARGEST_MESSAGE
from fetch_pomdp.adapters.web.tell import BROKEN, Told, complaint
from fetch_pomdp.errors import InputError

logger = logging.getLogger(__name__)

# Codes that close a WebSocket: of RFC 6455, and from 4000 our own.
POLICY, TRY_LATER, TAKEN_OVER = 1008, 1013, 4001
FAREWELL = 5.0  # s a party may take to end
LAST_WORDS = 1.0  # s in which what a page sent before it was let go is still taken: it may be a withdrawal
FORBEARANCE = 200  # messages too many after which a page is let go
LEAST_SOUND = 640  # bytes that a piece of sound counts for at least: 20 ms, half of what a microphone sends at once


class GoneError(Exception):
    """The page has left."""


async def received(socket: Any) -> str | bytes:
    """Return the next message of a page. Raises GoneError when it has left."""
    message = await socket.receive()
    if message["type"] != "websocket.receive":
        raise GoneError
    text = message.get("text")
    return text if text is not None else message.get("bytes") or b""


async def send(socket: Any, told: Told) -> None:
    """Send a message. Raises GoneError when the page has left."""
    try:
        await socket.send_text(json.dumps(told, ensure_ascii=False, allow_nan=False))
    except Exception as error:  # every server has its own
        raise GoneError from error


async def close(socket: Any, code: int) -> None:
    """Close a page's WebSocket. Raises GoneError when the page has left."""
    try:
        await socket.close(code)
    except Exception as error:  # every server has its own
        raise GoneError from error


class Party(Protocol):
    """Whom a page talks to: a conversation, or the attendance of a participant of a study."""

    @property
    def name(self) -> str:
        """The name under which it is found when its person comes back, which lets nobody in."""
        ...

    def start(self) -> None:
        """Begin, in a thread of its own."""
        ...

    def take(self, message: str | bytes) -> None:
        """Take a message or sound, one after the other, in a thread. Raises InputError for what is none."""
        ...

    def close(self) -> None:
        """End soon; from any thread."""
        ...

    def join(self, timeout: float) -> None:
        """Wait until it has ended, and let go of all it holds."""
        ...


class Visit:
    """A page and its party. messages, sound: what it may send a second, in messages and in bytes of sound.

    The party takes what the page sends in a thread of the visit's own, so that nobody else waits for it; the page's
    next message is read when that is done, so that what is too much for it waits with the page.
    """

    def __init__(self, socket: Any, party: Party, outbox: Outbox, *, messages: float, sound: float) -> None:
        self.party = party
        self._socket, self._outbox = socket, outbox
        self._messages, self._sound = Allowance(messages, 2 * messages), Allowance(sound, sound + LARGEST_MESSAGE)
        self._too_many = 0
        self._let_go, self._over = asyncio.Event(), asyncio.Event()
        self._taking = ThreadPoolExecutor(1, thread_name_prefix=f"page {party.name[:8]}")

    async def last(self) -> None:
        """Carry messages both ways until the page has left, and end the party then."""
        self.party.start()
        ways = [asyncio.create_task(way) for way in (self._from_page(), self._to_page(), self._until_let_go())]
        try:
            done, _ = await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
            await asyncio.wait(ways[:1], timeout=LAST_WORDS)
            for way in done:
                if not isinstance(way.exception(), GoneError):
                    way.result()
        finally:
            for way in ways:
                way.cancel()
            self.party.close()
            self._taking.shutdown(wait=False, cancel_futures=True)
            await asyncio.to_thread(self.party.join, FAREWELL)
            self._over.set()

    async def leave(self) -> None:
        """Let the page go, because its person came back on another, and wait until the party has ended."""
        self._let_go.set()
        await self._over.wait()

    async def _until_let_go(self) -> None:
        """End, whether the page says farewell or is dead."""
        await self._let_go.wait()
        await close(self._socket, TAKEN_OVER)

    async def _to_page(self) -> None:
        while True:
            if self._outbox.overfull:
                await close(self._socket, TRY_LATER)
                return
            for told in await self._outbox.take():
                await send(self._socket, told)
                if told.get("code") == BROKEN:  # the page comes back, to a party that goes on where this one was
                    await close(self._socket, TRY_LATER)
                    return

    def _allowed(self, message: str | bytes) -> bool:
        """Whether a message may come now; each piece of sound is work, however short it is."""
        if isinstance(message, bytes):
            return self._sound.take(max(len(message), LEAST_SOUND))
        return self._messages.take()

    async def _from_page(self) -> None:
        while True:
            message = await received(self._socket)
            if not self._allowed(message):
                self._too_many += 1
                if self._too_many > FORBEARANCE:
                    await close(self._socket, POLICY)
                    return
                continue
            try:
                await asyncio.get_running_loop().run_in_executor(self._taking, self.party.take, message)
            except InputError as error:
                self._outbox.put(complaint(error))
