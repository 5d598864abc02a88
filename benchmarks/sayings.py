"""Spoken sentences of which it is known when each word ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pocketsphinx
from numpy.typing import NDArray

from voices import BEFORE, RATE, read, record

FRAME = 0.01  # s, of the aligner


@dataclass(frozen=True, slots=True)
class Saying:
    """A sentence as it sounds in noise. ends: when (s from the first sample) each word ends."""

    words: tuple[str, ...]
    ends: tuple[float, ...]
    samples: NDArray[np.int16]

    @property
    def noise(self) -> float:
        """Return the standard deviation of the noise before the sentence."""
        return float(self.samples[: round(0.9 * BEFORE * RATE)].std())

    @property
    def speech(self) -> float:
        """Return how long (s) somebody speaks."""
        return self.ends[-1] - BEFORE


def say(text: str, voice: str, snr: int, folder: Path) -> Saying:
    """Return a sentence by a synthetic voice at an SNR (dB).

    The words are found by forced alignment with the open model, which knows the sentence, of the clean recording or, as
    digital silence confuses it at times, of that at 20 dB; where the last word ends by the loudness it finds, too,
    within 0.04 s. Raises ValueError where both fail.
    """
    clean, faint = record([text], folder, [voice], [None, 20])
    (noisy,) = record([text], folder, [voice], [snr])
    for path in (clean.path, faint.path):
        spoken = _aligned(text, path)
        if [word for word, _ in spoken] == text.split():
            return Saying(tuple(text.split()), tuple(end for _, end in spoken), read(noisy.path))
    raise ValueError(f"no alignment of {text!r} by {voice}")


def _aligned(text: str, path: Path) -> list[tuple[str, float]]:
    """Return the words found and when (s) they end."""
    decoder = pocketsphinx.Decoder(lm=None, dither=True, seed=1, loglevel="FATAL")
    decoder.set_align_text(text)
    decoder.start_utt()
    decoder.process_raw(read(path).tobytes(), full_utt=True)
    decoder.end_utt()
    found = [(part.word.partition("(")[0], (part.end_frame + 1) * FRAME) for part in decoder.seg() or ()]
    return [(word, end) for word, end in found if word.isalpha()]


def say_all(texts: Sequence[str], voice: str, snr: int, folder: Path) -> dict[str, Saying]:
    """Return sentences by one voice, by their texts."""
    return {text: say(text, voice, snr, folder) for text in texts}
