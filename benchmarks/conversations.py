"""Spoken conversations with the robot, from sound to the item handed over: in quiet, in noise, among others who talk,
and in an echoing room.

    python benchmarks/conversations.py [--half held-out] [--count 100] [--quick] [--json] [--cache FOLDER]

A synthetic voice asks for an item, answers the robot's questions by what it wants, and asks again when the robot says
that it listens. The ears, the belief and the robot's decisions are those of `fetch-pomdp fetch --audio`; only the
person's side is made. A conversation ends right if the item wanted is the one handed over within a minute.

against a no: conversations that hand over an item about which the last answer that the ears heard was a no.
--half tuning is what the ears were tuned on, held-out what they were measured on (`conversation_sets.py`).
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from conversation_sets import HALVES, Conversation, conversations
from fetch_pomdp import Agent, Item, Outcome, Pick, Point, interact
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.hearing import texts
from fetch_pomdp.core.interaction import LISTENING
from fetch_pomdp.core.language.answers import After
from fetch_pomdp.core.language.reading.reader import Reader
from fetch_pomdp.core.language.words import Meaning
from rooms import Room, Samples, as_sound, missing, rooms
from voices import RATE, said

ASKING = 1.8  # s, after which the robot has asked
REPEATS = 9.0  # s in which neither speaks, after which the person asks again
LONGEST = 60.0  # s


class Still:
    """A Robot to whom nothing happens."""

    def point(self, item: Item) -> Outcome:  # noqa: ARG002
        """Ask about an item."""
        return Outcome.DONE

    def pick(self, item: Item) -> Outcome:  # noqa: ARG002
        """Hand an item over."""
        return Outcome.DONE

    def take_back(self, item: Item) -> Outcome:  # noqa: ARG002
        """Take an item back."""
        return Outcome.DONE

    def say(self, text: str) -> Outcome:  # noqa: ARG002
        """Say something."""
        return Outcome.DONE

    def stop(self) -> None:
        """Nothing that it does is stopped."""


class Person(Still):
    """A person in a room: a Sound with their voice in it, and a Robot who does to them what robots do."""

    def __init__(self, plan: Conversation, room: Room, folder: Path) -> None:
        self._plan, self._room, self._folder = plan, room, folder
        self._heard = room.silence(int((LONGEST + 30) * RATE), plan.seed)
        self._time = 0  # samples
        self._quiet_since = 0
        self._say(plan.request, plan.begins)

    @property
    def time(self) -> float:
        """How much (s) was heard of them."""
        return self._time / RATE

    def read(self, count: int) -> Samples:
        """Return what comes next; see Sound."""
        if self._time - self._quiet_since > REPEATS * RATE:
            self._say(self._plan.again, 0.1)
        self._time += count
        return as_sound(self._heard[self._time - count : self._time])

    def point(self, item: Item) -> Outcome:
        """Be asked: answer by what is wanted."""
        table, target = self._plan.table, self._plan.target
        asked = table.scene.items.index(item)
        text = self._plan.yes if asked == target else self._plan.no
        if asked != target and "other" in text and table.loose[asked] != table.loose[target]:
            text = "no"  # there is no other one of what it points at
        self._say(text, ASKING + self._plan.thinks)
        return Outcome.DONE

    def say(self, text: str) -> Outcome:
        """Be told something; ask again when the robot says that it listens."""
        if text == LISTENING and self._quiet_since < self._time:
            self._say(self._plan.again, 1.0)
        return Outcome.DONE

    def _say(self, text: str, later: float) -> None:
        clip = self._room.voice(said(text, self._plan.voice, self._folder))
        start = max(self._time, self._quiet_since) + int(later * RATE)
        self._quiet_since = min(start + len(clip), len(self._heard))
        self._heard[start : start + len(clip)] += clip[: max(0, len(self._heard) - start)]


@dataclass(frozen=True, slots=True)
class Result:
    """How a conversation ended."""

    room: str
    right: bool
    picked: str | None
    against_no: bool  # the last answer heard about the item was a no
    refused: bool  # the person said no to the item
    questions: int
    seconds: float
    spent: float  # s of a core


def played(
    plan: Conversation,
    room: Room,
    folder: Path,
    *,
    reader: Reader | None = None,
    watch: Callable[[Event, Agent], None] | None = None,
) -> Result:
    """Play a conversation. reader: the robot's; watch: is told each event."""
    begun = time.process_time()
    agent, person = Agent(plan.table.scene, reader=reader), Person(plan, room, folder)
    ears = SphinxRecognizer(person, agent.scene.words)
    picked, asked, heard = None, list[int](), dict[int, Meaning]()
    for event in interact(agent, person, ears, None):
        if watch is not None:
            watch(event, agent)
        if isinstance(event, Acted) and isinstance(event.action, Pick):
            picked = event.action.item
        elif isinstance(event, Acted) and isinstance(event.action, Point):
            asked.append(event.action.item)
        elif isinstance(event, Observed) and asked:
            meaning = agent.answers.read(texts(event.words), After.QUESTION).meaning
            if meaning in {Meaning.YES, Meaning.NO}:
                heard[asked[-1]] = meaning
        if person.time > LONGEST:
            break
    return Result(
        room.name,
        right=picked == plan.target,
        picked=None if picked is None else agent.scene.items[picked].id,
        against_no=picked is not None and heard.get(picked) is Meaning.NO,
        refused=picked in asked and picked != plan.target,
        questions=len(asked),
        seconds=person.time,
        spent=time.process_time() - begun,
    )


def table(results: Mapping[str, Sequence[Result]]) -> str:
    """Return the results as a table in Markdown."""
    head = "| room | conversations | right | wrong | nothing | against a no | questions | time | of a core |"
    lines = [head, "|---" * 9 + "|"]
    for name, row in results.items():
        count = len(row)
        right = sum(result.right for result in row)
        nothing = sum(result.picked is None for result in row)
        shares = " | ".join(f"{part / count:.0%}" for part in (right, count - right - nothing, nothing))
        against = sum(result.against_no for result in row)
        means = (np.mean([getattr(result, name) for result in row]) for name in ("questions", "seconds", "spent"))
        asked, seconds, spent = map(float, means)
        lines.append(f"| {name} | {count} | {shares} | {against} | {asked:.1f} | {seconds:.0f} s | {spent:.1f} s |")
    return "\n".join(lines)


def main() -> int:
    """Run the benchmark; 2 if a program that speaks is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=list(HALVES), default="held-out")
    parser.add_argument("--count", type=int, default=100, help="conversations in each room")
    parser.add_argument("--quick", action="store_true", help="12 conversations in each room")
    parser.add_argument("--room", action="append", help="this room alone; may be given again")
    parser.add_argument("--json", action="store_true", help="print JSON, a line a conversation")
    parser.add_argument("--cache", type=Path, help="folder that keeps the recordings for the next run")
    options = parser.parse_args()
    if packages := missing():
        print(f"not installed: {', '.join(packages)}; install with: apt install {' '.join(packages)}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        folder, half = options.cache or Path(temporary), HALVES[options.half]
        plans = conversations(half, 12 if options.quick else options.count)
        results: dict[str, list[Result]] = {}
        for room in rooms(half, folder):
            if options.room and room.name not in options.room:
                continue
            for plan in plans:
                result = played(plan, room, folder)
                results.setdefault(room.name, []).append(result)
                if options.json:
                    print(json.dumps(asdict(result) | {"request": plan.request, "voice": plan.voice}), flush=True)
    if not options.json:
        print(table(results))
    return 0


if __name__ == "__main__":
    sys.exit(main())
