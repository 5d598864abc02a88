"""One trial: what is desired, a countdown, and an interaction until the robot tells what it brings.

Choice: the robot's word ends a trial (Section IV-B: it "ended when the robot told the user which item it thought was
desired"), so that it cannot be stopped any more and its time is that of the decision; the page shows the hand-over
after it.

Choice: who has waited GIVE_UP seconds may give a trial up, which counts as if the robot had never picked; people cannot
be held before a robot that waits for ever.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.store.journal import TrialJournal
from fetch_pomdp.adapters.web.conversation import Conversation
from fetch_pomdp.adapters.web.ears import Hearing
from fetch_pomdp.adapters.web.journal import Journal
from fetch_pomdp.adapters.web.participation.keeping import NOTED, Keeping
from fetch_pomdp.adapters.web.participation.mailbox import BrokenError, Mailbox
from fetch_pomdp.adapters.web.participation.messages import GiveUp, Ready
from fetch_pomdp.adapters.web.robot import PageRobot
from fetch_pomdp.adapters.web.tell import (
    BROKEN,
    HANDS_OVER,
    Told,
    complaint,
    decided,
    event_message,
    scene_to_json,
    sensor_status,
)
from fetch_pomdp.adapters.web.visit import FAREWELL
from fetch_pomdp.core.action import Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.live import Decided, Did, Ended, Heard, SensorStatus, Update
from fetch_pomdp.core.live.session import MODEL
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Item
from fetch_pomdp.errors import MessageError

GIVE_UP = 45.0  # s


@dataclass(frozen=True, slots=True)
class Over:
    """The robot has told what it brings."""

    picked: str | None


@dataclass(frozen=True, slots=True)
class Sound:
    """A piece of sound to be kept; start: s, of the trial's clock."""

    start: float
    pcm: bytes


class TellingRobot(PageRobot):
    """The robot of a study: it is done with a pick when it has told of it."""

    def pick(self, item: Item) -> Outcome:  # noqa: ARG002
        """Say that it brings an item."""
        self.say(HANDS_OVER)
        return Outcome.DONE


def outward(update: Update, agent: Agent) -> Told | None:
    """Return what a participant may know of an update: what a body would show, and that the robot has heard."""
    if isinstance(update, Decided) and not isinstance(update.decision.action, Wait):
        return decided(update, agent)
    if isinstance(update, Did) and not update.event.done:
        return event_message(update.event, agent)
    if isinstance(update, Heard) and update.event.words:
        return {"type": "heard", "t": update.event.time}
    if isinstance(update, SensorStatus) and update.name != MODEL:
        return sensor_status(update)
    return {"type": "ended", "picked": update.picked} if isinstance(update, Ended) else None


class Round:
    """A trial before its person. began: is told the conversation when it begins, and None when it is over."""

    def __init__(
        self,
        trial: TrialJournal,
        mailbox: Mailbox,
        tell: Callable[[Told], None],
        *,
        voice: Voice | None,
        hearing: Hearing | None,
        began: Callable[[Conversation | None], None],
    ) -> None:
        self._trial, self._mailbox, self._tell, self._began = trial, mailbox, tell, began
        self._voice, self._hearing = voice, hearing

    def play(self, stage: Told, countdown: float) -> None:
        """Play it, or go on with it where it was, and tell how it ended. stage: what the page is told of it.

        Raises what `Mailbox.expect` raises: BrokenError for a robot that cannot go on.
        """
        trial = self._trial
        agent = trial.header.agent()
        prepare(agent.planner, agent.problem)
        running = trial.clock is not None
        self._tell({**stage, "desired": trial.header.target, "running": running, "give_up": GIVE_UP})
        self._tell(self._welcome(running))
        if not running:
            self._mailbox.expect(Ready)
            self._tell({"type": "countdown", "seconds": countdown})
            self._mailbox.pause(countdown)
            trial.note_clock(0.0)
        self._tell({"type": "ended", "picked": self._picked()})

    def _picked(self) -> str | None:
        """Let person and robot interact; return what the robot brings, None if it was given up."""
        trial = self._trial
        journal = Journal("", trial.header, list(trial.events), trial, clock=trial.clock or 0.0)
        talk = Conversation(
            journal, self._told, view=outward, voice=self._voice, hearing=self._hearing, body=TellingRobot
        )
        kept = Keeping(trial, talk.clock)
        self._began(talk)
        self._tell({"type": "begin", "t": round(talk.clock.now(), 3)})
        talk.start()
        if journal.events:  # whoever waited for the robot when the connection was lost waits still
            talk.wake()
        try:
            return self._until_over(talk, kept)
        finally:
            left = talk.clock.now()
            self._began(None)
            talk.close()
            talk.join(FAREWELL)
            trial.note_clock(left)
            kept.flush()

    def _until_over(self, talk: Conversation, kept: Keeping) -> str | None:
        while True:
            message = self._mailbox.expect(Over, GiveUp, Sound, within=NOTED)
            kept.look()
            if isinstance(message, Over):
                return message.picked
            if message is None:
                continue
            if isinstance(message, Sound):
                kept.sound(message.start, message.pcm)
            elif (now := talk.clock.now()) >= GIVE_UP:
                talk.close()
                talk.join(FAREWELL)
                if not self._trial.finished:  # the time until then is that of the trial (study.trial.scored)
                    self._trial.write(Observed(Observation(), time=now))
                    self._trial.finish(given_up=True)
                return None
            else:
                expected = f"expected it from {GIVE_UP:g} s on"
                self._tell(complaint(MessageError(f"found a trial given up after {now:.0f} s, {expected}")))

    def _told(self, told: Told) -> None:
        if told["type"] == "ended":
            self._mailbox.post(Over(told["picked"]))
        elif told.get("code") == BROKEN:
            self._mailbox.post(BrokenError("the robot cannot go on"))
        else:
            self._tell(told)

    def _welcome(self, running: bool) -> Told:
        asked = self._asked()
        ears = self._hearing is not None
        return {"type": "welcome", "scene": scene_to_json(self._trial.header.scene), "asked": asked, "ears": ears} | {
            "insight": False, "belief": None, "past": [], "picked": None, "resumed": running,
        }  # fmt: skip

    def _asked(self) -> str | None:
        """Return the item that the robot has asked about, if nothing was heard since."""
        for event in reversed(self._trial.events):
            if isinstance(event, Observed) and event.observation.words:
                return None
            if isinstance(event, Acted) and isinstance(event.action, Point):
                return self._trial.header.scene.items[event.action.item].id
        return None
