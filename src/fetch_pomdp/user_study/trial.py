"""One trial: the desired item, a countdown, and an interaction until the robot says what it brings.

Choice: the robot's word ends a trial (Section IV-B: it "ended when the robot told the user which item it thought was
desired"), so that it cannot be stopped any more and its time is that of the decision; the page shows the hand-over
after it.

Choice: after GIVE_UP seconds the person may give a trial up, which counts as if the robot had never picked; nobody can
be kept waiting for a robot that waits for ever.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

from fetch_pomdp.adapters.web.conversation import TIMING, Conversation
from fetch_pomdp.adapters.web.ears import Speech
from fetch_pomdp.adapters.web.journal import Journal
from fetch_pomdp.adapters.web.page_connection import FAREWELL
from fetch_pomdp.adapters.web.robot import PageRobot
from fetch_pomdp.adapters.web.server_messages import (
    BROKEN,
    HANDS_OVER,
    Send,
    ServerMessage,
    decided_message,
    error_message,
    event_message,
    scene_to_json,
    status_message,
    talk_state,
)
from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Observed
from fetch_pomdp.core.live import Decided, Did, Ended, Heard, SensorStatus, Update
from fetch_pomdp.core.live.session import MODEL
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Item
from fetch_pomdp.errors import MessageError
from fetch_pomdp.user_study.mailbox import BrokenError, Mailbox
from fetch_pomdp.user_study.messages import GiveUp, Ready
from fetch_pomdp.user_study.recorder import NOTED, TrialRecorder
from fetch_pomdp.user_study.store.trials import StoredTrial

GIVE_UP = 45.0  # s
ROUND = dataclasses.replace(TIMING, after=0.0)


@dataclass(frozen=True, slots=True)
class Over:
    """The robot has said what it brings."""

    picked: str | None


@dataclass(frozen=True, slots=True)
class Sound:
    """A piece of sound to be recorded; start: s, of the trial's clock."""

    start: float
    pcm: bytes


class AnnouncingRobot(PageRobot):
    """The robot of a study: a pick is done when the robot has announced it."""

    def pick(self, item: Item) -> Outcome:  # noqa: ARG002
        """Say that it brings an item."""
        self.say(HANDS_OVER)
        return Outcome.DONE


def participant_view(update: Update, agent: Agent) -> ServerMessage | None:
    """Return what a participant is told of an update: what they would see of a robot, and that it has heard."""
    if isinstance(update, Decided) and not isinstance(update.decision.action, Wait):
        return decided_message(update, agent)
    if isinstance(update, Did) and not update.event.done:
        return event_message(update.event, agent)
    if isinstance(update, Heard) and update.event.words and not update.event.early:
        return {"type": "heard", "t": update.event.time, "asked": talk_state(agent)["asked"]}
    if isinstance(update, SensorStatus) and update.name != MODEL:
        return status_message(update)
    return {"type": "ended", "picked": update.picked} if isinstance(update, Ended) else None


class TrialRunner:
    """Runs one trial. on_conversation: gets the conversation when it begins, and None when it is over."""

    def __init__(
        self,
        trial: StoredTrial,
        mailbox: Mailbox,
        send: Send,
        *,
        speech: Speech,
        on_conversation: Callable[[Conversation | None], None],
    ) -> None:
        self._trial, self._mailbox, self._send, self._on_conversation = trial, mailbox, send, on_conversation
        self._speech = speech

    def run(self, stage: ServerMessage, countdown: float) -> None:
        """Run the trial, or go on with it where it was, and send how it ended. stage: what the page is told of it.

        Raises as `Mailbox.expect`, BrokenError for a robot that cannot go on.
        """
        trial = self._trial
        agent = trial.header.agent()
        prepare(agent.planner, agent.problem)
        running = trial.clock is not None
        self._send({**stage, "desired": trial.header.target, "running": running, "give_up": GIVE_UP})
        self._send(self._welcome(running))
        if not running:
            self._mailbox.expect(Ready)
            self._send({"type": "countdown", "seconds": countdown})
            self._mailbox.pause(countdown)
            trial.note_clock(0.0)
        self._send({"type": "ended", "picked": self._picked()})

    def _picked(self) -> str | None:
        """Let person and robot interact; return what the robot brings, None if the person gave up."""
        trial = self._trial
        journal = Journal("", trial.header, list(trial.events), trial, clock=trial.clock or 0.0)
        conversation = Conversation(
            journal, self._relay, view=participant_view, speech=self._speech, timing=ROUND, body=AnnouncingRobot
        )
        recorder = TrialRecorder(trial, conversation.clock)
        self._on_conversation(conversation)
        self._send({"type": "begin", "t": round(conversation.clock.now(), 3)})
        conversation.start()
        if journal.events:  # who was waiting for the robot when the connection was lost still is
            conversation.wake()
        try:
            return self._until_over(conversation, recorder)
        finally:
            left = conversation.clock.now()
            self._on_conversation(None)
            conversation.close()
            conversation.join(FAREWELL)
            trial.note_clock(left)
            recorder.flush()

    def _until_over(self, conversation: Conversation, recorder: TrialRecorder) -> str | None:
        while True:
            message = self._mailbox.expect(Over, GiveUp, Sound, within=NOTED)
            recorder.note_clock()
            if isinstance(message, Over):
                return message.picked
            if message is None:
                continue
            if isinstance(message, Sound):
                recorder.add_sound(message.start, message.pcm)
            elif (now := conversation.clock.now()) >= GIVE_UP:
                conversation.close()
                conversation.join(FAREWELL)
                if not self._trial.finished:  # the time until then is that of the trial (study.trial.scored)
                    self._trial.write(Observed(Observation(), time=now))
                    self._trial.finish(given_up=True)
                return None
            else:
                early = f"a trial can be given up after {GIVE_UP:g} s, not after {now:.0f} s"
                self._send(error_message(MessageError(early)))

    def _relay(self, message: ServerMessage) -> None:
        if message["type"] == "ended":
            self._mailbox.post(Over(message["picked"]))
        elif message.get("code") == BROKEN:
            self._mailbox.post(BrokenError("the robot cannot go on"))
        else:
            self._send(message)

    def _welcome(self, running: bool) -> ServerMessage:
        agent = self._trial.header.agent()
        for event in self._trial.events:
            agent.take(event)
        asked = talk_state(agent)["asked"]
        ears = self._speech.hearing is not None
        return {"type": "welcome", "scene": scene_to_json(self._trial.header.scene), "asked": asked, "ears": ears} | {
            "insight": False, "belief": None, "past": [], "picked": None, "resumed": running,
        }  # fmt: skip
