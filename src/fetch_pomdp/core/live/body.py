"""The robot of a live interaction: it may break, and a hand-over may be objected to."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Protocol

from fetch_pomdp.core.language.answers import AnswerReader
from fetch_pomdp.core.language.words import tokenize
from fetch_pomdp.core.live.inbox import Inbox
from fetch_pomdp.core.live.sensor_monitor import SensorMonitor
from fetch_pomdp.core.live.updates import SensorState
from fetch_pomdp.core.ports import Failure, Outcome, Robot
from fetch_pomdp.core.scene import Item

logger = logging.getLogger(__name__)


class LiveRobot(Robot, Protocol):
    """A Robot whose `stop` may be called from any thread while another call goes on, and returns at once."""


class Body:
    """Implements Robot over a LiveRobot: what raises has failed; words that object stop a pick.

    Choice: a partial hypothesis is enough to stop it. A stop that was not meant costs a step, a wrong hand-over the
    interaction.
    """

    def __init__(self, robot: LiveRobot, inbox: Inbox, monitor: SensorMonitor, answers: AnswerReader) -> None:
        self._robot, self._inbox, self._monitor, self._answers = robot, inbox, monitor, answers
        self._picking = False

    def point(self, item: Item) -> Outcome | Failure:
        """Point at an item and ask."""
        return self._carry_out(lambda: self._robot.point(item))

    def pick(self, item: Item) -> Outcome | Failure:
        """Hand an item over, unless there are objections, also such as came while the robot decided."""
        self._picking = True
        try:
            return Outcome.STOPPED if self._objected() else self._carry_out(lambda: self._robot.pick(item))
        finally:
            self._picking = False

    def take_back(self, item: Item) -> Outcome | Failure:
        """Take an item back that was handed over."""
        return self._carry_out(lambda: self._robot.take_back(item))

    def say(self, text: str) -> Outcome | Failure:
        """Say something."""
        return self._carry_out(lambda: self._robot.say(text))

    def stop(self) -> None:
        """Stop what is going on."""
        self._robot.stop()

    def heed(self) -> None:
        """Stop a pick that was objected to; from any thread, after something has come into the inbox."""
        if self._picking and self._objected():
            self._robot.stop()

    def _objected(self) -> bool:
        pending = self._inbox.pending()
        heard = pending.words + (pending.partial or ())
        return self._answers.objects([text for word in heard for text in tokenize(word.text)])

    def _carry_out(self, action: Callable[[], Outcome | Failure]) -> Outcome | Failure:
        try:
            outcome: Outcome | Failure = action()
        except Exception:
            logger.exception("the robot broke")
            outcome = Outcome.FAILED
            self._monitor.report("robot", SensorState.LOST)
        else:
            self._monitor.report("robot", SensorState.OK)
        return outcome
