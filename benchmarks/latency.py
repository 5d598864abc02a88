"""How long a served robot takes: a real server, people on WebSockets, sound at the pace at which it is heard.

    python benchmarks/latency.py [--json] [--snr 20] [--cache FOLDER]     # 9 minutes; Linux, apt install chromium
    python benchmarks/latency.py --alone 0 --no-page --people 50            # the last part alone
    python benchmarks/latency.py --docs docs/live.md [--from FILE]          # writes the tables of that page

1. One person speaks, alone on the server: from the end of a word to the arrival of the belief message that it moves.
2. The page in Chromium, whose fake microphone plays sentences: from the end of an item's word, in the sound as it
   leaves the page, to the change of the bars in the document. What a real microphone and screen take comes on top.
3. Fifty at once: ten speak a fifth of the time into open microphones, the others type and point. The same delays; how
   long a decision takes, from the step's end to the message about it, both by the server's clock in its
   messages; memory. The people run in one process beside the server, on the same cores: its cost is printed, too.

A word's end is where a forced alignment of the clean recording puts it, and not what the recogniser believes; words
count that are about an item or answer a question. One that was not heard within 3 s counts as missed.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import tempfile
import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

import latency_report
from sayings import say, say_all
from serving import Served, Spent
from visitors import KINDS, SENTENCES, Interaction, Speaker, Visitor
from voices import missing_tools
from watched import Delays, watch

VOICES = ("espeak-en-us-175", "flite-slt", "espeak-en-gb-130", "flite-rms")
TEXTS = (*SENTENCES, "yes", "no")
MOVING = frozenset([*KINDS, *KINDS.values(), "yes", "no"])  # words that move a bar
LEAST = 0.005  # change of a belief that a bar shows
MISSED = 3.0  # s
SHARE = 0.2  # of the time that a speaker speaks


def word_delays(interactions: Sequence[Interaction]) -> Delays:
    """Return how long after its end each word moved a bar; one that is heard and moves none does not count."""
    delays, missed = [], 0
    for interaction in interactions:
        beliefs = interaction.messages("belief")
        for said in interaction.said:
            if said.word not in MOVING or said.end + MISSED > interaction.received[-1].at:
                continue  # no matter of a bar, or the interaction was over
            heard = [
                (before.message["belief"], received)
                for before, received in pairwise(beliefs)
                if said.start <= received.at <= said.end + MISSED and said.word in received.message["heard"]
            ]
            missed += not heard
            moved = (received.at for before, received in heard if _change(before, received.message["belief"]) >= LEAST)
            delays += [at - said.end for at in [next(moved, None)] if at is not None]
    return Delays(delays, missed)


def _change(before: dict[str, float], after: dict[str, float]) -> float:
    return max(abs(after[item] - before[item]) for item in after)


def decision_times(interactions: Sequence[Interaction]) -> list[float]:
    """Return how long (s) each decision took, by the server's clock: from the step's end to the message about it."""
    times = []
    for interaction in interactions:
        ended = None
        for message in (received.message for received in interaction.received):
            if message["type"] == "belief" and not message["provisional"]:
                ended = message["t"]
            elif message["type"] == "decided" and ended is not None:
                times.append(message["t"] - ended)
                ended = None
    return times


def delivery_times(interactions: Sequence[Interaction]) -> list[float]:
    """Return by how much (s) later than the promptest of its interaction each decision arrived."""
    times = []
    for interaction in interactions:
        lags = [received.at - received.message["t"] for received in interaction.messages("decided")]
        times += [lag - min(lags) for lag in lags]
    return times


def summary(values: Sequence[float]) -> dict[str, float]:
    """Return count, median, p90, p99 and maximum (s)."""
    quantiles = {name: float(np.quantile(values, q)) if values else float("nan") for name, q in _QUANTILES.items()}
    return {"count": len(values), **{name: round(value, 4) for name, value in quantiles.items()}}


_QUANTILES = {"median": 0.5, "p90": 0.9, "p99": 0.99, "longest": 1.0}


def outcome(interactions: Sequence[Interaction]) -> dict[str, Any]:
    """Return what came of interactions."""
    over = [interaction for interaction in interactions if interaction.picked is not None]
    delays = word_delays(interactions)
    return {
        "interactions": len(interactions),
        "handed_over": len(over),
        "right": sum(interaction.picked == interaction.wanted for interaction in over),
        "word_to_bar_s": {**summary(delays.delays), "missed": delays.missed},
        "decision_s": summary(decision_times(interactions)),
        "decision_told_late_s": summary(delivery_times(interactions)),
    }


async def alone(host: str, seconds: float, snr: int, folder: Path) -> dict[str, Any]:
    """Let one person after the other speak, each alone on the server."""
    interactions: list[Interaction] = []
    for seed, voice in enumerate(VOICES):
        speaker = Speaker(host, seed, say_all(TEXTS, voice, snr, folder), share=1.0)
        await speaker.come_and_go(time.monotonic() + seconds / len(VOICES))
        interactions += speaker.interactions
    return outcome(interactions)


async def crowd(served: Served, options: argparse.Namespace, before: Spent) -> dict[str, Any]:
    """Let all come, the speakers first; return what was measured."""
    sayings = {voice: say_all(TEXTS, voice, options.snr, options.cache) for voice in VOICES}
    speakers: list[Visitor] = [
        Speaker(served.host, seed, sayings[VOICES[seed % len(VOICES)]], SHARE) for seed in range(options.speakers)
    ]
    typists = [Visitor(served.host, seed) for seed in range(options.speakers, options.people)]
    until = time.monotonic() + options.seconds
    async with asyncio.TaskGroup() as group:
        for visitor in speakers:
            group.create_task(visitor.come_and_go(until))
        await asyncio.sleep(min(20.0, options.seconds / 4))
        few = served.spent()
        for visitor in typists:
            group.create_task(visitor.come_and_go(until))
        await asyncio.gather(*(visitor.here.wait() for visitor in typists))
        begun, cpu, own = time.monotonic(), served.spent().cpu, time.process_time()
        await asyncio.sleep(max(0.0, until - time.monotonic() - 2.0))
        many = served.spent()
        spent = time.monotonic() - begun
        took, own = many.cpu - cpu, time.process_time() - own
    interactions = [interaction for visitor in (*speakers, *typists) for interaction in visitor.interactions]
    return {
        "memory_mb": {"0": before.memory, str(options.speakers): few.memory, str(options.people): many.memory},
        "cores": {"server": round(took / spent, 2), "people": round(own / spent, 2)},
        "speakers": outcome([interaction for visitor in speakers for interaction in visitor.interactions]),
        "typists": outcome([interaction for visitor in typists for interaction in visitor.interactions]),
        "all": {
            "decision_s": summary(decision_times(interactions)),
            "decision_told_late_s": summary(delivery_times(interactions)),
        },
    }


async def measure(options: argparse.Namespace) -> dict[str, Any]:
    """Measure one person, then many."""
    options.cache.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as data, Served("--data", data) as served:
        found: dict[str, Any] = {"cores": os.cpu_count(), "load_before": os.getloadavg()[0], "snr": options.snr}
        await Visitor(served.host, 0).interact()  # the planner is compiled, the table solved
        if options.alone:
            found["alone"] = await alone(served.host, options.alone, options.snr, options.cache)
        else:
            await Speaker(served.host, 0, say_all(TEXTS, VOICES[0], options.snr, options.cache), 1.0).interact()
        if options.page:
            sayings = [
                say(f"hand me the {kind}", voice, options.snr, options.cache) for voice in VOICES for kind in KINDS
            ]
            watched = await watch(served.host, sayings, Path(data))
            found["page_word_to_bar_s"] = {**summary(watched.delays), "missed": watched.missed}
        if options.people:
            found["people"] = options.people
            found["crowd"] = await crowd(served, options, served.spent())
    return found


def main() -> None:
    """Measure, and print Markdown or JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--alone", type=float, default=160.0, metavar="SECONDS", help="0: leave out the first part")
    parser.add_argument("--page", action=argparse.BooleanOptionalAction, default=True, help="the second part")
    parser.add_argument("--people", type=int, default=50, help="0: leave out the third part")
    parser.add_argument("--speakers", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=120.0, help="of the third part")
    parser.add_argument("--snr", type=int, default=20, help="dB")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--docs", type=Path, metavar="FILE", help="Markdown document whose tables to write anew")
    parser.add_argument("--from", dest="saved", type=Path, metavar="FILE", help="what --json printed before")
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "fetch-pomdp-voices")
    options = parser.parse_args()
    if missing := missing_tools():
        parser.error(f"not installed: {', '.join(missing)}; install with: apt install {' '.join(missing)}")
    found = json.loads(options.saved.read_text()) if options.saved else asyncio.run(measure(options))
    if options.docs:
        latency_report.write(options.docs, latency_report.report(found))
    print(json.dumps(found, indent=2) if options.json else latency_report.report(found))


if __name__ == "__main__":
    main()
