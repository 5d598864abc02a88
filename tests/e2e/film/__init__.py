"""A film of a person who points at known places on a screen, as Chromium's fake camera plays it (make.py drew it)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

FRAMES, INDEX = Path(__file__).with_name("frames.mjpeg"), Path(__file__).with_name("frames.json")
RATE = 30  # pictures a second
LAMP_OFF = 1.0  # s
UP, HELD = 2, 4  # times that each picture is shown in a row


def write(path: Path, places: Sequence[str], *, rest: float = 4.0, held: float = 2.6, between: float = 0.4) -> float:
    """Write a film in which the person rests, and then points at places, one after the other; return its length in s.

    rest: s before the first place and after the last; held: s for which each is pointed at; between: s for which the
    arm is down after each. A lamp is on from the film's beginning until LAMP_OFF s before the first place, so that a
    test knows where the film is.
    """
    index, raw = json.loads(INDEX.read_text()), FRAMES.read_bytes()
    ends = [sum(index["lengths"][: number + 1]) for number in range(len(index["lengths"]))]
    pictures = [raw[end - length : end] for end, length in zip(ends, index["lengths"], strict=True)]
    dark = [pictures[0]] * round(LAMP_OFF * RATE)
    shown = [pictures[1]] * round((rest - LAMP_OFF) * RATE) + dark
    for place in places:
        up, arms = (pictures[slice(*index["shown"][place][kind])] for kind in ("up", "held"))
        raising = [picture for picture in up for _ in range(UP)]
        holding = [arms[number // HELD % len(arms)] for number in range(round(held * RATE))]
        shown += [*raising, *holding, *reversed(raising), *([pictures[0]] * round(between * RATE))]
    shown += [pictures[0]] * round(rest * RATE)
    path.write_bytes(b"".join(shown))
    return len(shown) / RATE
