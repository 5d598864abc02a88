"""A live interaction without threads: time passes only when somebody waits, and then the script is played."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from threading import Event

from fetch_pomdp.core.action import Action
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.interaction import Timing
from fetch_pomdp.core.live import BeliefChanged, Did, Ended, Heard, Inbox, LiveSession, SensorStatus, Update
from fetch_pomdp.core.ports import Outcome, Word
from fetch_pomdp.core.scene import Item
from tests.core.scripted import Script

TIMING = Timing(wait=1.0, question=2.8, overlap=0.8)


class SteppedClock:
    """A Clock that plays what the script holds up to the time that is waited for."""

    def __init__(self) -> None:
        self.time = 0.0
        self.script: list[tuple[float, Callable[[], None]]] = []

    def at(self, time: float, what: Callable[[], None]) -> None:
        self.script = sorted([*self.script, (time, what)], key=lambda entry: entry[0])

    def now(self) -> float:
        return self.time

    def wait_until(self, time: float, wake: Event) -> None:
        while not wake.is_set() and self.script and self.script[0][0] <= time:
            self.time, what = max(self.time, self.script[0][0]), self.script.pop(0)[1]
            what()
        if not wake.is_set():
            self.time = max(self.time, time)


class SteppedRobot:
    """A robot whose question takes 1.8 s and whose hand-over takes 2 s of the stepped clock, unless it is stopped."""

    def __init__(self, clock: SteppedClock) -> None:
        self.clock, self.done, self.stopped = clock, list[str](), Event()

    def point(self, item: Item) -> Outcome:
        return self._act(f"point {item.id}", 1.8)

    def pick(self, item: Item) -> Outcome:
        return self._act(f"pick {item.id}", 2.0)

    def take_back(self, item: Item) -> Outcome:
        return self._act(f"take back {item.id}", 1.5)

    def say(self, text: str) -> Outcome:
        return self._act(f"say {text}", 0.5)

    def stop(self) -> None:
        self.done.append(f"stop at {self.clock.now():.1f}")
        self.stopped.set()

    def _act(self, what: str, seconds: float) -> Outcome:
        self.done.append(what)
        self.stopped.clear()
        self.clock.wait_until(self.clock.now() + seconds, self.stopped)
        return Outcome.STOPPED if self.stopped.is_set() else Outcome.DONE


class Stage:
    """A live session with all that it needs, and what it told."""

    def __init__(self, *actions: Action, after: float = 0.0, **agent: object) -> None:
        self.clock, self.inbox, self.script = SteppedClock(), Inbox(), Script(*actions)
        self.robot = SteppedRobot(self.clock)
        self.agent = Agent("ambiguous", self.script, **agent)  # type: ignore[arg-type]
        self.told: list[tuple[float, Update]] = []
        timing = dataclasses.replace(TIMING, after=after)
        self.session = LiveSession(
            self.agent, self.robot, self.inbox, listener=self.listen, clock=self.clock, timing=timing
        )

    def listen(self, update: Update) -> None:
        self.told.append((round(self.clock.now(), 3), update))

    def final(self, at: float, *texts: str) -> None:
        """At a time, the recogniser ends an utterance whose words ended a tenth of a second before each other."""
        words = [
            Word(text, at - 0.1 * k - 0.1, at - 0.1 * k) for k, text in zip(range(len(texts))[::-1], texts, strict=True)
        ]

        def push() -> None:
            for word in words:
                self.inbox.push_word(word)
            self.inbox.push_partial(None)

        self.clock.at(at, push)

    def partial(self, at: float, *texts: str) -> None:
        words = tuple(Word(text, at - 0.1, at) for text in texts)
        self.clock.at(at, lambda: self.inbox.push_partial(words))

    def word(self, at: float, text: str) -> None:
        self.clock.at(at, lambda: self.inbox.push_word(Word(text, at, at)))

    def run(self) -> None:
        self.session.run()

    @property
    def observed(self) -> list[Observed]:
        return [update.event for _, update in self.told if isinstance(update, Heard)]

    @property
    def acted(self) -> list[Acted]:
        return [update.event for _, update in self.told if isinstance(update, Did)]

    @property
    def beliefs(self) -> list[tuple[float, BeliefChanged]]:
        return [(at, update) for at, update in self.told if isinstance(update, BeliefChanged)]

    @property
    def statuses(self) -> list[tuple[float, str, str]]:
        return [(at, update.name, update.state.value) for at, update in self.told if isinstance(update, SensorStatus)]

    @property
    def ended(self) -> list[str | None]:
        return [update.picked for _, update in self.told if isinstance(update, Ended)]
