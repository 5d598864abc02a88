"""PCM WAV files, read strictly.

The standard library's wave does not notice that a file is cut short, and on Python 3.11 refuses sox's 24-bit ones.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from fetch_pomdp.errors import AudioError

BLOCK = 1 << 14  # frames read at a time
PCM, EXTENSIBLE = 0x0001, 0xFFFE
OTHERS = {0x0002: "ADPCM", 0x0003: "floating point", 0x0006: "A-law", 0x0007: "mu-law", 0x0011: "ADPCM", 0x0055: "MP3"}
EXPECTED = "expected PCM of 8, 16, 24 or 32 bits"


@dataclass(frozen=True, slots=True)
class Layout:
    """Where the samples of a WAV file are, and what they look like."""

    rate: int  # Hz
    channels: int
    width: int  # bytes a sample
    offset: int  # bytes before the samples
    frames: int  # samples a channel


def read_layout(path: Path) -> Layout:
    """Read the header. Raises AudioError for a file that is missing, empty, cut short or no PCM WAV file."""
    try:
        with path.open("rb") as file:
            return _layout(file)
    except OSError as error:
        found = (error.strerror or str(error)).lower()
        raise AudioError(f"found {found}, expected a WAV file", source=str(path)) from None
    except AudioError as error:
        raise error.located(str(path), None) from None


def blocks(path: Path, layout: Layout) -> Iterator[NDArray[np.float32]]:
    """Yield the samples from -1 to 1, the channels averaged. Raises AudioError if the file shrank meanwhile."""
    with path.open("rb") as file:
        file.seek(layout.offset)
        left = layout.frames
        while left:
            count = min(left, BLOCK)
            data = file.read(count * layout.channels * layout.width)
            if len(data) < count * layout.channels * layout.width:
                raise AudioError("found fewer samples than when it was opened, expected it unchanged", source=str(path))
            frames = _numbers(data, layout.width).reshape(count, layout.channels)
            yield np.asarray(frames.mean(axis=1), np.float32)
            left -= count


def _numbers(data: bytes, width: int) -> NDArray[np.float32]:
    if width == 1:  # the one width without a sign
        return (np.frombuffer(data, np.uint8).astype(np.float32) - 128) / np.float32(128)
    if width == 3:
        wide = np.zeros((len(data) // 3, 4), np.uint8)
        wide[:, 1:] = np.frombuffer(data, np.uint8).reshape(-1, 3)
        data, width = wide.tobytes(), 4
    return np.asarray(np.frombuffer(data, f"<i{width}") / 2.0 ** (8 * width - 1), np.float32)


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
    rate, channels, width = _format(file, *chunks[b"fmt "])
    if b"data" not in chunks:
        raise AudioError("found no samples, expected a data chunk")
    offset, length = chunks[b"data"]
    if offset + length > size:
        raise AudioError(
            f"found {size - offset} bytes of samples, expected {length}, as the header says: it is cut short"
        )
    frames = length // (channels * width)
    if not frames:
        raise AudioError("found no samples, expected one or more")
    return Layout(rate, channels, width, offset, frames)


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


def _format(file: BinaryIO, offset: int, length: int) -> tuple[int, int, int]:
    file.seek(offset)
    data = file.read(min(length, 40))
    if len(data) < 16:
        raise AudioError(f"found a fmt chunk of {len(data)} bytes, expected 16 or more")
    tag, channels, rate, _, align, bits = struct.unpack("<HHIIHH", data[:16])
    if tag == EXTENSIBLE and len(data) >= 26:
        (tag,) = struct.unpack("<H", data[24:26])
    if tag != PCM:
        raise AudioError(f"found {OTHERS.get(tag, f'format {tag:#06x}')}, {EXPECTED}")
    if not channels or not 1000 <= rate <= 1_000_000:
        raise AudioError(f"found {channels} channels at {rate} Hz, expected 1 or more at 1000 to 1000000 Hz")
    if bits not in (8, 16, 24, 32) or align != channels * bits // 8:
        raise AudioError(f"found {bits} bits in frames of {align} bytes for {channels} channels, {EXPECTED}")
    return rate, channels, bits // 8
