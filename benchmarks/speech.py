"""Word errors of our recogniser, and of PocketSphinx's open English model, in the rooms of `conversations.py`.

    python benchmarks/speech.py [--half held-out] [--count 72] [--quick] [--open] [--json] [--cache FOLDER]

What people say in the conversations of a half, a request or an answer each, by its voices, about its tables. Word
error: words put in, left out or changed, over words said. Item words: of those said that are words of the table's
items, the share that was heard. Answers: of sentences of nothing but an answer, the share that was heard as that
answer. False words: item words and answers heard in a sentence about other things. --open: PocketSphinx's open model
of English beside ours, which takes four minutes of a core and more.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from io import BytesIO
from pathlib import Path

import numpy as np
import pocketsphinx

from conversation_sets import HALVES, Half, conversations
from fetch_pomdp.adapters.speech.audio import open_raw
from fetch_pomdp.adapters.speech.recorded import SoundRecognizer
from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber
from fetch_pomdp.adapters.speech.stream import listened_for
from fetch_pomdp.core.language.answers import After, lexicon
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.scene import Scene
from rooms import Room, Samples, as_sound, missing, rooms
from voices import AFTER, BEFORE, RATE, said

ANSWERS = {Meaning.YES, Meaning.NO}
QUICK = 24  # sentences

Transcribe = Callable[[Samples, Scene], list[str]]


@dataclass(frozen=True, slots=True)
class Sentence:
    """What somebody says about a table, or about other things."""

    text: str
    voice: str
    scene: Scene
    answer: bool = False
    meant: bool = True  # for the robot


@dataclass(frozen=True, slots=True)
class Row:
    """What one recogniser got wrong in one room."""

    recogniser: str
    room: str
    sentences: int
    word_error: float
    item_words: float
    answers: float
    false_words: float  # a sentence of other talk
    times_real_time: float


def sentences(half: Half, count: int) -> list[Sentence]:
    """Return requests and answers of a half in turn, and each sentence of its other talk."""
    found: list[Sentence] = []
    for index, plan in enumerate(conversations(half, count)):
        text = (plan.request, plan.yes, plan.again, plan.no)[index % 4]
        alone = plan.no not in {words.format(exact=plan.table.exact[plan.target]) for words in half.sayings.corrections}
        found.append(Sentence(text, plan.voice, plan.table.scene, answer=index % 4 == 1 or (index % 4 == 3 and alone)))
    tables = [table.scene for table in half.tables]
    for index, text in enumerate(half.talk):
        for turn in (0, 1):
            voice = half.voices[(index + turn * len(half.talk)) % len(half.voices)]
            found.append(Sentence(text, voice, tables[(index + turn) % len(tables)], meant=False))
    return found


@cache
def _transcriber(vocabulary: tuple[str, ...]) -> SphinxTranscriber:
    return SphinxTranscriber(vocabulary)


def ours(samples: Samples, scene: Scene) -> list[str]:
    """Transcribe a sound by the code of `fetch --audio`."""
    sound = open_raw(BytesIO(samples.astype("<i2").tobytes()))
    ears = SoundRecognizer(sound, _transcriber(tuple(listened_for(scene))).words)
    return [word.text for word in ears.hear(math.inf)]


def open_model() -> Transcribe:
    """Return PocketSphinx as it comes: the whole sound, the en-us model, its own dither against digital silence."""
    decoder = pocketsphinx.Decoder(dither=True, seed=1, loglevel="FATAL")

    def transcribe(samples: Samples, scene: Scene) -> list[str]:  # noqa: ARG001
        decoder.reinit_feat()
        decoder.start_utt()
        decoder.process_raw(samples.tobytes(), full_utt=True)
        decoder.end_utt()
        return decoder.hyp().hypstr.split() if decoder.hyp() else []

    return transcribe


def sound_of(sentence: Sentence, room: Room, folder: Path, seed: int) -> Samples:
    """Return a sentence in a room, with some of the room before and after it."""
    clip = room.voice(said(sentence.text, sentence.voice, folder))
    begin = int(BEFORE * RATE)
    heard = room.silence(begin + len(clip) + int(AFTER * RATE), seed)
    heard[begin : begin + len(clip)] += clip
    return as_sound(heard)


def edits(said: Sequence[str], heard: Sequence[str]) -> int:
    """Return the words to put in, leave out or change (Levenshtein)."""
    row = list(range(len(heard) + 1))
    for index, word in enumerate(said, 1):
        diagonal, row[0] = row[0], index
        for place, other in enumerate(heard, 1):
            diagonal, row[place] = row[place], min(row[place] + 1, row[place - 1] + 1, diagonal + (word != other))
    return row[-1]


def meaning(words: Sequence[str], scene: Scene) -> Meaning | None:
    """Return what words mean as an answer to a question."""
    return lexicon(scene.answers, scene.words).read(tuple(words), After.QUESTION).meaning


def false_words(heard: Sequence[str], scene: Scene) -> int:
    """Return how many words of items, and answers, were heard."""
    return sum(word in scene.words for word in heard) + (meaning(heard, scene) in ANSWERS)


def measure(name: str, transcribe: Transcribe, room: Room, sounds: Sequence[tuple[Sentence, Samples]]) -> Row:
    """Return how one recogniser hears sentences in a room."""
    begun = time.process_time()
    heard = [(sentence, transcribe(samples, sentence.scene)) for sentence, samples in sounds]
    spent = time.process_time() - begun
    meant = [(sentence, sentence.text.split(), words) for sentence, words in heard if sentence.meant]
    answers = [meaning(words, each.scene) is meaning(text, each.scene) for each, text, words in meant if each.answer]
    items = [_items(text, words, each.scene) for each, text, words in meant]
    others = [false_words(words, each.scene) for each, words in heard if not each.meant]
    return Row(
        name,
        room.name,
        sentences=len(meant),
        word_error=sum(edits(text, words) for _, text, words in meant) / sum(len(text) for _, text, _ in meant),
        item_words=sum(found for found, _ in items) / sum(of for _, of in items),
        answers=float(np.mean(answers)),
        false_words=float(np.mean(others)),
        times_real_time=spent / (sum(len(samples) for _, samples in sounds) / RATE),
    )


def _items(said: Sequence[str], heard: Sequence[str], scene: Scene) -> tuple[int, int]:
    """Return how many item words that were said were heard, and how many were said."""
    spoken = Counter(word for word in said if word in scene.words)
    return (spoken & Counter(heard)).total(), spoken.total()


def table(rows: Iterable[Row]) -> str:
    """Return the rows as a table in Markdown."""
    lines = [
        "| recogniser | room | sentences | word error | item words | answers | false words | real time |",
        "|---" * 8 + "|",
    ]
    for row in rows:
        parts = " | ".join(f"{share:.0%}" for share in (row.word_error, row.item_words, row.answers))
        end = f"{row.false_words:.2f} | {row.times_real_time:.2f}"
        lines.append(f"| {row.recogniser} | {row.room} | {row.sentences} | {parts} | {end} |")
    return "\n".join(lines)


def measured(name: str, transcribe: Transcribe, half: Half, count: int, *, folder: Path) -> Iterator[Row]:
    """Yield how a recogniser hears in each room."""
    spoken = sentences(half, count)
    for room in rooms(half, folder):
        sounds = [(each, sound_of(each, room, folder, seed)) for seed, each in enumerate(spoken)]
        yield measure(name, transcribe, room, sounds)


def main() -> int:
    """Run the benchmark; 2 if a program that speaks is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=list(HALVES), default="held-out")
    parser.add_argument("--count", type=int, default=72, help="sentences in each room")
    parser.add_argument("--quick", action="store_true", help=f"{QUICK} sentences in each room")
    parser.add_argument("--open", action="store_true", help="PocketSphinx's open model of English, too")
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    parser.add_argument("--cache", type=Path, help="folder that keeps the recordings for the next run")
    options = parser.parse_args()
    if packages := missing():
        print(f"not installed: {', '.join(packages)}; install with: apt install {' '.join(packages)}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.cache or Path(temporary)
        count = QUICK if options.quick else options.count
        recognisers = {"ours": ours} | ({"open model": open_model()} if options.open else {})
        rows = [
            row
            for name, transcribe in recognisers.items()
            for row in measured(name, transcribe, HALVES[options.half], count, folder=folder)
        ]
        print(json.dumps([asdict(row) for row in rows], indent=2) if options.json else table(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
