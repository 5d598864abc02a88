"""One person and one robot: live interactions in a thread of its own, written down as they happen.

Choice: nothing is decided before the person has said or shown something, nor after IDLE seconds in which they did not:
a robot that speaks to an empty room helps nobody, and the time of an interaction begins with the request (Section IV).
What wakes the robot is heard to its end before the first decision, which would otherwise be about nobody's request.
"""

from __future__ import annotations

import dataclasses
import logging
import threading
from collections.abc import Callable

from fetch_pomdp.adapters.speech.stream import listened_for
from fetch_pomdp.adapters.web.ears import Ears, Hearing, Speech
from fetch_pomdp.adapters.web.journal import Journal
from fetch_pomdp.adapters.web.page_messages import Microphone, PageMessage, Pointed, Typed, Typing, read_page_message
from fetch_pomdp.adapters.web.robot import ARM, SPEAK, PageRobot
from fetch_pomdp.adapters.web.server_messages import (
    BROKEN,
    Send,
    View,
    aloud,
    error_message,
    say_message,
    status_message,
)
from fetch_pomdp.core.events import Event
from fetch_pomdp.core.interaction import Timing
from fetch_pomdp.core.live import LIVE, Did, Ended, Heard, Inbox, LiveRobot, LiveSession, RealClock, Update
from fetch_pomdp.core.planners.base import prepare
from fetch_pomdp.core.ports import Frame, Word
from fetch_pomdp.errors import MessageError

logger = logging.getLogger(__name__)

IDLE = 30.0  # s
TIMING: Timing = dataclasses.replace(
    LIVE, question=ARM + SPEAK + LIVE.wait, overlap=SPEAK, silence=8.0, before=LIVE.wait, after=IDLE
)


class Conversation:
    """A PageSession: an interaction that rests while its person is silent.

    timing: without time `after` a hand-over that ends it; otherwise the robot rests then, and goes on with what is said
    or shown next, whether it gives the item back or asks for another. body: makes the robot, given the function that
    says a sentence.
    """

    def __init__(
        self,
        journal: Journal,
        send: Send,
        *,
        view: View,
        speech: Speech,
        timing: Timing = TIMING,
        body: Callable[[Callable[[str], None]], LiveRobot] = PageRobot,
    ) -> None:
        self._journal, self._send, self._view, self._voice = journal, send, view, speech.voice
        self._timing = timing
        self.clock = RealClock(journal.time)
        self._agent = journal.agent()
        self._robot = body(self._say)
        self._over = threading.Event()  # nothing follows
        self._came = threading.Event()  # something to go on with
        self._heard_at = self.clock.now()
        self._inbox = Inbox()
        self._inbox.subscribe(lambda _: self._wake())
        self._session = self._rest()
        self._ears = None if speech.hearing is None else self._ears_of(speech.hearing)
        self._ended: Callable[[], None] = lambda: None
        self._thread = threading.Thread(target=self._run, name=f"conversation {journal.name[:8]}", daemon=True)

    def start(self, ended: Callable[[], None] = lambda: None) -> None:
        """Start, in a thread, which calls `ended` when the journal is closed."""
        self._ended = ended
        self._thread.start()

    def wake(self) -> None:
        """Let the robot go on although nothing was said or shown yet."""
        self._came.set()

    def close(self) -> None:
        """End, from any thread; what was going on is stopped, and is no part of the journal."""
        self._over.set()
        self._came.set()
        self._session.close()
        if self._ears is not None:
            self._ears.close()

    def join(self, timeout: float) -> None:
        """Wait until the thread has ended, at most `timeout` s."""
        self._thread.join(timeout)

    @property
    def name(self) -> str:
        """The name of its journal."""
        return self._journal.name

    def receive(self, message: str | bytes) -> None:
        """Take what a page sent. Raises InputError if it is invalid."""
        self.handle(message if isinstance(message, bytes) else read_page_message(message))

    def handle(self, message: PageMessage | bytes) -> None:
        """Hear or see what a person says or shows; nothing once the interaction is over.

        Raises MessageError for hello, and for sound where speech recognition is not installed.
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
            self._microphone(message)
        else:
            raise MessageError("hello again, expected it once", field="type")

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
            raise MessageError("this server has no speech recognition")
        self._ears.hear(pcm)

    def _microphone(self, microphone: Microphone) -> None:
        if self._ears is not None and not microphone.on:
            self._ears.end()

    def _ears_of(self, hearing: Hearing) -> Ears:
        words = listened_for(self._agent.scene)
        return Ears(hearing, words, self._inbox, self.clock.now, lambda status: self._send(status_message(status)))

    def _rest(self) -> LiveSession:
        listen, clock, timing = self._listen, self.clock, self._timing
        return LiveSession(self._agent, self._robot, self._inbox, listener=listen, clock=clock, timing=timing)

    def _wake(self) -> None:
        """Begin with the first word or gesture: a noise that is no word, or a text that is deleted, begins nothing."""
        pending = self._inbox.pending()
        if pending.words or pending.frames:
            self._came.set()

    def _run(self) -> None:
        try:
            self._prepare()
            while not (self._over.is_set() or self._served):
                self._came.wait()
                self._session.run()
                self._session = self._rest()
                self._came.clear()
                self._wake()  # what the session has not taken goes on with it; what it has begins nothing
        except Exception as error:
            logger.exception("a conversation failed")
            self._send(error_message(error, BROKEN))
        self._over.set()
        if self._ears is not None:
            self._ears.close()
        self._journal.close()
        self._ended()

    @property
    def _served(self) -> bool:
        """Whether a hand-over has ended it."""
        return not self._timing.after and self._journal.picked is not None

    def _prepare(self) -> None:
        self._send({"type": "status", "sensor": "planner", "state": "slow", "text": "The robot is getting ready."})
        prepare(self._agent.planner, self._agent.problem)
        self._send({"type": "status", "sensor": "planner", "state": "ok", "text": "The robot is ready."})

    def _say(self, sentence: str) -> None:
        if self._voice is not None and self._ears is not None:
            self._ears.mute(self._voice.seconds(aloud(sentence)))
        self._send(say_message(sentence, audible=self._voice is not None))

    def _listen(self, update: Update) -> None:
        """Write down what has happened, then send it: what a page has seen is never lost."""
        if self._over.is_set() or (isinstance(update, Ended) and not self._served):
            return
        if isinstance(update, Did | Heard) and not self._written(update.event):
            return
        if isinstance(update, Heard) and update.event.words:
            self._heard_at = self.clock.now()
        if isinstance(update, Heard) and self.clock.now() - self._heard_at > IDLE:
            self._session.close()
        message = self._view(update, self._agent)
        if message is not None:
            self._send(message)

    def _written(self, event: Event) -> bool:
        """Write an event down; a conversation whose journal fails ends."""
        try:
            self._journal.write(event)
        except Exception as error:
            logger.exception("a journal failed")
            self._over.set()
            self._session.close()
            self._send(error_message(error, BROKEN))
            return False
        return True
