"""The outside as the interaction sees it: ears, eyes and a robot. Adapters implement these Protocols.

All times are seconds on the clock of the stream: 0 is the start of the recording or of listening.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Protocol, runtime_checkable

from fetch_pomdp.checks import Point3
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.scene import Item


@dataclass(frozen=True, slots=True)
class Word:
    """A word as it was heard, lower case.

    readings: of the whole utterance that it is a word of, the first with the words as they were heard; all words of an
    utterance share one tuple. None where the recogniser knows of no other reading.
    """

    text: str
    start: float  # s
    end: float  # s
    posterior: float = 1.0  # the recogniser's own probability that it was this word
    readings: tuple[Alternative, ...] = ()


@dataclass(frozen=True, slots=True)
class Frame:
    """A skeleton at one moment: the head and one or both wrists."""

    time: float  # s
    head: Point3  # m
    wrists: tuple[Point3, ...]  # m


class Outcome(Enum):
    """How a robot's action ended."""

    DONE = "done"
    FAILED = "failed"  # the robot could not
    STOPPED = "stopped"  # the person, or `Robot.stop`, kept it from it
    RETURNED = "returned"  # it was done, and the person gave the item back


@dataclass(frozen=True, slots=True)
class Failure:
    """An Outcome.FAILED of a robot that knows why: "could not reach", "dropped it", "blocked by cup-2"."""

    reason: str


class Recognizer(Protocol):
    """Ears: turn sound into timed words."""

    def hear(self, until: float) -> Sequence[Word]:
        """Listen until the stream's time `until` (s) and return the words that ended by then, each exactly once, in
        order.

        After the end of the stream there is silence: it returns at once, with what was left and then nothing.
        Raises AudioError for a stream that breaks.
        """
        ...


@runtime_checkable
class UtteranceRecognizer(Recognizer, Protocol):
    """Ears of a recording, which know how long somebody goes on speaking."""

    def utterance_end(self, time: float) -> float:
        """Return when (s) the utterance ends that goes on at a time, or the time if nobody speaks then."""
        ...


class SkeletonSource(Protocol):
    """Eyes: turn a camera or a recording into skeletons."""

    def see(self, until: float) -> Sequence[Frame]:
        """Return the frames up to the stream's time `until` (s), each exactly once, in order.

        Raises SkeletonError for a stream that breaks.
        """
        ...


class Robot(Protocol):
    """Arm and voice. Each call returns when the movement or the speech has ended."""

    def point(self, item: Item) -> Outcome | Failure:
        """Point at an item and ask "this one?"."""
        ...

    def pick(self, item: Item) -> Outcome | Failure:
        """Hand an item over."""
        ...

    def take_back(self, item: Item) -> Outcome | Failure:
        """Take an item back that was handed over, and put it where it was."""
        ...

    def say(self, text: str) -> Outcome | Failure:
        """Say something that is no question about an item."""
        ...

    def stop(self) -> None:
        """Stop what is going on; the interrupted call returns Outcome.STOPPED."""
        ...
