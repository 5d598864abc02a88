"""Ears, eyes and a robot for tests, on the clock of their streams."""

from __future__ import annotations

from collections.abc import Sequence

from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.ports import Failure, Frame, Outcome, Word
from fetch_pomdp.core.scene import Item

HEAD = (0.0, 0.0, 1.6)


class Ears:
    """Words with their times; each is heard once."""

    def __init__(self, *words: tuple[str, float]) -> None:
        self.words = [Word(text, end - 0.1, end) for text, end in words]
        self.asked_until: list[float] = []

    def hear(self, until: float) -> Sequence[Word]:
        self.asked_until.append(until)
        heard = [word for word in self.words if word.end <= until]
        self.words = self.words[len(heard) :]
        return heard


class Eyes:
    """Frames with their times; each is seen once."""

    def __init__(self, *frames: Frame) -> None:
        self.frames = list(frames)

    def see(self, until: float) -> Sequence[Frame]:
        seen = [frame for frame in self.frames if frame.time <= until]
        self.frames = self.frames[len(seen) :]
        return seen


class Arm:
    """A robot whose actions end as told; DONE after that."""

    def __init__(self, *outcomes: Outcome | Failure) -> None:
        self.outcomes, self.done = list(outcomes), list[str]()

    def _act(self, what: str) -> Outcome | Failure:
        self.done.append(what)
        return self.outcomes.pop(0) if self.outcomes else Outcome.DONE

    def point(self, item: Item) -> Outcome | Failure:
        return self._act(f"point {item.id}")

    def pick(self, item: Item) -> Outcome | Failure:
        return self._act(f"pick {item.id}")

    def take_back(self, item: Item) -> Outcome | Failure:
        return self._act(f"take back {item.id}")

    def say(self, text: str) -> Outcome:
        self.done.append(f"say {text}")
        return Outcome.DONE

    def stop(self) -> None:
        self.done.append("stop")


def observed(events: list[Event]) -> list[Observed]:
    return [event for event in events if isinstance(event, Observed)]


def acted(events: list[Event]) -> list[Acted]:
    return [event for event in events if isinstance(event, Acted)]


def frame(time: float, *wrists: tuple[float, float, float], head: tuple[float, float, float] = HEAD) -> Frame:
    return Frame(time, head, wrists)


def towards(x: float, z: float = 0.75) -> tuple[float, float, float]:
    """A wrist 0.7 m ahead on the ray from HEAD to (x, 3.2, z)."""
    return (x * 0.2, 3.2 * 0.2, 1.6 + (z - 1.6) * 0.2)
