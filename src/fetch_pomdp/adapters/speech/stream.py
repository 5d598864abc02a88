"""Ears for a live stream: sound is pushed in chunks, hypotheses come while somebody speaks, words at the end.

A hypothesis is the transcription of the utterance so far, by the same code as that of the whole: at a pause it is what
the words will be. It is made again as soon as there is as much new sound as the last one took, and 150 ms more, so that
a slow recogniser gives fewer of them.
"""

from __future__ import annotations

import logging
import threading
import time as machine
from collections import deque
from collections.abc import Callable, Sequence

import numpy as np

from fetch_pomdp.adapters.speech.audio import RATE, Samples
from fetch_pomdp.adapters.speech.utterances import FRAME, PADDING, Cutter, Detector, SpeechSegment, Transcriber
from fetch_pomdp.core.language.names import as_spoken
from fetch_pomdp.core.language.words import STOPS
from fetch_pomdp.core.ports import Word
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import AudioError

logger = logging.getLogger(__name__)

Hypothesis = tuple[Word, ...] | None

PERIOD = 0.15  # s of new sound between hypotheses, at least
LATE = 1.0  # s by which a chunk may be late before it counts as not following the one before
BACKLOG = 10.0  # s of sound kept for a recogniser that is busy
IDLE = 0.5  # s after which a recogniser that has nothing to do says that it lives


class Stream:
    """Cuts and transcribes a stream, in the thread that feeds it. Times are those of whoever feeds it, in seconds.

    timer: measures (s) how long a hypothesis takes.
    """

    def __init__(
        self,
        transcriber: Transcriber,
        detector: Detector,
        on_partial: Callable[[Hypothesis], None],
        on_word: Callable[[Word], None],
        timer: Callable[[], float] = machine.monotonic,
    ) -> None:
        self._timer = timer
        self._transcriber, self._cutter = transcriber, Cutter(detector)
        self._on_partial, self._on_word = on_partial, on_word
        self._rest = np.empty(0, np.int16)
        self._offset = 0.0  # s, of the clock of who feeds it over that of the cutter
        self._expected: float | None = None  # s, when the next chunk begins if nothing is left out
        self._next = 0.0  # s on the cutter's clock, when the next hypothesis is due
        self._hypothesis: Hypothesis = None

    def feed(self, samples: Samples, begin: float) -> None:
        """Take sound that began at `begin` (s). What follows a gap is no part of the utterance before it.

        Sound may come late, never early: of the times of chunks that follow each other, the earliest are right.
        """
        if self._expected is None or begin > self._expected + LATE:
            self.end()
            self._offset = begin - self._cutter.time
            self._expected = begin
        elif begin < self._expected:
            self._offset += begin - self._expected
            self._expected = begin
        self._expected += len(samples) / RATE
        joined = np.concatenate([self._rest, samples])
        whole = len(joined) - len(joined) % FRAME
        self._rest = joined[whole:]
        for start in range(0, whole, FRAME):
            if utterance := self._cutter.take(joined[start : start + FRAME]):
                self._finish(utterance)
        if self._cutter.speaking and self._hypothesis is None:
            self._guess(())
            self._next = self._cutter.begun + PADDING * FRAME / RATE + PERIOD

    def guess(self) -> None:
        """Say what has been said so far in the utterance that goes on: anew if that is due."""
        if not self._cutter.speaking:
            return
        if self._cutter.time >= self._next:
            begun = self._timer()
            self._guess(self._words(self._cutter.so_far()))
            self._next = self._cutter.time + PERIOD + self._timer() - begun
        else:
            self._guess(self._hypothesis)

    def end(self) -> None:
        """End the utterance that goes on, if there is one: no sound follows."""
        self._rest = np.empty(0, np.int16)
        self._expected = None
        if utterance := self._cutter.end():
            self._finish(utterance)

    def _guess(self, hypothesis: Hypothesis) -> None:
        self._hypothesis = hypothesis
        self._on_partial(hypothesis)

    def _finish(self, utterance: SpeechSegment) -> None:
        for word in self._words(utterance):
            self._on_word(word)
        self._guess(None)

    def _words(self, utterance: SpeechSegment) -> tuple[Word, ...]:
        moved = SpeechSegment(utterance.start + self._offset, utterance.samples)
        try:
            return tuple(self._transcriber.words(moved))
        except AudioError as error:
            logger.warning("not heard: %s", error)
            return ()


