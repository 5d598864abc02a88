"""Talk that is not meant for the robot: how often it makes the robot do something.

    python benchmarks/bystanders.py [--half held-out] [--voices 4] [--json] [--cache FOLDER]

A radio, or somebody on the telephone, is the only voice there is and as loud as a person who speaks to the robot; each
sentence is heard by a robot of its own, once before anything was asked and once while a question is open. Idle: how
often it then asks or hands over within 12 s. Asked: how often the sentence counts as an answer to the question.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from conversation_sets import HALVES, OTHERS, Half, Table
from conversations import Still
from fetch_pomdp import Agent, Pick, Point, interact
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.adapters.speech.stream import listened_for
from fetch_pomdp.core.events import Acted, Observed
from fetch_pomdp.core.language.answers import After
from fetch_pomdp.core.language.reading.reader import TableReader
from fetch_pomdp.core.language.words import Meaning
from rooms import LOUDNESS, Samples, as_sound, missing
from voices import RATE, said

QUIET = 20.0  # of 32768, root mean square of the room's noise
BEGINS, LONGEST = 0.7, 12.0  # s


@dataclass(frozen=True, slots=True)
class Result:
    """What a robot made of a sentence."""

    kind: str
    text: str
    voice: str
    heard: str
    acted: bool
    answered: bool


class Overheard:
    """A Sound: a sentence in a quiet room, which goes on."""

    def __init__(self, text: str, voice: str, folder: Path) -> None:
        clip = said(text, voice, folder).astype(float)
        self._heard = np.random.default_rng(0).standard_normal(int(2 * LONGEST * RATE)) * QUIET
        begin = int(BEGINS * RATE)
        self._heard[begin : begin + len(clip)] += clip * LOUDNESS / math.sqrt(np.mean(clip**2))
        self.time = 0  # samples

    def read(self, count: int) -> Samples:
        """Return what comes next; see Sound."""
        self.time += count
        return as_sound(self._heard[self.time - count : self.time])


def overheard(kind: str, text: str, voice: str, *, table: Table, folder: Path) -> Result:
    """Let a robot hear a sentence."""
    agent, sound = Agent(table.scene, reader=TableReader()), Overheard(text, voice, folder)
    heard, acted = list[str](), False
    for event in interact(agent, Still(), SphinxRecognizer(sound, listened_for(agent.scene)), None):
        if isinstance(event, Observed):
            heard += [word.text for word in event.words]
        acted = acted or (isinstance(event, Acted) and isinstance(event.action, Pick | Point))
        if acted or sound.time > LONGEST * RATE:
            break
    meaning = agent.answers.read(tuple(heard), After.QUESTION).meaning
    return Result(kind, text, voice, " ".join(heard), acted, answered=meaning in {Meaning.YES, Meaning.NO})


def results(half: str, voices: int, folder: Path) -> Iterator[Result]:
    """Yield what robots at the tables of a half make of its other talk."""
    of: Half = HALVES[half]
    for kind, texts in OTHERS[half].items():
        for index, text in enumerate(texts):
            for turn in range(voices):
                voice = of.voices[(index + turn * len(of.voices) // voices) % len(of.voices)]
                yield overheard(kind, text, voice, table=of.tables[(index + turn) % len(of.tables)], folder=folder)


def table_of(found: Mapping[str, Sequence[Result]]) -> str:
    """Return the results as a table in Markdown."""
    lines = ["| talk | sentences | idle: it acts | asked: an answer |", "|---" * 4 + "|"]
    for kind, row in found.items():
        acted, answered = (sum(getattr(each, name) for each in row) / len(row) for name in ("acted", "answered"))
        lines.append(f"| {kind} | {len(row)} | {acted:.0%} | {answered:.0%} |")
    return "\n".join(lines)


def main() -> int:
    """Run the benchmark; 2 if a program that speaks is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=list(HALVES), default="held-out")
    parser.add_argument("--voices", type=int, default=4, help="voices that say each sentence")
    parser.add_argument("--json", action="store_true", help="print JSON, a line a sentence")
    parser.add_argument("--cache", type=Path, help="folder that keeps the recordings for the next run")
    options = parser.parse_args()
    if packages := missing():
        print(f"not installed: {', '.join(packages)}; install with: apt install {' '.join(packages)}", file=sys.stderr)
        return 2
    found: dict[str, list[Result]] = {}
    with tempfile.TemporaryDirectory() as temporary:
        for result in results(options.half, options.voices, options.cache or Path(temporary)):
            found.setdefault(result.kind, []).append(result)
            if options.json:
                print(json.dumps(asdict(result)), flush=True)
    if not options.json:
        print(table_of(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
