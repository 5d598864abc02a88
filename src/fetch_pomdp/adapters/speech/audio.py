"""Sound as 16 kHz mono: from a WAV file, from raw PCM on a pipe, or from a microphone.

Each is opened by a function that returns a Sound; what can be known to be wrong is raised then, not halfway.
"""

from __future__ import annotations

import queue
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any, BinaryIO, Protocol

import numpy as np
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech import wav
from fetch_pomdp.errors import AudioError, MissingExtraError
from fetch_pomdp.extras import load

RATE = 16_000  # Hz, of every Sound
BLOCK = 0.02  # s read from a pipe or a microphone at a time
BUFFERED = 600.0  # s of microphone sound kept for a listener that is busy

Samples = NDArray[np.int16]
Mono = NDArray[np.float32]  # -1 to 1
Device = Any  # sounddevice has no types
Buffer = Any  # what cffi calls a buffer


class Sound(Protocol):
    """A stream of 16 kHz mono samples."""

    def read(self, count: int) -> Samples:
        """Wait for the next `count` samples and return them; fewer, and then none, only at the end of the stream.

        Raises AudioError for a stream that breaks.
        """
        ...


class _Stream:
    """A Sound over blocks of any rate, which are asked for only when they are needed."""

    def __init__(self, blocks: Iterator[Mono], rate: int) -> None:
        self._blocks = blocks if rate == RATE else _resampled(blocks, rate)
        self._ready = np.empty(0, np.float32)

    def read(self, count: int) -> Samples:
        parts = [self._ready]
        have = len(self._ready)
        while have < count and (block := next(self._blocks, None)) is not None:
            parts.append(block)
            have += len(block)
        joined = np.concatenate(parts)
        self._ready = joined[count:]
        return np.asarray(np.clip(np.round(joined[:count] * 32768), -32768, 32767), np.int16)


def open_wav(path: str | Path) -> Sound:
    """Open a WAV file of any rate and any number of channels, which are averaged.

    It may be PCM, floating point, A-law or mu-law. Raises AudioError for a file that is missing, empty, cut short or of
    another format; MissingExtraError without soxr for a rate other than 16 kHz.
    """
    layout = wav.read_layout(Path(path))
    return _Stream(wav.blocks(Path(path), layout), layout.rate)


def open_raw(stream: BinaryIO, rate: int = RATE, name: str = "raw PCM") -> Sound:
    """Take 16-bit little-endian mono samples at `rate` (Hz) from a binary stream, as they come.

    The Sound raises AudioError when it is read if the stream is a WAV file, breaks, or ends without a sample. Half a
    sample at the end is dropped: it is what a stopped pipe leaves.
    """
    if not 1000 <= rate <= 1_000_000:
        raise AudioError(f"found a rate of {rate!r} Hz, expected 1000 to 1000000", source=name)
    return _Stream(_raw_blocks(stream, rate, name), rate)


def open_microphone(device: str | int | None = None) -> Sound:
    """Listen to a microphone, the system's default unless a device's name or number is given.

    Raises MissingExtraError without sounddevice or PortAudio, AudioError without such a microphone. The Sound raises
    AudioError when nobody has read it for ten minutes.
    """
    try:
        sounddevice = load("sounddevice", "speech")
    except OSError:  # what sounddevice raises without PortAudio, which pip does not bring on Linux
        raise MissingExtraError("PortAudio is not installed; install it with: apt install libportaudio2") from None
    heard: queue.Queue[bytes] = queue.Queue(int(BUFFERED / BLOCK))
    overrun: list[bool] = []

    def keep(block: Buffer, *_: object) -> None:
        try:
            heard.put_nowait(bytes(block))
        except queue.Full:
            overrun.append(True)

    name = "microphone" if device is None else f"microphone {device}"
    frames = int(BLOCK * RATE)
    try:
        microphone = sounddevice.RawInputStream(RATE, frames, device, 1, "int16", callback=keep)
        microphone.start()
    except (sounddevice.PortAudioError, ValueError) as error:  # ValueError: no device of that name
        raise AudioError(f"found none ({error}), expected one that records 16 kHz mono", source=name) from None
    return _Stream(_microphone_blocks(microphone, heard, overrun, name), RATE)


def _resampled(blocks: Iterator[Mono], rate: int) -> Iterator[Mono]:
    resampler = load("soxr", "speech").ResampleStream(rate, RATE, 1, dtype="float32")
    end = np.empty(0, np.float32)
    return (resampler.resample_chunk(block, last=block is end) for block in chain(blocks, [end]))


def _raw_blocks(stream: BinaryIO, rate: int, name: str) -> Iterator[Mono]:
    size = 2 * max(1, int(BLOCK * rate))  # bytes
    data = _read(stream, size, name)
    if data.startswith(b"RIFF"):
        raise AudioError("found a WAV file, expected raw samples without a header", source=name)
    if len(data) < 2:
        raise AudioError("found no sound, expected 16-bit little-endian mono samples", source=name)
    while data:
        yield np.frombuffer(data, "<i2", len(data) // 2).astype(np.float32) / np.float32(32768)
        data = _read(stream, size, name)


def _read(stream: BinaryIO, size: int, name: str) -> bytes:
    """Read `size` bytes; fewer only at the end, also from an unbuffered pipe, which returns what it has."""
    parts: list[bytes] = []
    try:
        while size and (part := stream.read(size)):
            parts.append(part)
            size -= len(part)
    except (OSError, ValueError) as error:  # ValueError: closed meanwhile
        raise AudioError(f"found a stream that broke ({error}), expected more sound or its end", source=name) from None
    return b"".join(parts)


def _microphone_blocks(microphone: Device, heard: queue.Queue[bytes], overrun: list[bool], name: str) -> Iterator[Mono]:
    try:
        while not overrun:
            try:
                block = heard.get(timeout=5.0)
            except queue.Empty:
                found = "found no sound for 5 s, expected a microphone that is connected"
                raise AudioError(found, source=name) from None
            yield np.frombuffer(block, "<i2").astype(np.float32) / np.float32(32768)
        raise AudioError(f"found {BUFFERED:.0f} s of sound nobody read, expected to be read", source=name)
    finally:
        microphone.close()
