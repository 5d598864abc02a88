"""Everybody who is talking to the robot: each page has a conversation of its own, and none hears of another."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.web.conversation import Conversation
from fetch_pomdp.adapters.web.ears import Hearing
from fetch_pomdp.adapters.web.gate import Gate
from fetch_pomdp.adapters.web.journal import Journal, Journals, name_of
from fetch_pomdp.adapters.web.outbox import Outbox
from fetch_pomdp.adapters.web.protocol import VERSION, Hello, message_from_text
from fetch_pomdp.adapters.web.tell import Told, belief_by_id, complaint, event_message, scene_to_json
from fetch_pomdp.adapters.web.visit import POLICY, GoneError, Visit, close, received, send
from fetch_pomdp.errors import FetchPomdpError, MessageError
from fetch_pomdp.files.header import Header

logger = logging.getLogger(__name__)

GREETING = 10.0  # s a page may take to say hello
PENALTY = 1.0  # s a wrong token costs, so that nobody guesses often


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
    sound: float = 64_000.0  # bytes a second, of one page: twice what a microphone sends


class Hall:
    """Lets pages in and keeps them apart. voice, hearing: None where they are not installed."""

    def __init__(self, config: Config, voice: Voice | None, hearing: Hearing | None) -> None:
        self._config, self._voice, self._hearing = config, voice, hearing
        self.gate, self._journals = Gate(config.token), Journals(config.data)
        self._visits: dict[str, Visit] = {}

    async def receive(self, socket: Any) -> None:
        """Talk to one page, from its first message until it has left."""
        host = socket.headers.get("host")
        if not (self.gate.host_allowed(host) and self.gate.origin_allowed(socket.headers.get("origin"), host)):
            await socket.close(POLICY)
            return
        await socket.accept()
        try:
            journal, resumed = await self._journal(await asyncio.wait_for(self._hello(socket), GREETING))
            await self._visit(socket, journal, resumed=resumed)
        except GoneError:
            logger.info("a page left")
        except (FetchPomdpError, TimeoutError) as error:
            await self._refuse(socket, error)

    async def _refuse(self, socket: Any, error: Exception) -> None:
        try:
            await send(socket, complaint(error))
            await close(socket, POLICY)
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

    async def _journal(self, hello: Hello) -> tuple[Journal, bool]:
        """Return the journal that a page goes on with, and whether it is an old one."""
        if hello.resume is not None:
            if visit := self._visits.get(name_of(hello.resume)):
                await visit.leave()
            journal = await asyncio.to_thread(self._journals.resumed, hello.resume)
            if journal is not None:
                return journal, True
        if len(self._visits) >= self._config.most_people:
            raise MessageError(f"found {len(self._visits)} people here, expected you to come back later")
        header = Header(scene=hello.scene, scene_name=hello.scene_name, planner=hello.planner, seed=hello.seed)
        return await asyncio.to_thread(self._journals.new, header), False

    async def _visit(self, socket: Any, journal: Journal, *, resumed: bool) -> None:
        config, outbox = self._config, Outbox(asyncio.get_running_loop())
        try:
            outbox.put(self._welcome(journal, resumed=resumed))
            conversation = Conversation(
                journal, outbox.put, insight=config.insight, voice=self._voice, hearing=self._hearing
            )
            visit = Visit(socket, conversation, outbox, messages=config.messages, sound=config.sound)
            self._visits[journal.name] = visit
            await visit.last()
        finally:
            self._visits.pop(journal.name, None)
            journal.close()

    def _welcome(self, journal: Journal, *, resumed: bool) -> Told:
        agent = journal.agent()
        past = (event_message(event, agent) for event in journal.events)
        belief = belief_by_id(agent.belief, agent.scene) if self._config.insight else None
        return {
            "type": "welcome",
            "version": VERSION,
            "session": journal.name[:8],
            "resume": journal.secret,
            "resumed": resumed,
            "scene": scene_to_json(agent.scene),
            "scene_name": journal.header.scene_name,
            "planner": journal.header.planner,
            "insight": self._config.insight,
            "ears": self._hearing is not None,
            "belief": belief,
            "past": [told for told in past if told is not None],
            "picked": journal.picked,
        }
