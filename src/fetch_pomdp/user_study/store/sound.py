"""Sound that was kept, as a WAV file whose time is the trial's clock."""

from __future__ import annotations

import wave
from collections.abc import Iterable
from pathlib import Path

RATE, WIDTH = 16_000, 2  # Hz, bytes
JITTER = 0.1  # s that a piece may come late and still follow the one before it


def write_wav(path: Path, pieces: Iterable[tuple[float, bytes]]) -> None:
    """Write pieces of sound, each with the time (s) it began at; nothing for no pieces.

    Where nothing was kept there is silence.

    Choice: a piece that is late by less than JITTER follows at once, for it is the network that was late.
    """
    stream: wave.Wave_write | None = None
    for start, pcm in pieces:
        if stream is None:
            path.parent.mkdir(parents=True, exist_ok=True)
            stream = wave.open(str(path), "wb")  # noqa: SIM115
            stream.setparams((1, WIDTH, RATE, 0, "NONE", ""))
        gap = round(start * RATE) - stream.tell()
        if gap > JITTER * RATE:
            stream.writeframesraw(bytes(WIDTH * gap))
        stream.writeframesraw(pcm)
    if stream is not None:
        stream.close()
