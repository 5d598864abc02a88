"""What a live interaction tells its listener, as it happens, and a listener that only keeps it."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum
from threading import Condition
from typing import TypeAlias

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.planners.base import Decision


class SensorState(Enum):
    """How a sensor does."""

    OK = "ok"
    SILENT = "silent"  # no sign of life for a moment
    SLOW = "slow"  # it lives, and what it began does not come to an end
    LOST = "lost"  # no sign of life for long, or broken


@dataclass(frozen=True, slots=True, eq=False)
class BeliefChanged:
    """The belief at `time` (s), (n_items,) in scene order; words: those heard in this step, so far.

    provisional: what it would be if the step ended now. It is computed from the step's start each time, and is no part
    of the log; what the step came to follows.
    """

    time: float
    belief: Vector
    provisional: bool
    words: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Decided:
    """The robot begins an action at `time` (s)."""

    time: float
    decision: Decision


@dataclass(frozen=True, slots=True, eq=False)
class Did:
    """The robot's action ended."""

    event: Acted


@dataclass(frozen=True, slots=True)
class Heard:
    """A step ended, and the robot took in what was said and seen in it."""

    event: Observed


@dataclass(frozen=True, slots=True)
class SensorStatus:
    """A sensor, the robot or the model does otherwise than before; text: in English, for a screen."""

    name: str
    state: SensorState
    text: str


@dataclass(frozen=True, slots=True)
class Ended:
    """The interaction is over; picked: id of the item that was handed over, None if it was closed before."""

    picked: str | None


Update: TypeAlias = BeliefChanged | Decided | Did | Heard | SensorStatus | Ended


class UpdateQueue:
    """A listener that only keeps, for another thread to take. Safe to use from any thread.

    A belief replaces one that nobody has taken, if nothing came between: a slow listener is told fewer of them, and
    every event. So it holds at most twice as many updates as there were events, two or three a second.
    """

    def __init__(self) -> None:
        self._updates: deque[Update] = deque()
        self._came = Condition()

    def __call__(self, update: Update) -> None:
        """Keep an update."""
        with self._came:
            if isinstance(update, BeliefChanged) and self._updates and isinstance(self._updates[-1], BeliefChanged):
                self._updates.pop()
            self._updates.append(update)
            self._came.notify_all()

    def take(self, timeout: float | None = None) -> list[Update]:
        """Wait for an update, at most `timeout` s, and take all there are; none after that time."""
        with self._came:
            self._came.wait_for(lambda: bool(self._updates), timeout)
            taken = list(self._updates)
            self._updates.clear()
            return taken
