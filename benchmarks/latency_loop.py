"""How long the live loop takes, in real time: from the end of a word to the belief, and to the step's end.

    python benchmarks/latency_loop.py [--speakers 2] [--snr 20] [--json] [--cache FOLDER]  # half a minute

Each speaker says six sentences to a session of their own, all at once and through one recogniser; the end of a word is
where the decoder puts it. A word counts from its end to the first belief that it is part of, hypothesis or final.
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
from fetch_pomdp.adapters.speech.stream import StreamingRecognizer, listened_for
from fetch_pomdp.adapters.speech.worker import SphinxProcess
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.live import BeliefChanged, Heard, Inbox, LiveSession, Update
from fetch_pomdp.core.ports import Outcome, Word
from fetch_pomdp.core.scene import Item
from voices import RATE, missing_tools, read, record

SENTENCES = ("the marker", "hand me the green marker", "the silver spoon", "yes", "no", "i want the black bowl")
VOICES = ("espeak-en-us-175", "flite-slt", "espeak-en-gb-130", "flite-rms")
CHUNK = RATE // 20  # samples: 50 ms, as a browser sends them
PAUSE = 1.5  # s between sentences


class Nobody:
    """A robot without a body, which never hands over, so that the interaction goes on."""

    def point(self, item: Item) -> Outcome:  # noqa: ARG002
        return Outcome.DONE

    def pick(self, item: Item) -> Outcome:  # noqa: ARG002
        return Outcome.FAILED

    def say(self, text: str) -> Outcome:  # noqa: ARG002
        return Outcome.DONE

    def stop(self) -> None:
        pass


@dataclass
class Speaker:
    """A session, and when it told what."""

    voice: str
    inbox: Inbox = field(default_factory=Inbox)
    told: list[tuple[float, Update]] = field(default_factory=list)

    def begin(self, agent: Agent, recogniser: SphinxProcess, loaded: object) -> None:
        self.session = LiveSession(agent, Nobody(), self.inbox, listener=self.listen)
        now = self.session.clock.now
        transcriber = recogniser.transcriber(listened_for(agent.scene))
        self.ears = StreamingRecognizer(
            transcriber, Silero(loaded), self.inbox.push_partial, self.inbox.push_word,
            on_alive=lambda: self.inbox.alive("speech", now()), clock=now,
        )  # fmt: skip
        threading.Thread(target=self.session.run, daemon=True).start()

    def listen(self, update: Update) -> None:
        self.told.append((self.session.clock.now(), update))

    def speak(self, sounds: list[np.ndarray]) -> None:
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
    parser.add_argument("--speakers", type=int, default=1)
    parser.add_argument("--snr", type=int, default=20)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "fetch-pomdp-voices")
    options = parser.parse_args()
    if missing := missing_tools():
        parser.error(f"not installed: {', '.join(missing)}; install with: apt install {' '.join(missing)}")
    recogniser, loaded = SphinxProcess(), model()
    speakers = [Speaker(VOICES[index % len(VOICES)]) for index in range(options.speakers)]
    for speaker in speakers:
        agent = Agent("ambiguous")
        agent.decide()
        speaker.begin(agent, recogniser, loaded)
    gap = np.random.default_rng(0).normal(0, 20, round(PAUSE * RATE)).astype(np.int16)
    threads = []
    for speaker in speakers:
        made = record(SENTENCES, options.cache, [speaker.voice], [options.snr])
        sounds = [part for recording in made for part in (read(recording.path), gap)]
        threads.append(threading.Thread(target=speaker.speak, args=(sounds,)))
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    time.sleep(3.0)
    recogniser.close()
    report([speaker.delays() for speaker in speakers], as_json=options.json)


def report(delays: list[tuple[list[float], list[float]]], *, as_json: bool) -> None:
    """Print median and 90th percentile."""
    rows = {
        name: [delay for pair in delays for delay in pair[index]]
        for index, name in enumerate(("end of a word to the belief shown", "end of a word to the step's end"))
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
