"""Everybody who is before a page: each has a party of their own, and none hears of another."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol
from weakref import WeakValueDictionary

from fetch_pomdp.adapters.web.gate import Gate
from fetch_pomdp.adapters.web.outbox import Outbox
from fetch_pomdp.adapters.web.protocol import Hello, message_from_text
from fetch_pomdp.adapters.web.tell import Told, complaint
from fetch_pomdp.adapters.web.visit import POLICY, TRY_LATER, GoneError, Party, Visit, close, received, send
from fetch_pomdp.errors import EventError, FetchPomdpError, MessageError, StoreError

logger = logging.getLogger(__name__)

GREETING = 10.0  # s a page may take to say hello
PENALTY = 1.0  # s a wrong token costs, so that nobody guesses often


class FullError(MessageError):
    """All seats are taken for now."""


# What is no fault of the page's: it may come back by itself.
FOR_NOW = (FullError, TimeoutError, EventError, StoreError)


@dataclass(frozen=True, slots=True, kw_only=True)
class Config:
    """How a server serves. token: what a page must know, None on loopback; data: a folder for the journals.

    scene: the table that pages begin with, as they ask for it: a name or {"toml": "..."}.
    """

    scene: str | Mapping[str, str] = "ambiguous"
    token: str | None = None
    data: Path | None = None
    insight: bool = True  # whether a person may see what the robot believes and why it acts
    most_people: int = 64  # at once
    messages: float = 40.0  # a second, of one page; twice as many at once
    sound: float = 64_000.0  # bytes a second, of one page: twice what a microphone sends (visit.LEAST_SOUND)


class Reception(Protocol):
    """Gives each page its party, which tells it all by `tell`, from any thread."""

    def name(self, hello: Hello) -> str | None:
        """Return the name of the party that a page comes back to, if it says that it does."""
        ...

    def returning(self, hello: Hello, tell: Callable[[Told], None]) -> Party | None:
        """Return the party that a page comes back to, None if there is none."""
        ...

    def newcomer(self, hello: Hello, tell: Callable[[Told], None]) -> Party:
        """Return a party for somebody new."""
        ...

    def get_ready(self) -> None:
        """Do what takes long before the first person comes."""
        ...


class Hall:
    """Lets pages in and keeps them apart."""

    def __init__(self, config: Config, reception: Reception) -> None:
        self._config, self._reception = config, reception
        self.gate = Gate(config.token)
        self._visits: list[Visit] = []
        self._arriving = 0  # pages that have a seat, and no visit yet
        # One at a time, of those who come back to the same party: two pages that lost a server come back at once.
        self._doors: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    async def receive(self, socket: Any) -> None:
        """Talk to one page, from its first message until it has left."""
        host = socket.headers.get("host")
        if not (self.gate.host_allowed(host) and self.gate.origin_allowed(socket.headers.get("origin"), host)):
            await socket.close(POLICY)
            return
        await socket.accept()
        try:
            visit = await self._visit(socket, await asyncio.wait_for(self._hello(socket), GREETING))
            try:
                await visit.last()
            finally:
                self._visits.remove(visit)
        except GoneError:
            logger.info("a page left")
        except (FetchPomdpError, TimeoutError) as error:
            await self._refuse(socket, error)

    async def _refuse(self, socket: Any, error: Exception) -> None:
        try:
            await send(socket, complaint(error))
            await close(socket, TRY_LATER if isinstance(error, FOR_NOW) else POLICY)
        except GoneError:
            logger.info("a page left before it was refused")

    async def _hello(self, socket: Any) -> Hello:
        message = await received(socket)
        hello = message_from_text(message) if isinstance(message, str) else None
        if not isinstance(hello, Hello):
            raise MessageError("found another message, expected hello first", field="type")
        if not self.gate.token_allowed(hello.token):
            await asyncio.sleep(PENALTY)
            raise MessageError("found a wrong token, expected the one that the server printed", field="token")
        return hello

    async def _visit(self, socket: Any, hello: Hello) -> Visit:
        outbox, config = Outbox(asyncio.get_running_loop()), self._config
        name = self._reception.name(hello)
        async with self._doors.setdefault(name or secrets.token_hex(), asyncio.Lock()):
            before = [] if name is None else [visit for visit in self._visits if visit.party.name == name]
            with self._seat(before):
                for visit in before:
                    await visit.leave()
                party = await self._party(hello, name, outbox)
                visit = Visit(socket, party, outbox, messages=config.messages, sound=config.sound)
                self._visits.append(visit)
        return visit

    @contextmanager
    def _seat(self, before: Sequence[Visit]) -> Iterator[None]:
        """Keep a seat for a page until it has a visit, which takes that of the visits of its person `before`.

        Raises FullError if there is none.
        """
        people = len(self._visits) + self._arriving - len(before)
        if people >= self._config.most_people:
            raise FullError(f"found {people} people here, expected you to come back later")
        self._arriving += 1
        try:
            yield
        finally:
            self._arriving -= 1

    async def _party(self, hello: Hello, name: str | None, outbox: Outbox) -> Party:
        """Return the party that a page goes on with, or a new one."""
        if name is not None:
            party = await asyncio.to_thread(self._reception.returning, hello, outbox.put)
            if party is not None:
                return party
        return await asyncio.to_thread(self._reception.newcomer, hello, outbox.put)
