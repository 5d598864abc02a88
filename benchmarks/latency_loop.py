"""How long the live loop takes from the end of a word to the belief it moves, and to the step's end.

    python benchmarks/latency_loop.py [--snr 20] [--json] [--cache FOLDER]      # half a minute
    python benchmarks/latency_loop.py --speakers 2                              # the same by the clock on the wall

Alone, one speaker is heard with a core to themselves: the sound comes as fast as it would, and what is computed takes
as long as its processor time, so that other programs do not count. With --speakers, each says the sentences to a
session of their own, all at once and through one recogniser, in real time. The end of a word is where the decoder puts
it; a word counts from there to the first belief that it is part of, hypothesis or final.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fetch_pomdp.adapters.speech.silero import Silero, model
from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber
from fetch_pomdp.adapters.speech.stream import Stream, StreamingRecognizer, listened_for
from fetch_pomdp.adapters.speech.transcriber import Transcriber
from fetch_pomdp.adapters.speech.worker import SphinxProcess
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.live import BeliefChanged, Heard, Inbox, LiveSession, Update
from fetch_pomdp.core.ports import Outcome, Word
from fetch_pomdp.core.scene import Item, Scene
from voices import RATE, missing_tools, read, record

SENTENCES = ("the marker", "hand me the green marker", "the silver spoon", "yes", "no", "i want the black bowl")
VOICES = ("espeak-en-us-175", "flite-slt", "espeak-en-gb-130", "flite-rms")
CHUNK = RATE // 20  # samples: 50 ms, as a browser sends them
PAUSE = 1.5  # s between sentences


@dataclass(frozen=True, slots=True)
class Told:
    """What the ears told at a time (s): a hypothesis or, when it is final, a word."""

    at: float
    words: tuple[Word, ...]
    final: bool


def alone(sounds: list[np.ndarray], transcriber: Transcriber, loaded: object) -> tuple[list[float], list[float]]:
    """Return the delays (s) of words from their ends to the first hypothesis with them, and until they are final."""
    told: list[Told] = []
    now = free = 0.0

    def tell(words: tuple[Word, ...] | None, *, final: bool) -> None:
        told.append(Told(now + time.process_time() - begun, words or (), final))

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
    words = [(entry.at, entry.words[0]) for entry in told if entry.final]
    return [_shown(word, told) - word.end for _, word in words], [at - word.end for at, word in words]


def _shown(word: Word, told: list[Told]) -> float:
    return next(
        entry.at
        for entry in told
        if any(guess.text == word.text and abs(guess.end - word.end) < 0.3 for guess in entry.words)
    )


class Nobody:
    """A robot without a body, which never hands over, so that the interaction goes on."""

    def point(self, item: Item) -> Outcome:  # noqa: ARG002
        """Ask nothing."""
        return Outcome.DONE

    def pick(self, item: Item) -> Outcome:  # noqa: ARG002
        """Fail."""
        return Outcome.FAILED

    def say(self, text: str) -> Outcome:  # noqa: ARG002
        """Say nothing."""
        return Outcome.DONE

    def stop(self) -> None:
        """Stop nothing."""


@dataclass
class Speaker:
    """A session, and when it told what."""

    inbox: Inbox = field(default_factory=Inbox)
    told: list[tuple[float, Update]] = field(default_factory=list)

    def begin(self, agent: Agent, recogniser: SphinxProcess, loaded: object) -> None:
        """Begin to listen."""
        self.session = LiveSession(agent, Nobody(), self.inbox, listener=self.listen)
        now = self.session.clock.now
        transcriber = recogniser.transcriber(listened_for(agent.scene))
        self.ears = StreamingRecognizer(
            transcriber, Silero(loaded), self.inbox.push_partial, self.inbox.push_word,
            on_alive=lambda: self.inbox.alive("speech", now()), clock=now,
        )  # fmt: skip
        threading.Thread(target=self.session.run, daemon=True).start()

    def listen(self, update: Update) -> None:
        """Note an update and its time."""
        self.told.append((self.session.clock.now(), update))

    def speak(self, sounds: list[np.ndarray]) -> None:
        """Push sounds as a microphone would."""
        due = time.monotonic()
        for sound in sounds:
            for first in range(0, len(sound), CHUNK):
                due += CHUNK / RATE
                time.sleep(max(0.0, due - time.monotonic()))
                self.ears.feed(sound[first : first + CHUNK].tobytes())

    def delays(self) -> tuple[list[float], list[float]]:
        """Return how long (s) each final word took to be shown, and to be taken in."""
        shown, taken = [], []
        for at, update in self.told:
            for word in update.event.words if isinstance(update, Heard) else ():
                taken.append(at - word.end)
                if (first := self._first(word)) is not None:
                    shown.append(first - word.end)
        return shown, taken

    def _first(self, word: Word) -> float | None:
        return next(
            (
                at
                for at, update in self.told
                if isinstance(update, BeliefChanged) and at >= word.end - 0.2 and word.text in update.words
            ),
            None,
        )


def main() -> None:
    """Measure, and print a table or JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--speakers", type=int)
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

    if options.speakers is None:
        transcriber = SphinxTranscriber(listened_for(Scene.load("ambiguous")))
        delays = [alone(spoken(voice), transcriber, model()) for voice in VOICES]
    else:
        delays = together([spoken(VOICES[index % len(VOICES)]) for index in range(options.speakers)])
    report(delays, as_json=options.json)


def together(spoken: list[list[np.ndarray]]) -> list[tuple[list[float], list[float]]]:
    """Let everybody speak at once; return their delays."""
    recogniser, loaded = SphinxProcess(), model()
    speakers = [Speaker() for _ in spoken]
    for speaker in speakers:
        agent = Agent("ambiguous")
        agent.decide()
        speaker.begin(agent, recogniser, loaded)
    threads = [
        threading.Thread(target=speaker.speak, args=(sounds,)) for speaker, sounds in zip(speakers, spoken, strict=True)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    time.sleep(3.0)
    recogniser.close()
    return [speaker.delays() for speaker in speakers]


def report(delays: list[tuple[list[float], list[float]]], *, as_json: bool) -> None:
    """Print median and 90th percentile."""
    rows = {
        name: [delay for pair in delays for delay in pair[index]]
        for index, name in enumerate(("end of a word to the belief shown", "end of a word to its being final"))
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
