"""What the listener is told: each event, and the belief while a step goes on, as if the step ended now."""

from __future__ import annotations

import logging
from collections.abc import Callable
from threading import RLock

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Event
from fetch_pomdp.core.hearing import texts, understood
from fetch_pomdp.core.live.inbox import Inbox
from fetch_pomdp.core.live.updates import BeliefChanged, Did, Heard, Update
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.ports import Word
from fetch_pomdp.core.senses import median_ray
from fetch_pomdp.errors import InputError

logger = logging.getLogger(__name__)


class Display:
    """Tells a listener, one update at a time. Safe from any thread.

    Who brings something new never waits for a listener that is busy, such as one that writes to a disk: whoever tells
    it something then shows what is new when it is through.

    The belief of a step that goes on is computed from the step's start each time, from all that was heard and seen in
    it, so that a hypothesis that is replaced leaves no trace.
    """

    def __init__(self, agent: Agent, inbox: Inbox, listener: Callable[[Update], None]) -> None:
        self._agent, self._inbox, self._listener, self._lock = agent, inbox, listener, RLock()
        self._start = agent.copy()  # as it was when the step began
        self._taken: tuple[Word, ...] = ()  # from the inbox, but not in the agent's belief yet
        self._shown = Observation()
        self._unseen: float | None = None  # s, when something came that was not looked at yet

    def tell(self, update: Update) -> None:
        """Tell the listener; what goes wrong there is logged, and is no matter of the interaction."""
        with self._lock:
            self._tell(update)
        self._catch_up()

    def took(self, words: tuple[Word, ...]) -> None:
        """Know of words that were taken out of the inbox for the observation under way."""
        with self._lock:
            self._taken += words

    def begin(self, time: float) -> None:
        """Tell the belief that the agent begins with, or goes on with after what was taken has been left out."""
        with self._lock:
            self._start, self._taken, self._shown = self._agent.copy(), (), Observation()
            self._tell(BeliefChanged(time, self._start.belief, provisional=False, words=()))
        self.look(time)

    def settle(self, event: Event, time: float) -> None:
        """Tell of an event that the agent has taken, and of the belief that the next step begins with."""
        with self._lock:
            self._start, self._shown = self._agent.copy(), Observation()
            if isinstance(event, Acted):
                self._tell(Did(event))
            else:
                # Early answers leave the other words for later; after a hand-over words may have begun nothing.
                read = frozenset(event.words)
                self._taken = tuple(word for word in self._taken if event.early and word not in read)
                self._tell(Heard(event))
                self._tell(BeliefChanged(time, self._start.belief, provisional=False, words=texts(event.words)))
        self.look(time)

    def look(self, time: float) -> None:
        """Tell what the belief would be if the step ended now, unless that is as it was."""
        self._unseen = time
        self._catch_up()

    def _tell(self, update: Update) -> None:
        try:
            self._listener(update)
        except Exception:
            logger.exception("the listener broke")

    def _catch_up(self) -> None:
        """Look, if something new came, unless another thread is telling something: that one looks afterwards."""
        while self._unseen is not None and self._lock.acquire(blocking=False):
            try:
                time, self._unseen = self._unseen, None
                if time is not None:
                    self._look(time)
            finally:
                self._lock.release()

    def _look(self, time: float) -> None:
        if self._agent.handed is not None:  # whether this takes something back or begins anew, the step's end tells
            return
        pending = self._inbox.pending()
        words = self._taken + pending.words + (pending.partial or ())
        ray = median_ray(pending.frames, self._agent.problem)
        agent = self._start.quick()
        observation = understood(words, agent.answers, agent.after, ray)
        if observation == self._shown:
            return
        self._shown = observation
        try:
            agent.update(observation)
        except InputError:  # impossible by the model: the step's end says so, if the words stay what they are
            return
        self._tell(BeliefChanged(time, agent.belief, provisional=True, words=texts(words)))
