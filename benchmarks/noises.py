"""The noises and rooms that people are heard in: white and pink noise, talk of others, music, and a room's echo.

Each noise is a loop of 16 kHz samples with a mean power of 1. The echo is that of a shoebox room by image sources
(Allen and Berkley 1979); music is chords, a melody and a beat, made here, for we have no recording of any.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from voices import RATE, said

Floats = NDArray[np.float64]

LOOP = 30  # s
TALKERS = 6
SOUND = 343.0  # m/s
ROOM = (5.0, 4.0, 2.7)  # m
PERSON, EARS = (1.6, 1.4, 1.5), (3.4, 2.6, 1.1)  # m, places in it: 2.2 m from each other
SCALE = (0, 2, 4, 7, 9)  # semitones: any melody of these five fits the chords
CHORDS = ((0, 4, 7), (9, 12, 16), (5, 9, 12), (7, 11, 14))  # semitones over the key
BEAT = 0.5  # s


def white(rng: Generator) -> Floats:
    """Return noise of the same power in all of the band."""
    return _levelled(rng.standard_normal(LOOP * RATE))


def pink(rng: Generator) -> Floats:
    """Return noise whose power falls by 3 dB an octave."""
    spectrum = np.fft.rfft(rng.standard_normal(LOOP * RATE))
    spectrum[1:] /= np.sqrt(np.arange(1, len(spectrum)))
    spectrum[0] = 0.0
    return _levelled(np.fft.irfft(spectrum, LOOP * RATE))


def babble(rng: Generator, voices: Sequence[str], texts: Sequence[str], folder: Path) -> Floats:
    """Return several people who talk at once, each as loud as the others, about other things."""
    together = np.zeros(LOOP * RATE)
    for talker in range(TALKERS):
        voice, place = voices[talker % len(voices)], int(rng.integers(RATE))
        order = rng.permutation(len(texts))
        for turn in range(LOOP * RATE):
            clip = said(texts[order[turn % len(texts)]], voice, folder).astype(float)
            clip = _levelled(clip)[: len(together) - place]
            together[place : place + len(clip)] += clip
            place += len(clip) + int(rng.uniform(0.1, 0.6) * RATE)
            if place >= len(together):
                break
    return _levelled(together)


def music(rng: Generator) -> Floats:
    """Return a band: a chord each second, a melody above it, a beat below."""
    sound, key = np.zeros(LOOP * RATE), 220.0 * 2 ** (rng.integers(12) / 12)
    for beat in range(int(LOOP / BEAT)):
        place = int(beat * BEAT * RATE)
        if beat % 2 == 0:
            for step in CHORDS[beat // 4 % len(CHORDS)]:
                _add(sound, place, _tone(key / 2 * 2 ** (step / 12), 2 * BEAT), 0.5)
        note = SCALE[rng.integers(len(SCALE))] + 12 * int(rng.integers(2))
        _add(sound, place, _tone(key * 2 ** (note / 12), BEAT), 1.0)
        drum = rng.standard_normal(RATE // 10) * np.exp(-np.arange(RATE // 10) / (RATE / 50))
        _add(sound, place, drum, 0.6)
    return _levelled(sound)


def echo(reverberation: float, source: tuple[float, float, float] = PERSON) -> Floats:
    """Return the room's impulse response from a place (m) to the ears, the direct sound with power 1.

    reverberation: T60, s, by Sabine.
    """
    volume, surface = math.prod(ROOM), 2 * (ROOM[0] * ROOM[1] + ROOM[0] * ROOM[2] + ROOM[1] * ROOM[2])
    reflected = math.sqrt(1 - 0.161 * volume / (surface * reverberation))
    response = np.zeros(int(reverberation * RATE))
    reach = [int(SOUND * reverberation / (2 * size)) + 1 for size in ROOM]
    for image in product(*(range(-far, far + 1) for far in reach)):
        for mirrored in product((0, 1), repeat=3):
            offset = [
                (1 - 2 * mirror) * place + 2 * order * size - ear
                for mirror, place, order, size, ear in zip(mirrored, source, image, ROOM, EARS, strict=True)
            ]
            distance = math.hypot(*offset)
            delay = int(distance / SOUND * RATE)
            if delay < len(response):
                bounces = sum(abs(order - mirror) + abs(order) for order, mirror in zip(image, mirrored, strict=True))
                response[delay] += reflected**bounces / distance
    first = np.flatnonzero(response)[0]
    return np.asarray(response[first:] / response[first])


def in_room(samples: Floats, response: Floats) -> Floats:
    """Return the sound as it is heard in a room, as loud as before."""
    size = len(samples) + len(response) - 1
    heard = np.fft.irfft(np.fft.rfft(samples, size) * np.fft.rfft(response, size), size)
    return np.asarray(heard * math.sqrt(np.sum(samples**2) / np.sum(heard**2)))


def _tone(frequency: float, seconds: float) -> Floats:
    time = np.arange(int(seconds * RATE)) / RATE
    overtones = sum(np.sin(math.tau * frequency * k * time) / k**1.5 for k in range(1, 7))
    return np.asarray(overtones * np.exp(-2 * time) * np.minimum(1.0, time / 0.01))


def _add(sound: Floats, place: int, part: Floats, gain: float) -> None:
    end = min(len(sound), place + len(part))
    sound[place:end] += gain * part[: end - place]


def _levelled(sound: Floats) -> Floats:
    return np.asarray(sound / math.sqrt(np.mean(sound**2)))
