"""How long the ears take from the end of a word to the first hypothesis with it, and until it is final.

    python benchmarks/latency_ears.py [--snr 20] [--json] [--cache FOLDER]      # half a minute

One speaker is heard with a core to themselves: the sound comes as fast as it would, and what is computed takes as long
as its processor time, so that other programs do not count. The end of a word is where the decoder puts it. By the clock
on the wall, with a server between: latency.py.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fetch_pomdp.adapters.speech.silero import Silero, model
from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber
from fetch_pomdp.adapters.speech.stream import Stream, listened_for
from fetch_pomdp.adapters.speech.utterances import Transcriber
from fetch_pomdp.core.ports import Word
from fetch_pomdp.core.scene import Scene
from voices import RATE, missing_tools, read, record

SENTENCES = ("the marker", "hand me the green marker", "the silver spoon", "yes", "no", "i want the black bowl")
VOICES = ("espeak-en-us-175", "flite-slt", "espeak-en-gb-130", "flite-rms")
CHUNK = RATE // 20  # samples: 50 ms, as a browser sends them
PAUSE = 1.5  # s between sentences


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """What the ears told at a time (s): a hypothesis or, when it is final, a word."""

    at: float
    words: tuple[Word, ...]
    final: bool


def alone(sounds: list[np.ndarray], transcriber: Transcriber, loaded: object) -> tuple[list[float], list[float]]:
    """Return the delays (s) of words from their ends to the first hypothesis with them, and until they are final."""
    heard: list[Hypothesis] = []
    now = free = 0.0

    def tell(words: tuple[Word, ...] | None, *, final: bool) -> None:
        heard.append(Hypothesis(now + time.process_time() - begun, words or (), final))

    stream = Stream(
        transcriber, Silero(loaded), lambda words: tell(words, final=False), lambda word: tell((word,), final=True),
        time.process_time,
    )  # fmt: skip
    sound = np.concatenate(sounds)
    chunks = [(sound[first : first + CHUNK], first / RATE) for first in range(0, len(sound), CHUNK)]
    while chunks:
        now = max(free, chunks[0][1] + CHUNK / RATE)
        begun = time.process_time()
        while chunks and chunks[0][1] + CHUNK / RATE <= now:
            stream.feed(*chunks.pop(0))
        stream.guess()
        free = now + time.process_time() - begun
    words = [(entry.at, entry.words[0]) for entry in heard if entry.final]
    return [_shown(word, heard) - word.end for _, word in words], [at - word.end for at, word in words]


def _shown(word: Word, heard: list[Hypothesis]) -> float:
    return next(
        entry.at
        for entry in heard
        if any(guess.text == word.text and abs(guess.end - word.end) < 0.3 for guess in entry.words)
    )


def main() -> None:
    """Measure, and print a table or JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--snr", type=int, default=20)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "fetch-pomdp-voices")
    options = parser.parse_args()
    if missing := missing_tools():
        parser.error(f"not installed: {', '.join(missing)}; install with: apt install {' '.join(missing)}")
    gap = np.random.default_rng(0).normal(0, 20, round(PAUSE * RATE)).astype(np.int16)

    def spoken(voice: str) -> list[np.ndarray]:
        made = record(SENTENCES, options.cache, [voice], [options.snr])
        return [part for recording in made for part in (read(recording.path), gap)]

    transcriber = SphinxTranscriber(listened_for(Scene.load("ambiguous")))
    delays = [alone(spoken(voice), transcriber, model()) for voice in VOICES]
    report(delays, as_json=options.json)


def report(delays: list[tuple[list[float], list[float]]], *, as_json: bool) -> None:
    """Print median and 90th percentile."""
    rows = {
        name: [delay for pair in delays for delay in pair[index]]
        for index, name in enumerate(("end of a word to the hypothesis", "end of a word to its being final"))
    }
    found = {
        name: {"words": len(row), "median_s": float(np.median(row)), "p90_s": float(np.quantile(row, 0.9))}
        for name, row in rows.items()
    }
    if as_json:
        print(json.dumps(found))
        return
    for name, row in found.items():
        print(f"{name}: median {row['median_s']:.2f} s, 90% within {row['p90_s']:.2f} s, {row['words']} words")


if __name__ == "__main__":
    main()
