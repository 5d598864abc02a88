"""Who comes to talk to the robot: each page has a conversation of its own, kept in a journal."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.web.conversation import Conversation
from fetch_pomdp.adapters.web.ears import Hearing
from fetch_pomdp.adapters.web.journal import Journal, Journals, name_of
from fetch_pomdp.adapters.web.protocol import VERSION, Hello
from fetch_pomdp.adapters.web.tell import (
    Told,
    belief_by_id,
    event_message,
    scene_to_json,
    with_insight,
    without_insight,
)
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.planners.catalogue import DEFAULT, planner_named
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.lively import live_scene


class Talks:
    """A Reception: the table and the planner are the person's choice.

    data: a folder for the journals, None: they are kept in memory. insight: whether a person may see what the robot
    believes and why it acts. voice, hearing: None where they are not installed.
    """

    def __init__(self, data: Path | None, *, insight: bool, voice: Voice | None, hearing: Hearing | None) -> None:
        self._journals, self._insight, self._voice, self._hearing = Journals(data), insight, voice, hearing

    def name(self, hello: Hello) -> str | None:
        """Return the name of the conversation that a page comes back to, if it does."""
        return None if hello.resume is None else name_of(hello.resume)

    def returning(self, hello: Hello, tell: Callable[[Told], None]) -> Conversation | None:
        """Return the conversation that a page comes back to, None if there is none."""
        journal = None if hello.resume is None else self._journals.resumed(hello.resume)
        return None if journal is None else self._conversation(journal, tell, resumed=True)

    def newcomer(self, hello: Hello, tell: Callable[[Told], None]) -> Conversation:
        """Return a new conversation."""
        header = Header(scene=hello.scene, scene_name=hello.scene_name, planner=hello.planner, seed=hello.seed)
        return self._conversation(self._journals.new(header), tell, resumed=False)

    def get_ready(self) -> None:
        """Compile the planner and solve the built-in tables before the first person comes."""
        for name in LAYOUTS:
            prepare(planner_named(DEFAULT), Problem(live_scene(name)))

    def _conversation(self, journal: Journal, tell: Callable[[Told], None], *, resumed: bool) -> Conversation:
        tell(self._welcome(journal, resumed=resumed))
        view = with_insight if self._insight else without_insight
        return Conversation(journal, tell, view=view, voice=self._voice, hearing=self._hearing)

    def _welcome(self, journal: Journal, *, resumed: bool) -> Told:
        agent = journal.agent()
        past = (event_message(event, agent) for event in journal.events)
        belief = belief_by_id(agent.belief, agent.scene) if self._insight else None
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
            "ears": self._hearing is not None,
            "belief": belief,
            "past": [told for told in past if told is not None],
            "picked": journal.picked,
        }
