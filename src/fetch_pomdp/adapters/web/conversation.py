"""One person and one robot: a live interaction in a thread of its own, written down as it happens.

Choice: nothing is decided before the person has said or shown something, nor after IDLE seconds in which they did not:
a robot that speaks to an empty room helps nobody, and the time of an interaction begins with the request (Section IV).
What wakes the robot is heard to its end before the first decision, which is otherwise one about nobody's request.
"""

from __future__ import annotations

import dataclasses
import logging
import threading
from collections.abc import Callable

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.speech.stream import listened_for
from fetch_pomdp.adapters.web.ears import Ears, Hearing
from fetch_pomdp.adapters.web.journal import Journal
from fetch_pomdp.adapters.web.protocol import Message, Microphone, Pointed, Typed, Typing, message_from_text
from fetch_pomdp.adapters.web.robot import ARM, SPEAK, PageRobot
from fetch_pomdp.adapters.web.tell import Told, View, complaint, saying, sensor_status
from fetch_pomdp.core.events import Event
from fetch_pomdp.core.interaction import Timing
from fetch_pomdp.core.live import LIVE, Did, Ended, Heard, Inbox, LiveRobot, LiveSession, RealClock, Update
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.ports import Frame, Word
from fetch_pomdp.errors import MessageError

logger = logging.getLogger(__name__)

IDLE = 30.0  # s
TIMING: Timing = dataclasses.replace(
    LIVE, question=ARM + SPEAK + LIVE.wait, overlap=SPEAK, silence=8.0, before=LIVE.wait
)


class Conversation:
    """An interaction that rests while its person is silent.

    tell: takes messages, from any thread, and returns soon. body: makes the robot, given what says a sentence.
    """

    def __init__(
        self,
        journal: Journal,
        tell: Callable[[Told], None],
        *,
        view: View,
        voice: Voice | None,
        hearing: Hearing | None,
        body: Callable[[Callable[[str], None]], LiveRobot] = PageRobot,
    ) -> None:
        self._journal, self._tell, self._view, self._voice = journal, tell, view, voice
        self.clock = RealClock(journal.time)
        self._agent = journal.agent()
        self._robot = body(self._say)
        self._over = threading.Event()  # nothing follows
        self._came = threading.Event()  # something to go on with
        self._heard_at = self.clock.now()
        self._inbox = Inbox()
        self._inbox.subscribe(lambda _: self._wake())
        self._session = self._rest()
        self._ears = None if hearing is None else self._ears_of(hearing)
        self._thread = threading.Thread(target=self._run, name=f"conversation {journal.name[:8]}", daemon=True)

    def start(self) -> None:
        """Begin, in a thread."""
        self._thread.start()

    def wake(self) -> None:
        """Let the robot go on, though nothing was said or shown yet."""
        self._came.set()

    def close(self) -> None:
        """End, from any thread; what was going on is stopped, and is no part of the journal."""
        self._over.set()
        self._came.set()
        self._session.close()
        if self._ears is not None:
            self._ears.close()

    def join(self, timeout: float) -> None:
        """Wait until the thread has ended, and close the journal."""
        self._thread.join(timeout)
        self._journal.close()

    @property
    def name(self) -> str:
        """The name of its journal."""
        return self._journal.name

    def take(self, message: str | bytes) -> None:
        """Take what a page sent. Raises InputError for what is no message."""
        self.heed(message if isinstance(message, bytes) else message_from_text(message))

    def heed(self, message: Message | bytes) -> None:
        """Hear or see what a person says or shows; when the interaction is over, nothing any more.

        Raises MessageError for hello, and for sound where there are no ears.
        """
        if isinstance(message, bytes):
            self._hear(message)
        elif self._over.is_set():
            return
        elif isinstance(message, Typed):
            self._type(message.text)
        elif isinstance(message, Typing):
            self._expect(message.text)
        elif isinstance(message, Pointed):
            self._point(Frame(self.clock.now(), message.head, (message.wrist,)))
        elif isinstance(message, Microphone):
            self._hush(message)
        else:
            raise MessageError("found hello again, expected it once", field="type")

    def _type(self, text: str) -> None:
        now = self._heard_at = self.clock.now()
        self._inbox.push_words([Word(part, now, now) for part in text.split()])
        self._inbox.push_partial(None)

    def _expect(self, text: str) -> None:
        """Take the words of a text that is being typed as a hypothesis; the last one may be unfinished."""
        now = self._heard_at = self.clock.now()
        whole = text.split() if text[-1:].isspace() else text.split()[:-1]
        self._inbox.push_partial(tuple(Word(part, now, now) for part in whole) if text.strip() else None)

    def _point(self, frame: Frame) -> None:
        self._heard_at = frame.time
        self._inbox.push_frame(frame)

    def _hear(self, pcm: bytes) -> None:
        if self._ears is None:
            raise MessageError("found sound, expected none: this server has no ears")
        self._ears.hear(pcm)

    def _hush(self, microphone: Microphone) -> None:
        if self._ears is not None and not microphone.on:
            self._ears.end()

    def _ears_of(self, hearing: Hearing) -> Ears:
        words = listened_for(self._agent.scene)
        return Ears(hearing, words, self._inbox, self.clock.now, lambda status: self._tell(sensor_status(status)))

    def _rest(self) -> LiveSession:
        listen, clock = self._listen, self.clock
        return LiveSession(self._agent, self._robot, self._inbox, listener=listen, clock=clock, timing=TIMING)

    def _wake(self) -> None:
        """Begin with the first word or gesture: a noise that is no word, or a text that is deleted, begins nothing."""
        pending = self._inbox.pending()
        if pending.words or pending.frames:
            self._came.set()

    def _run(self) -> None:
        try:
            self._prepare()
            while self._journal.picked is None and not self._over.is_set():
                self._came.wait()
                self._session.run()
                self._session = self._rest()
                self._came.clear()
                self._wake()  # what the session has not taken goes on with it; what it has begins nothing
        except Exception as error:
            logger.exception("a conversation broke off")
            self._tell(complaint(error, "broken"))
        self._over.set()
        if self._ears is not None:
            self._ears.close()

    def _prepare(self) -> None:
        self._tell({"type": "status", "sensor": "planner", "state": "slow", "text": "The robot is getting ready."})
        prepare(self._agent.planner, self._agent.problem)
        self._tell({"type": "status", "sensor": "planner", "state": "ok", "text": "The robot is ready."})

    def _say(self, sentence: str) -> None:
        if self._voice is not None and self._ears is not None:
            self._ears.mute(self._voice.seconds(sentence))
        self._tell(saying(sentence, audible=self._voice is not None))

    def _listen(self, update: Update) -> None:
        """Write down what has happened, then tell it: what a page has seen is never lost."""
        if self._over.is_set() or (isinstance(update, Ended) and update.picked is None):
            return
        if isinstance(update, Did | Heard) and not self._written(update.event):
            return
        if isinstance(update, Heard) and update.event.words:
            self._heard_at = self.clock.now()
        if isinstance(update, Heard) and self.clock.now() - self._heard_at > IDLE:
            self._session.close()
        told = self._view(update, self._agent)
        if told is not None:
            self._tell(told)

    def _written(self, event: Event) -> bool:
        """Write an event down; a conversation that cannot be written down any more ends."""
        try:
            self._journal.write(event)
        except Exception as error:
            logger.exception("a journal broke")
            self._over.set()
            self._session.close()
            self._tell(complaint(error, "broken"))
            return False
        return True
