"""The server's ears for a page that sends sound; and its voice. Nothing of the sound is kept."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from typing import Any

from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.speech.silero import Silero, model
from fetch_pomdp.adapters.speech.stream import StreamingRecognizer
from fetch_pomdp.adapters.speech.utterances import Detector
from fetch_pomdp.adapters.speech.worker import SphinxProcess
from fetch_pomdp.adapters.web.protocol import LARGEST_MESSAGE
from fetch_pomdp.core.live import Inbox
from fetch_pomdp.errors import AudioError, MessageError, MissingExtraError

logger = logging.getLogger(__name__)

SENSOR = "speech"
ECHO = 0.4  # s after the robot's last word in which a room may still give it back
MOST_EARLY = 100  # chunks kept until the ears are open


class Hearing:
    """What all ears of a server share: a recogniser's process and a voice detector.

    Raises MissingExtraError without the extra `speech`.
    """

    def __init__(self) -> None:
        self.process = SphinxProcess()
        self._model: Any = model()

    def detector(self) -> Detector:
        """Return a voice detector for one stream."""
        return Silero(self._model)

    def close(self) -> None:
        """End the process."""
        self.process.close()


def hearing_if_installed() -> Hearing | None:
    """Return the ears of a server, or None where what they need is not installed."""
    try:
        return Hearing()
    except MissingExtraError as error:
        logger.warning("nobody is heard, all must type: %s", error)
        return None


def voice_if_installed() -> Voice | None:
    """Return the robot's voice, or None where what it needs is not installed."""
    try:
        return Voice()
    except (MissingExtraError, AudioError) as error:
        logger.warning("the browser's own voice speaks for the robot: %s", error)
        return None


class Ears:
    """Ears of one conversation, opened in a thread when the first sound comes."""

    def __init__(self, hearing: Hearing, vocabulary: Sequence[str], inbox: Inbox, clock: Callable[[], float]) -> None:
        self._hearing, self._vocabulary, self._inbox, self._clock = hearing, vocabulary, inbox, clock
        self._lock = threading.Lock()
        self._early: list[tuple[bytes, float]] | None = None  # sound that came before the ears were open
        self._recognizer: StreamingRecognizer | None = None
        self._closed = False

    def hear(self, pcm: bytes) -> None:
        """Take 16-bit mono sound of 16 kHz that ended now. Raises MessageError for none and for half a sample."""
        if len(pcm) % 2 or not 0 < len(pcm) <= LARGEST_MESSAGE:
            expected = f"expected an even number, from 2 to {LARGEST_MESSAGE}"
            raise MessageError(f"found {len(pcm)} bytes of sound, {expected}")
        begin = self._clock() - len(pcm) / 32_000
        with self._lock:
            if self._recognizer is not None:
                self._recognizer.feed(pcm, begin)
                return
            if self._early is None:
                self._early = []
                threading.Thread(target=self._open, name="ears", daemon=True).start()
            if len(self._early) < MOST_EARLY:
                self._early.append((pcm, begin))

    def end(self) -> None:
        """Know that no sound follows for now."""
        with self._lock:
            if self._recognizer is not None:
                self._recognizer.end()

    def mute(self, seconds: float) -> None:
        """Leave out what comes while the robot itself speaks, for `seconds` from now."""
        now = self._clock()
        with self._lock:
            if self._recognizer is not None:
                self._recognizer.mute(now, now + seconds + ECHO)

    def close(self) -> None:
        """Hear nothing any more."""
        with self._lock:
            self._closed = True
            if self._recognizer is not None:
                self._recognizer.close()

    def _open(self) -> None:
        try:
            transcriber = self._hearing.process.transcriber(self._vocabulary)
        except AudioError:
            logger.exception("the ears do not open")
            return
        with self._lock:
            if self._closed:
                return
            self._recognizer = StreamingRecognizer(
                transcriber,
                self._hearing.detector(),
                self._inbox.push_partial,
                self._inbox.push_word,
                on_alive=lambda: self._inbox.alive(SENSOR, self._clock()),
                clock=self._clock,
            )
            for pcm, begin in self._early or ():
                self._recognizer.feed(pcm, begin)