class StreamingRecognizer:
    """A Stream with a thread of its own: `feed` returns at once, from any thread.

    on_partial: is told each hypothesis of the utterance under way, and None when it is over; on_word: each final word.
    on_alive: is called again and again, unless the recogniser hangs. clock: tells the time (s) for chunks that come
    without one.
    """

    def __init__(
        self,
        transcriber: Transcriber,
        detector: Detector,
        on_partial: Callable[[Hypothesis], None],
        on_word: Callable[[Word], None],
        *,
        on_alive: Callable[[], None],
        clock: Callable[[], float],
    ) -> None:
        self._stream = Stream(transcriber, detector, on_partial, on_word)
        self._on_alive, self._clock = on_alive, clock
        self._chunks: deque[tuple[Samples, float]] = deque()
        self._muted: list[tuple[float, float]] = []
        self._came = threading.Condition()
        self._ending = self._closed = False
        self.dropped = 0.0  # s of sound
        self._thread = threading.Thread(target=self._run, name="speech", daemon=True)
        self._thread.start()

    def feed(self, pcm: bytes, begin: float | None = None) -> None:
        """Take 16-bit little-endian mono samples at 16 kHz that began at `begin` (s); that ended now if not given.

        Raises AudioError for half a sample. When the recogniser is 10 s behind, the oldest sound is dropped.
        """
        if len(pcm) % 2:
            raise AudioError(f"found {len(pcm)} bytes, expected two for each sample", source="stream")
        samples = np.frombuffer(pcm, "<i2").astype(np.int16)
        start = self._clock() - len(samples) / RATE if begin is None else begin
        with self._came:
            self._chunks.append((samples, start))
            while sum(len(chunk) for chunk, _ in self._chunks) > BACKLOG * RATE:
                self.dropped += len(self._chunks.popleft()[0]) / RATE
            self._came.notify()

    def mute(self, begin: float, end: float) -> None:
        """Leave out the sound from `begin` to `end` (s): the robot itself speaks then."""
        with self._came:
            self._muted = [(first, last) for first, last in self._muted if last > begin - BACKLOG] + [(begin, end)]

    def end(self) -> None:
        """End the utterance that goes on: the button to talk was released, no sound follows."""
        with self._came:
            self._ending = True
            self._came.notify()

    def close(self) -> None:
        """End soon; what was not heard yet is left out."""
        with self._came:
            self._closed = True
            self._came.notify()

    def _run(self) -> None:
        while not self._closed:
            with self._came:
                self._came.wait_for(lambda: self._chunks or self._ending or self._closed, IDLE)
                chunks, muted = list(self._chunks), list(self._muted)
                self._chunks.clear()
                ending, self._ending = self._ending, False
            self._on_alive()
            for samples, begin in chunks:
                self._hear(samples, begin, muted)
            if ending:
                self._stream.end()
            self._stream.guess()

    def _hear(self, samples: Samples, begin: float, muted: Sequence[tuple[float, float]]) -> None:
        heard = begin
        for part, start in unmuted(samples, begin, muted):
            if start > heard:
                self._stream.end()
            self._stream.feed(part, start)
            heard = start + len(part) / RATE
        if heard < begin + (len(samples) - 0.5) / RATE:
            self._stream.end()


def listened_for(scene: Scene) -> list[str]:
    """Return the words for the vocabulary of a Transcriber: those of the items, and those that stop a hand-over."""
    return list(dict.fromkeys([*as_spoken(scene.words), *sorted(STOPS)]))


def unmuted(samples: Samples, begin: float, muted: Sequence[tuple[float, float]]) -> list[tuple[Samples, float]]:
    """Return the parts of the sound, with their beginnings (s), that lie in no muted stretch."""
    parts = [(samples, begin)] if len(samples) else []
    for first, last in muted:
        parts = [piece for part, start in parts for piece in _outside(part, start, first, last)]
    return parts


def _outside(samples: Samples, begin: float, first: float, last: float) -> list[tuple[Samples, float]]:
    before = min(len(samples), max(0, round((first - begin) * RATE)))
    after = min(len(samples), max(before, round((last - begin) * RATE)))
    pieces = [(samples[:before], begin), (samples[after:], begin + after / RATE)]
    return [(part, start) for part, start in pieces if len(part)]
