"""The rooms in which the benchmarks of the ears hear people: quiet, noises, an echo; and how loud everything is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import noises
from conversation_sets import Half
from noises import Floats
from voices import RATE, TOOLS, missing_tools

LOUDNESS = 2000.0  # of 32768, root mean square of what a person says
SNR = 10.0  # dB
REVERBERATION = 0.5  # s, T60
MORE_TOOLS = {"festival": "text2wave"}  # packages of Debian, and the program in them that is needed

Samples = NDArray[np.int16]


@dataclass(frozen=True, slots=True)
class Room:
    """What is between a person and the ears. noise: a loop with a power of 1; response: the room's, or none."""

    name: str
    noise: Floats | None = None
    snr: float = SNR  # dB, of the voice's mean power over the noise's
    response: Floats | None = None

    def silence(self, count: int, seed: int) -> Floats:
        """Return the room while nobody speaks. count: samples; seed: which part of the noise it begins with."""
        if self.noise is None:
            return np.zeros(count)
        return np.resize(np.roll(self.noise, -seed * RATE), count) * LOUDNESS * 10 ** (-self.snr / 20)

    def voice(self, samples: Samples) -> Floats:
        """Return what a person says as it sounds in the room, without its noise."""
        clip = samples.astype(float)
        clip *= LOUDNESS / math.sqrt(np.mean(clip**2))
        return clip if self.response is None else noises.in_room(clip, self.response)


def rooms(half: Half, folder: Path) -> Iterator[Room]:
    """Yield the rooms of a half: the noises of each half are others."""
    rng = np.random.default_rng(half.seed)
    yield Room("quiet")
    yield Room("white noise", noises.white(rng))
    yield Room("pink noise", noises.pink(rng))
    yield Room("babble", noises.babble(rng, half.voices, half.talk, folder))
    yield Room("music", noises.music(rng))
    yield Room("echo", noises.pink(rng), 30.0, noises.echo(REVERBERATION))


def as_sound(samples: Floats) -> Samples:
    """Return the samples as a microphone gives them."""
    return np.asarray(np.clip(np.round(samples), -32768, 32767), np.int16)


def missing() -> list[str]:
    """Return the apt packages that are not installed."""
    return [*missing_tools(TOOLS), *(package for package, program in MORE_TOOLS.items() if missing_tools([program]))]
