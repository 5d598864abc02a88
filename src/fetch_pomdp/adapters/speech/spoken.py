"""A channel of a study through real sound: espeak-ng says an utterance in noise, SphinxRecognizer hears it.

Choice: a talker stands in white noise that does not depend on where they are, so that the signal-to-noise ratio falls
by 6 dB at each doubling of distance. No echo, no other talk, and synthetic voices only.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from io import BytesIO

import numpy as np
from numpy.random import Generator

from fetch_pomdp.adapters.speech.audio import RATE, Samples, open_raw
from fetch_pomdp.adapters.speech.espeak import spoken
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.core.ports import Word

VOICES = ("en-us", "en-gb", "en-us+f3", "en-us+m3", "en-us+f2")
BEFORE, AFTER = 0.4, 0.7  # s of the room around an utterance
SLOWEST, FASTEST = 80, 300  # words a minute that espeak-ng can say


@dataclass(frozen=True, slots=True)
class SpokenWords:
    """What our recogniser hears of synthetic voices. Implements the study's Channel; the random generator is not used.

    scene_words: the words the recogniser knows as those of items. snr: dB at 1 m. What was heard is kept by text,
    voice, speed and noise, to 10 words a minute and 1 dB: an utterance takes half a second of a core the first time.
    Raises MissingExtraError without espeak-ng, pocketsphinx or soxr when it first hears.
    """

    scene_words: tuple[str, ...]
    snr: float = 20.0  # dB
    voices: tuple[str, ...] = VOICES
    heard: dict[tuple[str, str, int, int], tuple[Word, ...]] = field(default_factory=dict, repr=False, compare=False)

    def hear(self, said: Sequence[Word], *, distance: float, voice: int, rng: Generator) -> Sequence[Word]:  # noqa: ARG002
        """Return the words heard of what was said, at its time; see Channel."""
        first, last = said[0].start, said[-1].end
        text, name = " ".join(word.text for word in said), self.voices[voice % len(self.voices)]
        speed = round(6.0 * len(said) / (last - first)) * 10
        snr = round(self.snr - 20.0 * math.log10(distance))
        key = text, name, min(max(speed, SLOWEST), FASTEST), snr
        if key not in self.heard:
            self.heard[key] = self._listened(*key)
        return [Word(word.text, first + word.start, first + word.end, word.posterior) for word in self.heard[key]]

    def _listened(self, text: str, voice: str, speed: int, snr: int) -> tuple[Word, ...]:
        """Say and hear an utterance that begins at 0 s; words that the noise seems to say before it are left out."""
        sound = in_noise(spoken(text, voice, speed), snr, zlib.crc32(f"{text} {voice} {speed} {snr}".encode()))
        ears = SphinxRecognizer(open_raw(BytesIO(sound.astype("<i2").tobytes())), self.scene_words)
        return tuple(
            Word(word.text, max(0.0, word.start - BEFORE), word.end - BEFORE, word.posterior)
            for word in ears.hear(math.inf)
            if word.start >= BEFORE / 2
        )


def in_noise(samples: Samples, snr: float, seed: int) -> Samples:
    """Put a room around the samples, with white noise `snr` dB under their mean power all through it."""
    level = math.sqrt(float(np.mean(np.square(samples, dtype=float)))) * 10.0 ** (-snr / 20.0)
    padded = np.pad(samples.astype(float), (int(BEFORE * RATE), int(AFTER * RATE)))
    mixed = padded + np.random.default_rng(seed).standard_normal(len(padded)) * level
    return np.asarray(np.round(mixed * min(1.0, 32767.0 / np.abs(mixed).max())), np.int16)
