"""Cuts sound into utterances at the silences between them.

Choice: a frame is speech when it is louder than the quietest moment of the last seconds, so that steady noise of any
level counts as silence (webrtcvad takes noise at 20 dB SNR for speech throughout).
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fetch_pomdp.adapters.speech.audio import RATE, Samples, Sound
from fetch_pomdp.core.ports import Word

FRAME = 160  # samples: 10 ms, as the decoder's frames
BAND = slice(2, 40)  # bins of 100 Hz: where the energy of speech is, without hum
SMOOTH = 5  # frames a level is averaged over
QUIETEST = 14.0  # dB, 5 of 32768: below it everything is silence, also digital zeros
ONSET, OFFSET = 4.5, 3.0  # dB above the floor where speech begins and ends
MEMORY = 300  # frames the floor is the minimum of
PADDING = 30  # frames kept before and after speech, for its quiet consonants
NOTICED = 4  # frames that a detector may take to notice speech
PAUSE = 50  # frames of silence that end an utterance
LONGEST = 1000  # frames; a longer utterance is cut at the quietest of its last MEMORY frames


@dataclass(frozen=True, slots=True)
class SpeechSegment:
    """A stretch of sound with speech in it."""

    start: float  # s on the clock of the stream
    samples: Samples


class Transcriber(Protocol):
    """What every recogniser of whole utterances has in common: finds the words of one, or of as much as there is."""

    def words(self, utterance: SpeechSegment) -> Sequence[Word]:
        """Return the words in order, lower case, with their times (s) on the clock of the utterance, and posteriors.

        Raises AudioError if it breaks; it may be asked again.
        """
        ...


class Detector(Protocol):
    """Tells speech from other sounds."""

    def __call__(self, frame: Samples, above: float, speaking: bool) -> bool:
        """Whether there is speech in the next 10 ms. above: dB over the floor; speaking: whether there just was."""
        ...


def loud(frame: Samples, above: float, speaking: bool) -> bool:  # noqa: ARG001
    """Whether a frame is loud enough for speech; the Detector of recordings."""
    return above > (OFFSET if speaking else ONSET)


class Cutter:
    """Cuts frames that are pushed into utterances. Holds at most LONGEST frames."""

    def __init__(self, detector: Detector = loud) -> None:
        self._detector = detector
        self._kept: list[Samples] = []  # frames not given away; the last one is frame `_count` - 1
        self._count = 0
        self._powers: deque[float] = deque(maxlen=SMOOTH)
        self._levels: deque[float] = deque(maxlen=MEMORY)  # dB
        self._quiet = 0  # frames since speech
        self.speaking = False  # whether someone is in mid-utterance

    @property
    def time(self) -> float:
        """How much (s) was pushed."""
        return self._count * FRAME / RATE

    @property
    def settled(self) -> float:
        """Up to when (s) all that was said has been given: what was pushed, but for an utterance that goes on."""
        return (self._count - (len(self._kept) if self.speaking else 0)) * FRAME / RATE

    def take(self, frame: Samples) -> SpeechSegment | None:
        """Take the next 10 ms; return an utterance if one ended with them."""
        self._kept.append(frame)
        self._count += 1
        voiced = self._detector(frame, self._above_floor(frame), self.speaking)
        self.speaking = self.speaking or voiced
        self._quiet = 0 if voiced else self._quiet + 1
        if not self.speaking:
            del self._kept[: -PADDING - NOTICED]
        elif self._quiet >= PAUSE:
            self.speaking = False
            return self._give(len(self._kept) - PAUSE + PADDING)
        elif len(self._kept) >= LONGEST:
            return self._give(len(self._kept) - MEMORY + int(np.argmin(self._levels)) - SMOOTH // 2)
        return None

    def so_far(self) -> SpeechSegment:
        """Return the utterance that goes on, up to now."""
        return SpeechSegment(self.begun, np.concatenate(self._kept))

    def end(self) -> SpeechSegment | None:
        """End the utterance that goes on and return it; forget what was said before if there is none."""
        given = self._give(len(self._kept)) if self.speaking else None
        self.speaking = False
        self._kept.clear()
        self._powers.clear()  # what was said tells nothing of how loud the next utterance is
        return given

    @property
    def begun(self) -> float:
        """When (s) the utterance that goes on began."""
        return (self._count - len(self._kept)) * FRAME / RATE

    def _above_floor(self, frame: Samples) -> float:
        self._powers.append(power(frame))
        self._levels.append(max(QUIETEST, 10 * math.log10(sum(self._powers) / len(self._powers) + 1)))
        return self._levels[-1] - min(self._levels)

    def _give(self, count: int) -> SpeechSegment:
        start = self.begun
        given, self._kept = self._kept[:count], self._kept[count:]
        return SpeechSegment(start, np.concatenate(given))


def power(frame: Samples) -> float:
    """Return the mean square of 10 ms in the band of speech."""
    return float(2 * np.square(np.abs(np.fft.rfft(frame)[BAND])).sum() / FRAME**2)  # by Parseval


class Utterances:
    """The utterances of a Sound, found while it is read."""

    def __init__(self, sound: Sound, detector: Detector = loud) -> None:
        self._sound, self._cutter = sound, Cutter(detector)
        self.ended = False

    @property
    def settled(self) -> float:
        """Up to when (s) all that was said has been given: what was read, but for an utterance that goes on."""
        return self._cutter.settled

    def step(self) -> SpeechSegment | None:
        """Read 10 ms; return an utterance if one ended with them. Raises AudioError for a stream that breaks."""
        frame = self._sound.read(FRAME)
        if len(frame) < FRAME:
            self.ended = True
            return self._cutter.end()
        return self._cutter.take(frame)
