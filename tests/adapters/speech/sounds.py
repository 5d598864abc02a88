"""Recordings and noise that several tests of speech share."""

from __future__ import annotations

import wave
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

DATA = Path(__file__).with_name("data")
VOCABULARY = ["bowl", "black", "plastic", "marker", "green", "expo", "pen", "spoon", "silver", "metal"]


def samples_of(path: Path) -> NDArray[np.int16]:
    with wave.open(str(path)) as file:
        return np.frombuffer(file.readframes(file.getnframes()), np.int16)


def with_noise(samples: NDArray[np.int16], snr: float = 20.0) -> NDArray[np.int16]:
    loudness = np.sqrt(np.mean(np.square(samples[8000:-8000], dtype=float)))
    noise = np.random.default_rng(3).standard_normal(len(samples)) * loudness * 10 ** (-snr / 20)
    return np.asarray(np.clip(np.round(samples + noise), -32768, 32767), np.int16)
