"""Our recogniser against PocketSphinx's open English model, on one common set of synthetic voices and noise.

    python benchmarks/speech.py [--quick] [--json] [--cache FOLDER]  # 13 minutes of one core; --quick 4

Word error: words put in, left out or changed, over words said, in sentences about the scene. Meaning error: sentences
in which the set of item words and of response classes heard is not the set said. False words: item words and response
classes heard in talk about other things, a sentence. The story: a request for the marker, a question, a "no";
understood if the marker and the no, and nothing else, are heard in one recording.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from io import BytesIO
from pathlib import Path

import pocketsphinx

from fetch_pomdp.adapters.speech.audio import open_raw, open_wav
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.core.language.words import NEGATIVE, POSITIVE
from fetch_pomdp.core.scene import Scene
from voices import RATE, SNRS, VOICES, Recording, missing_tools, read, record

IN_SCENE = (
    "hand me the green marker", "the spoon", "could you give me the black bowl", "i want the silver spoon",
    "yes", "no", "not that one", "the other one",
)  # fmt: skip
OUT_OF_SCENE = (
    "what is the weather today", "the meeting starts at nine", "my brother lives in boston",
    "please turn off the light",
)  # fmt: skip
STORY = ("hand me the marker", "no")
QUICK_VOICES = ("espeak-en-us-175", "espeak-en-gb-130", "flite-slt", "flite-kal16")

VOCABULARY = tuple(dict.fromkeys(word for item in Scene.load("ambiguous").items for word in item.vocabulary))
CLASSES = {word: word for word in VOCABULARY} | dict.fromkeys(POSITIVE, "+") | dict.fromkeys(NEGATIVE, "-")

Transcriber = Callable[[Path], list[str]]


@dataclass(frozen=True, slots=True)
class Row:
    """What one recogniser got wrong at one signal-to-noise ratio."""

    recogniser: str
    snr: int | None  # dB; None is clean
    sentences: int  # about the scene
    word_error: float
    meaning_error: float
    yes_no_right: float  # of "yes" and "no", share whose meaning was right
    false_words: float  # item words and response classes a sentence of other talk
    times_real_time: float


def ours(path: Path) -> list[str]:
    """Transcribe a file by the code a user runs."""
    return [word.text for word in SphinxRecognizer(open_wav(path), VOCABULARY).hear(float("inf"))]


def open_model() -> Transcriber:
    """Return PocketSphinx as it comes: the whole file, the en-us model, its own dither against digital silence."""
    decoder = pocketsphinx.Decoder(dither=True, seed=1, loglevel="FATAL")

    def transcribe(path: Path) -> list[str]:
        decoder.start_utt()
        decoder.process_raw(read(path).tobytes(), full_utt=True)
        decoder.end_utt()
        return decoder.hyp().hypstr.split() if decoder.hyp() else []

    return transcribe


def meaning(words: Iterable[str]) -> frozenset[str]:
    """Return the item words and response classes among the words."""
    return frozenset(CLASSES[word] for word in words if word in CLASSES)


def edits(said: list[str], heard: list[str]) -> int:
    """Return the words to put in, leave out or change (Levenshtein)."""
    row = list(range(len(heard) + 1))
    for index, word in enumerate(said, 1):
        diagonal, row[0] = row[0], index
        for place, other in enumerate(heard, 1):
            diagonal, row[place] = row[place], min(row[place] + 1, row[place - 1] + 1, diagonal + (word != other))
    return row[-1]


def measure(name: str, transcribe: Transcriber, recordings: list[Recording]) -> Iterator[Row]:
    """Yield a row for every signal-to-noise ratio."""
    for snr in SNRS:
        started = time.perf_counter()
        heard = [(item.text, transcribe(item.path)) for item in recordings if item.snr == snr]
        spent = time.perf_counter() - started
        inside = [(text.split(), words) for text, words in heard if text in IN_SCENE]
        outside = [words for text, words in heard if text in OUT_OF_SCENE]
        answers = [(said, words) for said, words in inside if said in (["yes"], ["no"])]
        yield Row(
            recogniser=name,
            snr=snr,
            sentences=len(inside),
            word_error=sum(edits(*pair) for pair in inside) / sum(len(said) for said, _ in inside),
            meaning_error=1 - _understood(inside),
            yes_no_right=_understood(answers),
            false_words=sum(len(meaning(words)) for words in outside) / len(outside),
            times_real_time=spent / sum(seconds(item.path) for item in recordings if item.snr == snr),
        )


def _understood(pairs: list[tuple[list[str], list[str]]]) -> float:
    return sum(meaning(said) == meaning(heard) for said, heard in pairs) / len(pairs)


def seconds(path: Path) -> float:
    """Return the length of a WAV file."""
    return len(read(path)) / RATE


def story(folder: Path, voices: tuple[str, ...], snr: int) -> dict[str, list[str]]:
    """Let every voice say the request and, in the same recording, the answer; return what our recogniser heard."""
    heard = {}
    for voice in voices:
        samples = b"".join(
            read(item.path).tobytes() for text in STORY for item in record([text], folder, [voice], [snr])
        )
        heard[voice] = [
            word.text for word in SphinxRecognizer(open_raw(BytesIO(samples)), VOCABULARY).hear(float("inf"))
        ]
    return heard


def table(rows: list[Row]) -> str:
    """Return the rows as a table in Markdown."""
    lines = [
        "| recogniser | SNR | word error | meaning error | yes/no right | false words | times real time |",
        "|---" * 7 + "|",
    ]
    for row in rows:
        snr = "clean" if row.snr is None else f"{row.snr} dB"
        parts = (f"{share:.0%}" for share in (row.word_error, row.meaning_error, row.yes_no_right))
        lines.append(
            f"| {row.recogniser} | {snr} | {' | '.join(parts)} | {row.false_words:.2f} | {row.times_real_time:.2f} |"
        )
    return "\n".join(lines)


def main() -> int:
    """Run the benchmark; 2 if a program that speaks is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="4 voices instead of 14")
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    parser.add_argument("--cache", type=Path, help="folder that keeps the recordings for the next run")
    arguments = parser.parse_args()
    if missing := missing_tools():
        print(f"not installed: {', '.join(missing)}; install with: apt install {' '.join(missing)}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.cache or Path(temporary)
        voices = QUICK_VOICES if arguments.quick else VOICES
        recordings = record(IN_SCENE + OUT_OF_SCENE, folder, voices)
        recognisers = {"ours": ours, "open en-us": open_model()}
        rows = [row for name, transcribe in recognisers.items() for row in measure(name, transcribe, recordings)]
        told = story(folder, voices, snr=20)
    right = sum(meaning(words) == meaning(" ".join(STORY).split()) for words in told.values())
    if arguments.json:
        print(
            json.dumps({"rows": [asdict(row) for row in rows], "story": {"understood": right, "heard": told}}, indent=2)
        )
    else:
        print(f"{table(rows)}\n\nStory at 20 dB: {right} of {len(told)} voices understood.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
