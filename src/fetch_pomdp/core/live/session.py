"""A live interaction: the one loop of `interaction`, with a clock, sensors that push and a listener that is told.

Choice: nothing that fails ends it. A sensor that gives no sign of life is reported and done without; an utterance that
comes to no end is waited for only so long; an action in which the robot breaks has failed; an observation that the
model holds impossible is reported and left out.
"""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator

from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Event, Observed
from fetch_pomdp.core.interaction import Timing, interact
from fetch_pomdp.core.live.body import Body, LiveRobot
from fetch_pomdp.core.live.clock import Clock, RealClock
from fetch_pomdp.core.live.display import Display
from fetch_pomdp.core.live.inbox import Inbox, News
from fetch_pomdp.core.live.senses import SPEECH, Closed, LiveSenses
from fetch_pomdp.core.live.sensor_monitor import SensorMonitor
from fetch_pomdp.core.live.updates import Ended, SensorState, Update
from fetch_pomdp.errors import BeliefError, ObservationError

logger = logging.getLogger(__name__)

LIVE = Timing(overlap=0.8)  # of a question, the words "this one?", said when the arm has arrived
REFRESH = 0.1  # s between beliefs shown for pointing alone
MODEL = "model"  # the name under which an impossible observation is reported


class LiveSession:
    """One live interaction. `run` goes on until an item is handed over or `close` is called, in a thread of the caller.

    listener: is told each Update, one at a time and in order, by whichever thread makes it. While it is busy the robot
    waits, and sensors do not (see UpdateQueue for one that is slow). agent: of this interaction alone. inbox: of one
    session at a time; what a session has not taken is there for the next one.
    """

    def __init__(
        self,
        agent: Agent,
        robot: LiveRobot,
        inbox: Inbox,
        *,
        listener: Callable[[Update], None],
        clock: Clock | None = None,
        timing: Timing = LIVE,
    ) -> None:
        self.agent, self.clock = agent, clock or RealClock()
        self._inbox, self._timing = inbox, timing
        self._display = Display(agent, inbox, listener)
        self._monitor = SensorMonitor(inbox, self._display.tell)
        self._senses = LiveSenses(inbox, self.clock, self._display, self._monitor)
        self._body = Body(robot, inbox, self._monitor, agent.answers)
        self._looked = 0.0
        self._leave_inbox = inbox.subscribe(self._came)

    def run(self) -> None:
        """Interact. To be called once."""
        self._display.begin(self.clock.now())
        try:
            for event in self._events():
                self._display.settle(event, self.clock.now())
                if isinstance(event, Observed):
                    self._monitor.report(MODEL, SensorState.OK)
        except Closed:
            logger.info("closed")
        finally:
            self._leave_inbox()
        handed = self.agent.handed
        self._display.tell(Ended(None if handed is None else self.agent.scene.items[handed].id))

    def close(self) -> None:
        """End the interaction soon, from any thread; what the robot does is stopped."""
        self._senses.closed.set()
        self._inbox.wake.set()
        self._body.stop()

    def _events(self) -> Iterator[Event]:
        """Yield what happens; go on from where it is when the model holds an observation impossible."""
        while True:
            senses = self._senses
            try:
                yield from interact(
                    self.agent, self._body, senses, senses, timing=self._timing, most_steps=sys.maxsize, pace=senses
                )
            except (BeliefError, ObservationError) as error:
                logger.warning("left out: %s", error)
                self._monitor.report(MODEL, SensorState.LOST)
                self._display.begin(self.clock.now())
            else:
                return

    def _came(self, news: News) -> None:
        """Do what does not wait for the step's end; in the thread of the sensor."""
        self._body.heed()
        now = self.clock.now()
        if news is News.WORDS:
            self._senses.went_on()
            if self._inbox.pending().partial is not None:
                self._monitor.report(SPEECH, SensorState.OK)
        elif now < self._looked + REFRESH:
            return
        self._looked = now
        self._display.look(now)
