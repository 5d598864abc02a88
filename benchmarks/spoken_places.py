"""Items described by where they are, said aloud: from sound through the reader to the item handed over.

    python benchmarks/spoken_places.py [--half held-out] [--voices 10] [--room quiet] [--json] [--cache FOLDER]

Conversations as in `conversations.py`, with the robot that reads by `TableReader`. The item wanted is the one that the
written sentence says to the reader: what is measured is the ears. Each sentence is said by several voices; those of the
held-out half are sentences, tables and voices that nothing was tuned on.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from conversation_sets import HALVES, PLACES, Conversation, Table
from conversations import Result, played
from fetch_pomdp.core.language.reading.reader import Context, TableReader
from rooms import missing, rooms

ROOM = "quiet"


def plans(half: str, voices: int) -> list[Conversation]:
    """Return a conversation for each sentence of a half and each of its voices."""
    reader, found = TableReader(), list[Conversation]()
    for table, sentences in PLACES[half]:
        for text in sentences:
            heard = reader.read(tuple(text.split()), table.scene, Context())
            target = int(heard.log_likelihood.argmax())
            for voice in HALVES[half].voices[:voices]:
                found.append(_wanting(table, target, text, voice))
    return found


def _wanting(table: Table, target: int, text: str, voice: str) -> Conversation:
    return Conversation(
        table, target, voice, request=text, again=text, yes="yes", no="no", begins=1.0, thinks=0.3, seed=0
    )


def table_of(results: Mapping[str, Sequence[Result]]) -> str:
    """Return the results of each sentence as a table in Markdown."""
    lines = ["| sentence | voices | right | wrong | questions |", "|---" * 5 + "|"]
    together = [result for row in results.values() for result in row]
    for text, row in (*results.items(), ("all", together)):
        right, wrong = sum(each.right for each in row), sum(each.picked is not None and not each.right for each in row)
        questions = sum(each.questions for each in row) / len(row)
        lines.append(f"| {text} | {len(row)} | {right} | {wrong} | {questions:.1f} |")
    return "\n".join(lines)


def main() -> int:
    """Run the benchmark; 2 if a program that speaks is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=list(HALVES), default="held-out")
    parser.add_argument("--voices", type=int, default=10, help="voices that say each sentence")
    parser.add_argument("--room", default=ROOM, help="a room of conversations.py")
    parser.add_argument("--json", action="store_true", help="print JSON, a line a conversation")
    parser.add_argument("--cache", type=Path, help="folder that keeps the recordings for the next run")
    options = parser.parse_args()
    if packages := missing():
        print(f"not installed: {', '.join(packages)}; install with: apt install {' '.join(packages)}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        folder, results = options.cache or Path(temporary), dict[str, list[Result]]()
        room = next(room for room in rooms(HALVES[options.half], folder) if room.name == options.room)
        for plan in plans(options.half, options.voices):
            result = played(plan, room, folder, reader=TableReader())
            results.setdefault(plan.request, []).append(result)
            if options.json:
                print(json.dumps(asdict(result) | {"request": plan.request, "voice": plan.voice}), flush=True)
    if not options.json:
        print(table_of(results))
    return 0


if __name__ == "__main__":
    sys.exit(main())
