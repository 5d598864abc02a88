"""Conversations with the robot for whoever comes: each page has one of its own, kept in a journal."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from fetch_pomdp.adapters.reading.choice import reader_named
from fetch_pomdp.adapters.web.conversation import Conversation
from fetch_pomdp.adapters.web.ears import Speech
from fetch_pomdp.adapters.web.examples import examples
from fetch_pomdp.adapters.web.journal import Journal, Journals, name_of
from fetch_pomdp.adapters.web.page_messages import VERSION, Hello, header_of
from fetch_pomdp.adapters.web.server_messages import (
    Send,
    ServerMessage,
    belief_by_id,
    event_message,
    scene_to_json,
    talk_state,
    with_insight,
    without_insight,
)
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Event
from fetch_pomdp.core.language.names import named
from fetch_pomdp.core.language.reading.catalogue import DEFAULT as READER
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.planners.catalogue import DEFAULT, planner_named
from fetch_pomdp.core.problem import Problem


class ConversationOpener:
    """A SessionOpener: table and planner are the person's choice.

    data: a folder for the journals, None to keep them in memory. insight: whether a person may see what the robot
    believes and why it acts. reader: what reads the words, by its name (`reading.choice`). Raises InputError if the
    folder cannot be made, or for a reader of another name; MissingExtraError.
    """

    def __init__(self, data: Path | None, *, insight: bool, speech: Speech, reader: str = READER) -> None:
        self._journals, self._insight, self._speech = Journals(data), insight, speech
        self._reader_name, self._reader = reader, reader_named(reader)

    def session_name(self, hello: Hello) -> str | None:
        """Return the name of the conversation that a page comes back to, None for a new page."""
        return None if hello.resume is None else name_of(hello.resume)

    def resume(self, hello: Hello, send: Send) -> Conversation | None:
        """Return the conversation that a page comes back to, None if there is none."""
        journal = None if hello.resume is None else self._journals.resumed(hello.resume)
        return None if journal is None else self._conversation(journal, send, resumed=True)

    def new(self, hello: Hello, send: Send) -> Conversation:
        """Return a new conversation. Raises MessageError or SceneError for an invalid choice of the page."""
        header = dataclasses.replace(header_of(hello), reader=self._reader_name)
        return self._conversation(self._journals.new(header), send, resumed=False)

    def warm_up(self) -> None:
        """Compile the planner and solve the built-in tables before the first page comes."""
        for name in LAYOUTS:
            prepare(planner_named(DEFAULT), Problem(named(live_scene(name))))

    def _conversation(self, journal: Journal, send: Send, *, resumed: bool) -> Conversation:
        journal.reader = self._reader if journal.header.reader == self._reader_name else None
        send(self._welcome(journal, resumed=resumed))
        view = with_insight if self._insight else without_insight
        return Conversation(journal, send, view=view, speech=self._speech)

    def _welcome(self, journal: Journal, *, resumed: bool) -> ServerMessage:
        agent = journal.header.agent()
        past = [_taken(event, agent) for event in journal.events]
        belief = belief_by_id(agent.belief, agent.scene) if self._insight else None
        state = talk_state(agent)
        return {
            "type": "welcome",
            "version": VERSION,
            "session": journal.name[:8],
            "resume": journal.secret,
            "resumed": resumed,
            "scene": scene_to_json(agent.scene),
            "scene_name": journal.header.scene_name,
            "planner": journal.header.planner,
            "insight": self._insight,
            "ears": self._speech.hearing is not None,
            "belief": belief,
            "past": [message for message in past if message is not None],
            "picked": journal.picked,
            "examples": examples(agent.scene),
        } | {**state, "begun": bool(journal.events) and state["begun"]}


def _taken(event: Event, agent: Agent) -> ServerMessage | None:
    """Let an agent go on from an event, and return that as a page is told of it."""
    agent.take(event)
    return event_message(event, agent)
