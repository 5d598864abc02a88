"""Ears, eyes and pace of a live interaction, over an inbox and a clock."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Event

from fetch_pomdp.core.live.clock import Clock
from fetch_pomdp.core.live.display import Display
from fetch_pomdp.core.live.inbox import Inbox
from fetch_pomdp.core.live.sensor_monitor import SensorMonitor
from fetch_pomdp.core.live.updates import Decided, SensorState
from fetch_pomdp.core.planners.base import Decision
from fetch_pomdp.core.ports import Frame, Word

LONGEST_PAUSE = 2.0  # s an utterance may go on without a word from the recogniser
LONGEST = 10.0  # s an utterance may prolong a step
SPEECH = "speech"  # the name of the sensor that gives partial hypotheses


class Closed(Exception):  # noqa: N818
    """The interaction was closed from outside."""


class LiveSenses:
    """Implements Recognizer, SkeletonSource and Pace of one interaction, for its thread alone.

    Choice: a step goes on for as long as somebody is in the middle of an utterance, as a person would listen to its
    end; so what is heard and the question it answers stay together.
    """

    def __init__(self, inbox: Inbox, clock: Clock, display: Display, monitor: SensorMonitor) -> None:
        self._inbox, self._clock, self._display, self._monitor = inbox, clock, display, monitor
        self._went_on = 0.0  # s, when words last came
        self.closed = Event()

    def went_on(self) -> None:
        """Know that words came, from any thread."""
        self._went_on = self._clock.now()

    def decided(self, decision: Decision) -> None:
        """Tell of a decision."""
        self._examine()
        self._display.tell(Decided(self._clock.now(), decision))

    def time(self, due: float) -> float:  # noqa: ARG002
        """Return what time it is: in real life things take as long as they take."""
        return self._clock.now()

    def hear(self, until: float) -> Sequence[Word]:
        """Wait for `until` (s), and on for an utterance that is under way then; return the words up to its end.

        For a time that is past already, return the words that ended by then.
        """
        if until > self._clock.now():
            self._listen(until)
            until = self._clock.now()
        words = self._inbox.take_words(until)
        self._display.took(words)
        return words

    def see(self, until: float) -> Sequence[Frame]:
        """Return the frames up to a time (s)."""
        return self._inbox.take_frames(until)

    def _listen(self, until: float) -> None:
        while True:
            self._inbox.wake.clear()
            self._examine()
            now = self._clock.now()
            if self._inbox.pending().partial is None:
                ends = until
            else:
                ends = min(max(until, self._went_on + LONGEST_PAUSE), until + LONGEST)
                if now >= ends:
                    self._inbox.push_partial(None)
                    if SPEECH in self._inbox.signs_of_life():  # otherwise it was typed
                        self._monitor.report(SPEECH, SensorState.SLOW)
            if now >= ends:
                return
            self._clock.wait_until(min(ends, self._monitor.next_examination(now)), self._inbox.wake)

    def _examine(self) -> None:
        if self.closed.is_set():
            raise Closed
        self._monitor.examine(self._clock.now())
