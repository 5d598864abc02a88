"""People without a browser: each talks to a server over a WebSocket of its own, by typing and pointing, or by speaking.

A visitor wants an item, asks for it, answers the robot's questions truly, gets something, and comes anew for the next.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from websockets.asyncio.client import ClientConnection, connect

from sayings import Saying
from voices import BEFORE, RATE

CHUNK = RATE // 25  # samples: 40 ms, as the page sends them
RAYS = 12.5  # a second, while somebody points, as the page sends them
PATIENCE = 12.0  # s until somebody who is not understood says something again
AFTER_QUESTION = 1.4  # s from the beginning of "this one?" to the beginning of an answer: the robot has been heard out
KINDS = {"bowl": "black", "marker": "green", "spoon": "silver"}  # of the ambiguous table, and a word for each
REQUESTS = ("hand me the {kind}", "the {colour} {kind}", "i want the {colour} {kind}")
SENTENCES = tuple(form.format(kind=kind, colour=colour) for form in REQUESTS for kind, colour in KINDS.items())
Message = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Received:
    """A message of the server, and when it came (s, monotonic)."""

    at: float
    message: Message


@dataclass(frozen=True, slots=True)
class Said:
    """A word that was sounded, and when it began, at the earliest, and ended (s, monotonic)."""

    word: str
    start: float
    end: float


@dataclass
class Interaction:
    """One interaction: what was wanted, said and received."""

    wanted: str
    received: list[Received] = field(default_factory=list)
    typed: list[str] = field(default_factory=list)
    said: list[Said] = field(default_factory=list)

    def messages(self, kind: str) -> list[Received]:
        """Return the messages of a kind."""
        return [received for received in self.received if received.message["type"] == kind]

    @property
    def picked(self) -> str | None:
        """The item that was handed over, if one was."""
        given = [received.message for received in self.messages("action") if is_hand_over(received.message)]
        return given[-1]["item"] if given else None


def is_hand_over(message: Message) -> bool:
    """Whether a message tells that an item was handed over; the robot then listens on."""
    return bool(message["type"] == "action" and message["action"] == "pick" and message["outcome"] == "done")


class Visitor:
    """Somebody who types and points. name: a word that nobody else types."""

    def __init__(self, host: str, seed: int) -> None:
        self._host, self._rng = host, np.random.default_rng(seed)
        self.name = f"visitor{seed}"
        self.interactions: list[Interaction] = []
        self.here = asyncio.Event()  # whether the server has said welcome once

    async def come_and_go(self, until: float) -> None:
        """Have interactions until a time (s, monotonic); the last one may be cut short."""
        await asyncio.sleep(self._rng.uniform(0, 2))
        while time.monotonic() < until:
            await asyncio.wait_for(self.interact(), 300)
            await asyncio.sleep(self._rng.uniform(1, 3))

    async def interact(self) -> Interaction:
        """Have one interaction, to the hand-over."""
        origin, address = f"http://{self._host}", f"ws://{self._host}/session"
        async with connect(address, origin=origin, compression=None, proxy=None) as line:  # type: ignore[arg-type]
            seed = int(self._rng.integers(2**31))
            await line.send(json.dumps({"type": "hello", "version": 1, "scene": "ambiguous", "seed": seed}))
            interaction = Interaction(f"{self._rng.choice(list(KINDS))}-{self._rng.integers(1, 3)}")
            self.interactions.append(interaction)
            acting = asyncio.create_task(self._act(line, interaction))
            try:
                async for text in line:
                    interaction.received.append(Received(time.monotonic(), json.loads(text)))
                    self.here.set()
                    if is_hand_over(interaction.received[-1].message):
                        break
            finally:
                acting.cancel()
                with contextlib.suppress(asyncio.CancelledError):
                    await acting
        return interaction

    async def _act(self, line: ClientConnection, interaction: Interaction) -> None:
        asked, since = 0, time.monotonic() - PATIENCE
        while True:
            questions = [received for received in interaction.messages("say") if received.message["key"] == "asks"]
            if len(questions) > asked and time.monotonic() > questions[-1].at + AFTER_QUESTION:
                asked, since = len(questions), time.monotonic()
                about = [
                    received.message["item"]
                    for received in interaction.messages("decided")
                    if received.message["action"] == "point"
                ]
                await self._say(line, interaction, "yes" if about[-1] == interaction.wanted else "no")
            elif self._may_ask(interaction) and time.monotonic() > since + PATIENCE:
                since = time.monotonic()
                await self._ask(line, interaction)
            await asyncio.sleep(0.05)

    def _may_ask(self, interaction: Interaction) -> bool:
        return bool(interaction.received)

    async def _ask(self, line: ClientConnection, interaction: Interaction) -> None:
        kind = interaction.wanted.partition("-")[0]
        form = str(self._rng.choice(REQUESTS))
        await self._say(line, interaction, f"{form.format(kind=kind, colour=KINDS[kind])}, says {self.name}")
        if self._rng.random() < 0.5:
            await self._point(line, interaction)

    async def _say(self, line: ClientConnection, interaction: Interaction, text: str) -> None:
        interaction.typed.append(text)
        await line.send(json.dumps({"type": "typed", "text": text}))

    async def _point(self, line: ClientConnection, interaction: Interaction) -> None:
        """Point at what is wanted for two seconds, with the spread of the model."""
        scene = interaction.messages("welcome")[0].message["scene"]
        head = np.array(scene["head"])
        (item,) = (item for item in scene["items"] if item["id"] == interaction.wanted)
        place = np.array(item["position"]) + self._rng.normal(0, scene["sigma"], 3)
        for _ in range(round(2 * RAYS)):
            wrist = head + 0.6 * (place - head) / np.linalg.norm(place - head) + self._rng.normal(0, 0.01, 3)
            await line.send(json.dumps({"type": "ray", "head": head.tolist(), "wrist": wrist.tolist()}))
            await asyncio.sleep(1 / RAYS)


class Speaker(Visitor):
    """Somebody who speaks into an open microphone, `share` of the time. sayings: what they can say, by its text."""

    def __init__(self, host: str, seed: int, sayings: Mapping[str, Saying], share: float) -> None:
        super().__init__(host, seed)
        self._sayings, self._share = sayings, share
        self._hiss = self._rng.normal(0, next(iter(sayings.values())).noise, 10 * RATE).astype(np.int16)
        self._spoken, self._begun = 0.0, time.monotonic()
        self._next: deque[Saying] = deque()

    async def _act(self, line: ClientConnection, interaction: Interaction) -> None:
        await line.send(json.dumps({"type": "microphone", "on": True}))
        microphone = asyncio.create_task(self._sound(line, interaction))
        try:
            await super()._act(line, interaction)
        finally:
            microphone.cancel()

    def _may_ask(self, interaction: Interaction) -> bool:
        return super()._may_ask(interaction) and self._spoken <= self._share * (time.monotonic() - self._begun)

    async def _ask(self, line: ClientConnection, interaction: Interaction) -> None:
        kind = interaction.wanted.partition("-")[0]
        await self._say(line, interaction, str(self._rng.choice([text for text in self._sayings if kind in text])))

    async def _say(self, line: ClientConnection, interaction: Interaction, text: str) -> None:  # noqa: ARG002
        self._next.append(self._sayings[text])
        self._spoken += self._sayings[text].speech

    async def _sound(self, line: ClientConnection, interaction: Interaction) -> None:
        """Send sound at the pace at which it would be heard."""
        due, rest, hiss = time.monotonic(), np.empty(0, np.int16), 0
        self._next.clear()
        while True:
            if not len(rest) and self._next:
                saying = self._next.popleft()
                times = [due + end for end in (BEFORE, *saying.ends)]
                interaction.said += map(Said, saying.words, times, times[1:])
                rest = saying.samples
            chunk, rest = rest[:CHUNK], rest[CHUNK:]
            if len(chunk) < CHUNK:
                hiss = (hiss + CHUNK) % (len(self._hiss) - CHUNK)
                chunk = np.concatenate([chunk, self._hiss[hiss : hiss + CHUNK - len(chunk)]])
            due += CHUNK / RATE
            await asyncio.sleep(max(0.0, due - time.monotonic()))
            await line.send(chunk.tobytes())
