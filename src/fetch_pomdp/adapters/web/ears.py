"""The server's ears for a page that sends sound; and its voice. Nothing of the sound is kept."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from fetch_pomdp.adapters.speech.choice import SPHINX, transcribers
from fetch_pomdp.adapters.speech.espeak import Voice
from fetch_pomdp.adapters.speech.foreground import Foreground
from fetch_pomdp.adapters.speech.silero import Silero, model
from fetch_pomdp.adapters.speech.stream import StreamingRecognizer
from fetch_pomdp.adapters.speech.utterances import Detector
from fetch_pomdp.adapters.web.page_messages import LARGEST_MESSAGE
from fetch_pomdp.core.live import Inbox, SensorState, SensorStatus
from fetch_pomdp.core.live.sensor_monitor import TEXTS
from fetch_pomdp.errors import AudioError, MessageError, MissingExtraError

logger = logging.getLogger(__name__)

SENSOR = "speech"
ECHO = 0.4  # s after the robot's last word in which a room may still give it back
MOST_EARLY = 100  # chunks kept until the ears are open
AGAIN = 5.0  # s until the ears are tried again that did not open


class Hearing:
    """What all ears of a server share: a recogniser and a voice detector. ears: which, as `--ears` names it.

    Raises MissingExtraError without the extra `speech`, or that of the ears; see `choice.transcribers`.
    """

    def __init__(self, ears: str = SPHINX) -> None:
        self.process = transcribers(ears)
        self._model: Any = model()

    def detector(self) -> Detector:
        """Return a voice detector for one stream."""
        return Foreground(Silero(self._model))

    def close(self) -> None:
        """End the process."""
        self.process.close()


def hearing_if_installed() -> Hearing | None:
    """Return what all ears of a server share, None if it is not installed."""
    try:
        return Hearing()
    except MissingExtraError as error:
        logger.warning("no speech recognition, people must type: %s", error)
        return None


def voice_if_installed() -> Voice | None:
    """Return the robot's voice, None if it is not installed."""
    try:
        return Voice()
    except (MissingExtraError, AudioError) as error:
        logger.warning("no voice, the browser's own is used: %s", error)
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Speech:
    """What a server has of speech; None for what is not installed."""

    voice: Voice | None = None
    hearing: Hearing | None = None


def speech_if_installed() -> Speech:
    """Return the voice and the ears of a server, as far as what they need is installed."""
    return Speech(voice=voice_if_installed(), hearing=hearing_if_installed())


def speech_with(ears: str) -> Speech:
    """Return the voice, if it is installed, and the ears that somebody asked for. Raises as `Hearing` does."""
    return Speech(voice=voice_if_installed(), hearing=Hearing(ears))


class Early:
    """What happened before the ears were open, in time order."""

    def __init__(self) -> None:
        self._sound: list[tuple[bytes, float]] = []
        self._muted: list[tuple[float, float]] = []
        self._ended = False

    def hear(self, pcm: bytes, begin: float) -> None:
        """Keep sound; of too much the first."""
        if len(self._sound) < MOST_EARLY:
            self._sound.append((pcm, begin))
        self._ended = False

    def mute(self, begin: float, end: float) -> None:
        """Keep when the robot itself spoke; what was over before there was sound does not matter."""
        since = self._sound[0][1] if self._sound else begin
        self._muted = [stretch for stretch in self._muted if stretch[1] > since] + [(begin, end)]

    def end(self) -> None:
        """Note that no sound follows for now."""
        self._ended = True

    def forget_sound(self) -> None:
        """Drop the sound; nobody can hear it any more."""
        self._sound = []

    def replay(self, recognizer: StreamingRecognizer) -> None:
        """Let a recogniser hear it."""
        for begin, end in reversed(self._muted):  # each forgets those that ended long before it
            recognizer.mute(begin, end)
        for pcm, begin in self._sound:
            recognizer.feed(pcm, begin)
        if self._ended:
            recognizer.end()


class Ears:
    """Ears of one conversation, opened in a thread when the first sound comes.

    Ears that do not open are tried again with the first sound after AGAIN seconds. tell: is told when they are lost,
    and when they work again.
    """

    def __init__(
        self,
        hearing: Hearing,
        vocabulary: Sequence[str],
        inbox: Inbox,
        clock: Callable[[], float],
        tell: Callable[[SensorStatus], None],
    ) -> None:
        self._hearing, self._vocabulary, self._inbox, self._clock, self._tell = hearing, vocabulary, inbox, clock, tell
        self._lock = threading.Lock()
        self._early = Early()
        self._recognizer: StreamingRecognizer | None = None
        self._opening = self._lost = self._closed = False
        self._next = 0.0  # s, when they may be opened

    def hear(self, pcm: bytes) -> None:
        """Take 16-bit mono sound of 16 kHz that ended now.

        Raises MessageError if it is empty, too long or ends in half a sample.
        """
        if len(pcm) % 2 or not 0 < len(pcm) <= LARGEST_MESSAGE:
            expected = f"expected an even number, from 2 to {LARGEST_MESSAGE}"
            raise MessageError(f"found {len(pcm)} bytes of sound, {expected}")
        now = self._clock()
        begin = now - len(pcm) / 32_000
        with self._lock:
            if self._closed:
                return
            if self._recognizer is not None:
                self._recognizer.feed(pcm, begin)
                return
            if not self._opening and now >= self._next:
                self._opening = True
                threading.Thread(target=self._open, name="ears", daemon=True).start()
            if self._opening:
                self._early.hear(pcm, begin)

    def end(self) -> None:
        """Note that no sound follows for now."""
        with self._lock:
            (self._recognizer or self._early).end()

    def mute(self, seconds: float) -> None:
        """Leave out what comes while the robot itself speaks, for `seconds` from now."""
        now = self._clock()
        with self._lock:
            (self._recognizer or self._early).mute(now, now + seconds + ECHO)

    def close(self) -> None:
        """Stop hearing."""
        with self._lock:
            self._closed = True
            if self._recognizer is not None:
                self._recognizer.close()

    def _open(self) -> None:
        try:
            transcriber, detector = self._hearing.process.transcriber(self._vocabulary), self._hearing.detector()
        except Exception:
            logger.exception("speech recognition does not start")
            self._failed()
            return
        with self._lock:
            if self._closed:
                return
            self._recognizer = StreamingRecognizer(
                transcriber,
                detector,
                self._inbox.push_partial,
                self._inbox.push_word,
                on_alive=lambda: self._inbox.alive(SENSOR, self._clock()),
                clock=self._clock,
            )
            self._early.replay(self._recognizer)
            back = self._lost
        if back:
            self._report(SensorState.OK)

    def _failed(self) -> None:
        with self._lock:
            self._opening, self._next = False, self._clock() + AGAIN
            self._early.forget_sound()
            first, self._lost = not self._lost, True
        if first and not self._closed:
            self._report(SensorState.LOST)

    def _report(self, state: SensorState) -> None:
        self._tell(SensorStatus(SENSOR, state, TEXTS[state].format(name=SENSOR)))
