"""WAV files, read strictly: PCM, floating point, A-law and mu-law.

Choice: a reader of our own of two hundred lines, and no library. The standard library's wave knows PCM alone, refuses
sox's 24-bit files on Python 3.11 and does not notice that a file is cut short; soundfile would be one more dependency,
with a library in C, for what NumPy does.

Choice: channels are averaged, except where they cancel each other, as those of a balanced line that was recorded as
stereo do: of these the loudest is taken alone, and a warning says so.
"""

from __future__ import annotations

import dataclasses
import logging
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from fetch_pomdp.adapters.speech.coding import Coding, coding
from fetch_pomdp.errors import AudioError

logger = logging.getLogger(__name__)

BLOCK = 1 << 14  # frames read at a time
EXTENSIBLE = 0xFFFE
SUBTYPE = bytes.fromhex("000000001000800000aa00389b71")  # of an extensible format, after the tag
NAMES = {
    0x0001: "PCM", 0x0002: "ADPCM", 0x0003: "floating point", 0x0006: "A-law", 0x0007: "mu-law", 0x0011: "ADPCM",
    0x0031: "GSM", 0x0055: "MP3",
}  # fmt: skip
EXPECTED = "expected PCM of 8, 16, 24 or 32 bits, floating point, A-law or mu-law"
CONVERT = "convert it with: sox in.wav -b 16 -e signed-integer out.wav"
UNKNOWN_FROM = 0x7FFFE000  # bytes; sox writes sizes from here on to a pipe, ffmpeg 0xFFFFFFFF: whatever they hold
CANCELS = 0.01  # power of the average over that of the loudest channel, below which channels cancel each other


@dataclass(frozen=True, slots=True)
class Layout:
    """Where the samples of a WAV file are, and what they look like."""

    rate: int  # Hz
    channels: int
    coding: Coding
    offset: int  # bytes before the samples
    frames: int  # samples a channel
    channel: int | None = None  # from 0, the only one to be heard; None: their average


def read_layout(path: Path) -> Layout:
    """Read the header, and of a file with several channels whether they cancel each other.

    Raises AudioError for a file that is missing, empty, cut short or no WAV file of a format that we read.
    """
    try:
        with path.open("rb") as file:
            layout = _layout(file)
    except OSError as error:
        found = (error.strerror or str(error)).lower()
        raise AudioError(f"found {found}, expected a WAV file", source=str(path)) from None
    except AudioError as error:
        raise error.located(str(path), None) from None
    loudest = _cancelled(path, layout)
    if loudest is None:
        return layout
    logger.warning("%s: the channels cancel each other when mixed: only channel %d is heard", path, loudest + 1)
    return dataclasses.replace(layout, channel=loudest)


def blocks(path: Path, layout: Layout) -> Iterator[NDArray[np.float32]]:
    """Yield the samples from -1 to 1, of one channel or all averaged.

    Raises AudioError for samples that are no numbers, or if the file shrank meanwhile.
    """
    for frames in _frames(path, layout):
        one = frames.mean(axis=1) if layout.channel is None else frames[:, layout.channel]
        yield np.asarray(one, np.float32)


def _frames(path: Path, layout: Layout) -> Iterator[NDArray[np.float32]]:
    """Yield all samples, (frames, channels). Raises AudioError for what is no number, or a file that shrank."""
    size = layout.channels * layout.coding.width
    with path.open("rb") as file:
        file.seek(layout.offset)
        left = layout.frames
        while left:
            count = min(left, BLOCK)
            data = file.read(count * size)
            if len(data) < count * size:
                raise AudioError("found fewer samples than when it was opened, expected it unchanged", source=str(path))
            frames = layout.coding.decode(data).reshape(count, layout.channels)
            if np.isnan(frames).any():
                raise AudioError("found samples that are no numbers, expected sound", source=str(path))
            yield frames
            left -= count


def _cancelled(path: Path, layout: Layout) -> int | None:
    """Return the loudest channel of those that cancel each other, or None where they do not."""
    if layout.channels == 1:
        return None
    each, mixed = np.zeros(layout.channels), 0.0
    for frames in _frames(path, layout):
        each += np.square(frames, dtype=np.float64).sum(axis=0)
        mixed += float(np.square(frames.mean(axis=1), dtype=np.float64).sum())
    return int(each.argmax()) if mixed < CANCELS * each.max() else None


def _layout(file: BinaryIO) -> Layout:
    size = file.seek(0, 2)
    file.seek(0)
    if not size:
        raise AudioError("found an empty file, expected a WAV file")
    riff = file.read(12)
    if riff[:4] != b"RIFF" or riff[8:] != b"WAVE":
        raise AudioError(f"found a file that begins with {riff[:12]!r}, expected a WAV file (RIFF....WAVE)")
    chunks = dict(_chunks(file, size))
    if b"fmt " not in chunks:
        raise AudioError("found no fmt chunk, expected one before the samples")
    rate, channels, how = _format(file, *chunks[b"fmt "])
    if b"data" not in chunks:
        raise AudioError("found no samples, expected a data chunk")
    offset, length = chunks[b"data"]
    if _is_streamed(int.from_bytes(riff[4:8], "little"), length, size):
        length = size - offset
    if offset + length > size:
        raise AudioError(
            f"found {size - offset} bytes of samples, expected {length}, as the header says: it is cut short"
        )
    frames = length // (channels * how.width)
    if not frames:
        raise AudioError("found no samples, expected one or more")
    return Layout(rate, channels, how, offset, frames)


def _is_streamed(whole: int, length: int, size: int) -> bool:
    """Return whether a header was written to a pipe, before anybody knew how much would follow.

    whole: bytes of the file but the first 8, as it says; length: of its samples, as it says; size: bytes of the file.
    """
    return (length == 0 and whole != size - 8) or (length >= UNKNOWN_FROM and length > size)


def _chunks(file: BinaryIO, size: int) -> Iterator[tuple[bytes, tuple[int, int]]]:
    """Yield name, offset and length of the chunks up to the samples; what follows them is of no use to us."""
    offset = 12
    while offset + 8 <= size:
        file.seek(offset)
        name, length = struct.unpack("<4sI", file.read(8))
        yield name, (offset + 8, length)
        if name == b"data":
            return
        offset += 8 + length + length % 2


def _format(file: BinaryIO, offset: int, length: int) -> tuple[int, int, Coding]:
    file.seek(offset)
    data = file.read(min(length, 40))
    if len(data) < 16:
        raise AudioError(f"found a fmt chunk of {len(data)} bytes, expected 16 or more")
    tag, channels, rate, _, align, bits = struct.unpack("<HHIIHH", data[:16])
    if tag == EXTENSIBLE and data[26:] == SUBTYPE:
        (tag,) = struct.unpack("<H", data[24:26])
    if tag not in NAMES or not any(coding(tag, each) for each in (8, 16, 32)):
        raise AudioError(f"found {NAMES.get(tag, f'format {tag:#06x}')}, {EXPECTED}; {CONVERT}")
    if not channels or not 1000 <= rate <= 1_000_000:
        raise AudioError(f"found {channels} channels at {rate} Hz, expected 1 or more at 1000 to 1000000 Hz")
    how = coding(tag, bits)
    if how is None or align != channels * how.width:
        found = f"found {NAMES[tag]} of {bits} bits in frames of {align} bytes for {channels} channels"
        raise AudioError(f"{found}, {EXPECTED}; {CONVERT}")
    return rate, channels, how
