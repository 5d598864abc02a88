"""Ears that hear people while the robot talks: what the robot is known to say is taken out of what is heard.

A loudspeaker's sound comes back through the room. Who knows what was played, and when, can learn that way back and
subtract it: an adaptive filter, and a suppressor of what it leaves. On the page the browser itself does this.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain, repeat
from typing import Any

import numpy as np

from fetch_pomdp.adapters.speech.audio import RATE, Samples, Sound
from fetch_pomdp.adapters.speech.utterances import FRAME
from fetch_pomdp.errors import AudioError
from fetch_pomdp.extras import load

Canceller = Callable[[Samples, Samples], Samples]  # 10 ms that were heard, 10 ms that were played; gives 10 ms

TAIL = 4096  # samples that the linear filter is long: 256 ms of the room
ECHO = 30  # frames for which what was played still sounds in the room
LEAST_KEPT = -12.0  # dB of what was heard, below which all of it was the robot
INERTIA = 0.9  # of the means that are compared, from frame to frame
OPENS, STAYS_OPEN = 15, 30  # frames that count before and after somebody is noticed
AHEAD = 2  # frames by which what is played is known before its echo: without, WebRTC's filter finds none at the start


class Played:
    """What the robot plays, on the clock of what is heard: a Sound that is silent where nothing was put into it."""

    def __init__(self) -> None:
        self._sound = np.empty(0, np.int16)  # from `_time` on
        self._time = 0  # samples

    def play(self, samples: Samples, begin: float) -> None:
        """Put in what is played from `begin` (s) on. Raises AudioError for a time that was read already."""
        start = round(begin * RATE) - self._time
        if start < 0:
            found = f"found sound that began at {begin:.3f} s"
            raise AudioError(f"{found}, expected it before {self._time / RATE:.3f} s was heard", source="robot's voice")
        end = start + len(samples)
        longer = np.zeros(max(end, len(self._sound)), np.int32)
        longer[: len(self._sound)] = self._sound
        longer[start:end] += samples
        self._sound = np.asarray(np.clip(longer, -32768, 32767), np.int16)

    def read(self, count: int) -> Samples:
        """Return the next samples; see Sound. It never ends."""
        part, self._sound = self._sound[:count], self._sound[count:]
        self._time += count
        return np.pad(part, (0, count - len(part)))


class WithoutEcho:
    """A Sound without the echo of another. sound: what is heard; played: what the robot plays, from the same moment on.

    canceller: `echo_canceller()` unless given. What is heard is given 170 ms later, at its own time. Raises
    MissingExtraError without pyaec or livekit.
    """

    def __init__(self, sound: Sound, played: Sound, canceller: Canceller | None = None) -> None:
        cancel = echo_canceller() if canceller is None else canceller
        self._frames = _gated(_cancelled(sound, played, cancel))
        self._ready = np.empty(0, np.int16)

    def read(self, count: int) -> Samples:
        """Return the next samples, cleaned; see Sound."""
        parts, have = [self._ready], len(self._ready)
        while have < count and (frame := next(self._frames, None)) is not None:
            parts.append(frame)
            have += len(frame)
        joined = np.concatenate(parts)
        self._ready = joined[count:]
        return joined[:count]


@dataclass(frozen=True, slots=True)
class _Frame:
    """10 ms, fewer at the end. kept: dB, what was left of what was heard, averaged; None where nothing was played."""

    cleaned: Samples
    kept: float | None


def _cancelled(sound: Sound, played: Sound, cancel: Canceller) -> Iterator[_Frame]:
    """Yield what is heard without what is played."""
    waiting: deque[Samples] = deque()
    before = after = 0.0  # mean squares
    playing, since = 0, 0  # frames for which there still is an echo, and since there is
    ended = False
    while not ended or waiting:
        if not ended:
            waiting.append(sound.read(FRAME))
            ended = len(waiting[-1]) < FRAME
        heard = waiting.popleft() if ended or len(waiting) > AHEAD else None
        known = _whole(played.read(FRAME))
        cleaned = cancel(_whole(heard if heard is not None else known[:0]), known)
        playing = ECHO if known.any() else max(0, playing - 1)
        since = since + 1 if playing else 0
        if heard is not None:
            cleaned = cleaned[: len(heard)]
            before, after = _smooth(before, heard), _smooth(after, cleaned)
            kept = 10 * math.log10((after + 1) / (before + 1)) if since > OPENS else -math.inf  # no echo yet, maybe
            yield _Frame(cleaned, kept if playing else None)


def _gated(frames: Iterator[_Frame]) -> Iterator[Samples]:
    """Yield the frames, silent where too little is kept for anybody but the robot to have spoken around then."""
    window: deque[_Frame] = deque(maxlen=OPENS + STAYS_OPEN + 1)
    for frame in chain(frames, repeat(_Frame(np.empty(0, np.int16), None), OPENS)):
        window.append(frame)
        if len(window) > OPENS:
            now = window[-1 - OPENS]
            somebody = any(each.kept is not None and each.kept > LEAST_KEPT for each in window)
            yield now.cleaned if now.kept is None or somebody else np.zeros_like(now.cleaned)


def _whole(samples: Samples) -> Samples:
    return np.pad(samples, (0, FRAME - len(samples)))


def _smooth(mean: float, samples: Samples) -> float:
    """Return a running mean square with 10 ms more in it."""
    return INERTIA * mean + (1 - INERTIA) * float(np.mean(np.square(samples, dtype=float))) if len(samples) else mean


def echo_canceller() -> Canceller:
    """Return Speex's linear filter and WebRTC's canceller (AEC3) after it.

    Choice: WebRTC's alone leaves nothing of the robot, and of an answer over it too little to be understood; Speex's
    leaves the answer, and too much of the robot. Together they leave the answer alone, most times (docs/speech.md).
    Raises MissingExtraError without pyaec or livekit.
    """
    linear, rest = _speex(), _webrtc()
    return lambda heard, played: rest(linear(heard, played), played)


def _speex() -> Canceller:
    filter_ = load("pyaec", "echo").Aec(FRAME, TAIL, RATE, False)

    def clean(heard: Samples, played: Samples) -> Samples:
        return np.array(filter_.cancel_echo(heard.tolist(), played.tolist()), np.int16)

    return clean


def _webrtc() -> Canceller:
    rtc = load("livekit.rtc", "echo")
    module = load("livekit.rtc.apm", "echo").AudioProcessingModule(echo_cancellation=True, high_pass_filter=True)

    def frame(samples: Samples) -> Any:
        return rtc.AudioFrame(bytearray(samples.astype("<i2").tobytes()), RATE, 1, FRAME)

    def clean(heard: Samples, played: Samples) -> Samples:
        module.process_reverse_stream(frame(played))
        cleaned = frame(heard)
        module.set_stream_delay_ms(0)  # the two are on one clock; it finds out what is left of a delay
        module.process_stream(cleaned)
        return np.frombuffer(bytes(cleaned.data), "<i2").astype(np.int16)

    return clean
