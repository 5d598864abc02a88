"""The pages that are connected: each has a session of its own, and none hears of another.

Choice: when all seats are taken, a newcomer gets the seat of a page that is idle: one that has sent nothing valid since
it came, for IDLE_NEW seconds, or one that has sent nothing valid for IDLE seconds; those that never sent anything
first, then the longest silent. Its person loses nothing: the page comes back when there is a seat.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from fetch_pomdp.adapters.web.access import AccessRules, TokenCheck, TooManyGuessesError
from fetch_pomdp.adapters.web.page_connection import (
    POLICY,
    TAKEN_OVER,
    TRY_LATER,
    ConnectionLimits,
    GoneError,
    PageConnection,
    PageSession,
    close,
    received,
    send,
)
from fetch_pomdp.adapters.web.page_messages import Hello, read_page_message
from fetch_pomdp.adapters.web.server_messages import Send, error_message
from fetch_pomdp.errors import EventError, FetchPomdpError, MessageError, StoreError

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

logger = logging.getLogger(__name__)

GREETING = 10.0  # s a page may take to say hello
IDLE_NEW, IDLE = 60.0, 600.0  # s


class FullError(MessageError):
    """All seats are taken for now."""


# No fault of the page: it may come back by itself.
TEMPORARY = (FullError, TooManyGuessesError, TimeoutError, EventError, StoreError)


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerConfig:
    """How a server serves. token: what a page must know, None on loopback.

    scene: the table that pages begin with, as they ask for it: a name or {"toml": "..."}.
    """

    scene: str | Mapping[str, str] = "ambiguous"
    token: str | None = None
    most_people: int = 64  # at once
    limits: ConnectionLimits = field(default_factory=ConnectionLimits)


class SessionOpener(Protocol):
    """Opens the session of each page, in a thread of that page; `send` takes messages for it, from any thread."""

    def session_name(self, hello: Hello) -> str | None:
        """Return the name of the session that a page comes back to, None for a new page."""
        ...

    def resume(self, hello: Hello, send: Send) -> PageSession | None:
        """Return the session that a page comes back to, None if there is none."""
        ...

    def new(self, hello: Hello, send: Send) -> PageSession:
        """Return a new session."""
        ...

    def warm_up(self) -> None:
        """Do what takes long before the first page comes."""
        ...


class ConnectionManager:
    """Lets pages in and keeps them apart."""

    def __init__(
        self, config: ServerConfig, opener: SessionOpener, *, now: Callable[[], float] = time.monotonic
    ) -> None:
        self._config, self._opener, self._now = config, opener, now
        self.rules = AccessRules(config.token is not None)
        self._tokens = TokenCheck(config.token, now)
        self._connections: list[PageConnection] = []

    async def serve(self, socket: WebSocket) -> None:
        """Serve one page, from its first message until it has left."""
        host = socket.headers.get("host")
        if not (self.rules.host_allowed(host) and self.rules.origin_allowed(socket.headers.get("origin"), host)):
            await socket.close(POLICY)
            return
        await socket.accept()
        try:
            hello = await asyncio.wait_for(self._hello(socket), GREETING)
            connection = PageConnection(socket, self._opener.session_name(hello), self._config.limits, self._now)
            with self._seat(connection) as before:
                for other in before:
                    await other.gone()
                session = await connection.in_thread(lambda: self._session(hello, connection))
                connection.name = session.name
                await connection.run(session)
        except GoneError:
            logger.info("a page left")
        except (FetchPomdpError, TimeoutError) as error:
            await self._refuse(socket, error)

    async def _refuse(self, socket: WebSocket, error: Exception) -> None:
        try:
            await send(socket, error_message(error))
            await close(socket, TRY_LATER if isinstance(error, TEMPORARY) else POLICY)
        except GoneError:
            logger.info("a page left before it was refused")

    async def _hello(self, socket: WebSocket) -> Hello:
        message = await received(socket)
        hello = read_page_message(message) if isinstance(message, str) else None
        if not isinstance(hello, Hello):
            raise MessageError("found another message, expected hello first", field="type")
        self._tokens.check(hello.token, socket.client.host if socket.client else "")
        return hello

    @contextmanager
    def _seat(self, connection: PageConnection) -> Iterator[Sequence[PageConnection]]:
        """Give a page a seat until it has left; yield the other pages of its session, which are disconnected.

        Raises FullError if there is none.
        """
        others = list(self._connections)
        same = [other for other in others if connection.name is not None and other.name == connection.name]
        seated = [other for other in others if other not in same and not other.leaving]
        if len(seated) >= self._config.most_people:
            idle = _idlest(seated)
            if idle is None:
                raise FullError(f"server full ({len(seated)} of {self._config.most_people}); try again later")
            idle.disconnect(TRY_LATER)
        for other in same:
            other.disconnect(TAKEN_OVER)
        self._connections.append(connection)
        try:
            yield same
        finally:
            self._connections.remove(connection)
            connection.release()

    def _session(self, hello: Hello, connection: PageConnection) -> PageSession:
        """Return the session that a page comes back to, or a new one."""
        found = None if connection.name is None else self._opener.resume(hello, connection.queue.put)
        return found or self._opener.new(hello, connection.queue.put)


def _idlest(connections: Sequence[PageConnection]) -> PageConnection | None:
    """Return the page that is disconnected first for a newcomer, None if none is idle."""
    idle = [each for each in connections if each.silence() > (IDLE if each.has_spoken else IDLE_NEW)]
    return max(idle, key=lambda each: (not each.has_spoken, each.silence()), default=None)
