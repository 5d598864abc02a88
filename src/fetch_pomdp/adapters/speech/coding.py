"""Samples as WAV files hold them, from bytes to numbers from -1 to 1."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Coding:
    """How a sample is written."""

    width: int  # bytes a sample
    decode: Callable[[bytes], Numbers]  # of whole samples; what is written beyond -1 to 1 is cut off, NaN stays


def coding(tag: int, bits: int) -> Coding | None:
    """Return the coding of a WAV format tag and a number of bits a sample, or None for one that we do not read."""
    return _CODINGS.get((tag, bits))


def _unsigned(data: bytes) -> Numbers:
    return (np.frombuffer(data, np.uint8).astype(np.float32) - 128) / np.float32(128)


def _whole(width: int) -> Callable[[bytes], Numbers]:
    def decode(data: bytes) -> Numbers:
        return np.asarray(np.frombuffer(data, f"<i{width}") / 2.0 ** (8 * width - 1), np.float32)

    return decode


def _three_bytes(data: bytes) -> Numbers:
    wide = np.zeros((len(data) // 3, 4), np.uint8)
    wide[:, 1:] = np.frombuffer(data, np.uint8).reshape(-1, 3)
    return np.asarray(wide.view("<i4")[:, 0] / 2.0**31, np.float32)


def _floating(width: int) -> Callable[[bytes], Numbers]:
    def decode(data: bytes) -> Numbers:
        return np.asarray(np.clip(np.frombuffer(data, f"<f{width}"), -1.0, 1.0), np.float32)

    return decode


def _a_law_table() -> Numbers:
    """Return the value of each byte of A-law (ITU-T G.711, table 1a), (256,)."""
    code = np.arange(256) ^ 0x55
    step, segment = (code & 0x0F) * 16, (code & 0x70) >> 4
    size = np.where(segment == 0, step + 8, (step + 0x108) << np.maximum(segment - 1, 0))
    return np.asarray(np.where(code & 0x80, size, -size) / 32768, np.float32)


def _mu_law_table() -> Numbers:
    """Return the value of each byte of mu-law (ITU-T G.711, table 2a), (256,)."""
    code = ~np.arange(256) & 0xFF
    size = ((((code & 0x0F) << 3) + 0x84) << ((code & 0x70) >> 4)) - 0x84
    return np.asarray(np.where(code & 0x80, -size, size) / 32768, np.float32)


def _looked_up(table: Numbers) -> Callable[[bytes], Numbers]:
    def decode(data: bytes) -> Numbers:
        return table[np.frombuffer(data, np.uint8)]

    return decode


_CODINGS = {
    (0x0001, 8): Coding(1, _unsigned),
    (0x0001, 16): Coding(2, _whole(2)),
    (0x0001, 24): Coding(3, _three_bytes),
    (0x0001, 32): Coding(4, _whole(4)),
    (0x0003, 32): Coding(4, _floating(4)),
    (0x0003, 64): Coding(8, _floating(8)),
    (0x0006, 8): Coding(1, _looked_up(_a_law_table())),
    (0x0007, 8): Coding(1, _looked_up(_mu_law_table())),
}
