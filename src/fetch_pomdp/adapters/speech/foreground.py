"""The one who talks to the robot, among others who talk: the loudest there is.

Choice: in a room full of voices everything is speech, and whoever is near the robot is louder than the rest. So a frame
is of the foreground when it is well above what the room was like in the last seconds: above the level of its quieter
moments by more than these vary among themselves. In a quiet room, and in steady noise, that is a few dB.
"""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from fetch_pomdp.adapters.speech.audio import Samples
from fetch_pomdp.adapters.speech.utterances import QUIETEST, Detector, power

SMOOTH = 10  # frames a level is averaged over: a syllable
MEMORY = 500  # frames, 5 s, that the room's level is taken from
BEFORE = 15  # frames of silence taken to have been before the stream: who talks from its beginning is heard
EVERY = 5  # frames between estimates of it
QUIETER, QUIETEST_PART = 0.15, 0.03  # quantiles of the levels
BELOW_MEAN, APART = 1.04, 0.84  # standard deviations: of the first under the mean, and of the two from each other
MOST_VARIED = 3.0  # dB, standard deviation of a room's level; more of it is pauses between words
ABOVE, DEVIATIONS = 4.5, 2.5  # dB, and standard deviations: the larger of the two is how far above the room speech is
STILL = 2.0  # dB less, for speech that goes on


class Foreground:
    """A Detector of speech over that of others. speech: tells speech from other sounds."""

    def __init__(self, speech: Detector) -> None:
        self._speech = speech
        self._powers: deque[float] = deque(maxlen=SMOOTH)
        self._levels: deque[float] = deque(maxlen=MEMORY)
        self._count, self._least = 0, 0.0  # frames; dB

    def __call__(self, frame: Samples, above: float, speaking: bool) -> bool:
        """Whether it is speech, and nearer than the rest. See Detector."""
        self._powers.append(power(frame))
        level = max(QUIETEST, 10 * math.log10(sum(self._powers) / len(self._powers) + 1))
        self._levels.append(level)
        if self._count % EVERY == 0:
            self._least = _least(np.sort(self._levels))
        self._count += 1
        return self._speech(frame, above, speaking) and level > self._least - (STILL if speaking else 0.0)


def _least(levels: np.ndarray) -> float:
    """Return the level (dB) from which on sound is of the foreground. levels: the room's, sorted."""
    quiet, quietest = levels[int(QUIETER * len(levels))], levels[int(QUIETEST_PART * len(levels))]
    varied = min(MOST_VARIED, (quiet - quietest) / APART)
    if QUIETER * (len(levels) + BEFORE) < BEFORE:
        quiet = QUIETEST
    return float(quiet + BELOW_MEAN * varied + max(ABOVE, DEVIATIONS * varied))
