"""Answers spoken while the robot talks, with and without the echo of its voice taken out.

    python benchmarks/barge_in.py [--half held-out] [--count 40] [--cache FOLDER]       # needs fetch-pomdp[echo]

The robot's loudspeaker is 0.4 m from its ears, in the room of `rooms.py` (image sources, T60 0.5 s). It has said that
it listens, then it asks; while it talks a person answers. 0, 5 and 10 dB is the mean power of its voice, as the ears
get it, over the person's. Right: heard as the answer that it was. Robot alone: questions while nobody spoke of which
the ears took anything for an answer.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path

import numpy as np

import noises
from conversation_sets import HALVES, Half
from fetch_pomdp.adapters.speech.audio import Sound, open_raw
from fetch_pomdp.adapters.speech.echo import Played, WithoutEcho
from fetch_pomdp.adapters.speech.espeak import spoken
from fetch_pomdp.adapters.speech.recorded import SoundRecognizer
from fetch_pomdp.adapters.speech.sphinx import SphinxTranscriber
from fetch_pomdp.adapters.speech.stream import listened_for
from fetch_pomdp.core.interaction import ASKING_AGAIN, LISTENING
from fetch_pomdp.core.language.answers import After, lexicon
from fetch_pomdp.core.language.words import Meaning
from fetch_pomdp.core.scene import Scene
from noises import Floats
from rooms import LOUDNESS, REVERBERATION, Samples, as_sound, missing
from voices import RATE, said

MEANS = {"yes": Meaning.YES, "no": Meaning.NO, "yep": Meaning.YES, "not that one": Meaning.NO}
ANSWERS = tuple(MEANS)
QUESTIONS = ("this one?", ASKING_AGAIN)
LOUDSPEAKER = (3.1, 2.8, 0.95)  # m, in the room
ECHOES = (0.0, 5.0, 10.0)  # dB
LISTENS, ASKS, LONGEST = 0.5, 2.5, 8.0  # s: when the robot speaks, and how long it is listened to
QUIET = 20.0  # of 32768, root mean square of a quiet room's noise
MEANT = {Meaning.YES, Meaning.NO}


@dataclass(frozen=True, slots=True)
class Trial:
    """A question, and what the person says to it; None: nothing. begins: part of the question after which they do."""

    question: str
    answer: str | None
    voice: str
    begins: float
    seed: int


def trials(half: Half, count: int) -> list[Trial]:
    """Return answers to questions, each answer as often as the others, by the voices of a half in turn."""
    rng, voices = np.random.default_rng(half.seed), half.voices
    return [
        Trial(
            QUESTIONS[index // len(ANSWERS) % len(QUESTIONS)], ANSWERS[index % len(ANSWERS)],
            voices[index % len(voices)], float(rng.uniform(0.0, 0.8)), index,
        )
        for index in range(count)
    ]  # fmt: skip


def sounds(trial: Trial, echo: float, response: Floats, folder: Path) -> tuple[Samples, Played]:
    """Return what the ears get, and what the robot plays."""
    question, count = spoken(trial.question, "en-us", 150), int(LONGEST * RATE)
    played, known = np.zeros(count), Played()
    for samples, begin in ((spoken(LISTENING, "en-us", 150), LISTENS), (question, ASKS)):
        start = int(begin * RATE)
        played[start : start + len(samples)] += samples
        known.play(samples, begin)
    start = int(ASKS * RATE)
    size = count + len(response)
    robot = np.fft.irfft(np.fft.rfft(played, size) * np.fft.rfft(response, size), size)[:count]
    robot *= LOUDNESS * 10 ** (echo / 20) / math.sqrt(np.mean(robot[start : start + len(question)] ** 2))
    heard = robot + np.random.default_rng(trial.seed).standard_normal(count) * QUIET
    if trial.answer is not None:
        clip = said(trial.answer, trial.voice, folder).astype(float)
        place = start + int(trial.begins * len(question))
        heard[place : place + len(clip)] += clip * LOUDNESS / math.sqrt(np.mean(clip**2))
    return as_sound(heard), known


def ears() -> Callable[[Sound], Meaning | None]:
    """Return what tells the answer that is heard after the question began, None if there is none."""
    scene = Scene.load("ambiguous")
    transcriber, answers = SphinxTranscriber(listened_for(scene)), lexicon(scene.answers, scene.words)

    def hear(sound: Sound) -> Meaning | None:
        words = SoundRecognizer(sound, transcriber.words).hear(math.inf)
        heard = tuple(word.text for word in words if word.end > ASKS)
        found = answers.read(heard, After.QUESTION).meaning
        return found if found in MEANT else None

    return hear


def row(plans: Sequence[Trial], echo: float, hear: Callable[[Sound], Meaning | None], folder: Path) -> str:
    """Return a row of the table: answers that were heard right, and questions that were heard as an answer."""
    response, cells = noises.echo(REVERBERATION, LOUDSPEAKER), []
    for spoken_to in (True, False):
        right = {"without": 0, "with": 0}
        for plan in plans:
            trial = plan if spoken_to else replace(plan, answer=None)
            heard, known = sounds(trial, echo, response, folder)
            data = heard.astype("<i2").tobytes()
            meant = MEANS.get(trial.answer or "")
            found = hear(open_raw(BytesIO(data)))
            right["without"] += found is meant if spoken_to else found is not None
            found = hear(WithoutEcho(open_raw(BytesIO(data)), known))
            right["with"] += found is meant if spoken_to else found is not None
        cells += [f"{count}" for count in right.values()]
    return f"| {echo:.0f} dB | {len(plans)} | {' | '.join(cells)} |"


def main() -> int:
    """Run the benchmark; 2 if a program that speaks is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--half", choices=list(HALVES), default="held-out")
    parser.add_argument("--count", type=int, default=40, help="answers at each level of the echo")
    parser.add_argument("--cache", type=Path, help="folder that keeps the recordings for the next run")
    options = parser.parse_args()
    if packages := missing():
        print(f"not installed: {', '.join(packages)}; install with: apt install {' '.join(packages)}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        folder, plans, hear = options.cache or Path(temporary), trials(HALVES[options.half], options.count), ears()
        print(
            "| echo | answers | right, as it is | right, cancelled | robot alone, as it is | robot alone, cancelled |"
        )
        print("|---" * 6 + "|")
        for echo in ECHOES:
            print(row(plans, echo, hear, folder), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
