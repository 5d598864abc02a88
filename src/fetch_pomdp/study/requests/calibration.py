"""Fits how far to believe a reader that is not ours (`reading.calibration`) to requests whose target is known.

Choice: maximum likelihood of the targets, with a prior worth one request for each of the three shares and a normal one
of the exponent's logarithm: a reader that was always right on few requests is not believed without any doubt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading.calibration import NAMES, Calibration
from fetch_pomdp.extras import load

MOST = 12.0  # of a share's logit, or the exponent's logarithm: a bound of the search


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """A request that two readers read. chances, own: (n_items,), of the reader and of ours. target: what was meant."""

    chances: Vector
    own: Vector
    target: int


def log_loss(records: Sequence[Record], calibration: Calibration) -> float:
    """Return the mean of -log of the chance of what was meant (nats)."""
    chances = [calibration.believed(each.chances, each.own)[each.target] for each in records]
    return -float(np.mean(np.log(chances)))


def fitted(records: Sequence[Record]) -> Calibration:
    """Return the likeliest calibration. Raises ValueError for no records, MissingExtraError without SciPy."""
    if not records:
        raise ValueError("found no records, expected one or more")

    def loss(place: Vector) -> float:
        found = _at(place)
        shares = np.array([found.own, found.even, 1.0 - found.own - found.even])
        prior = float(np.log(np.maximum(shares, 1e-12)).sum()) - 0.5 * float(place[0]) ** 2
        return len(records) * log_loss(records, found) - prior

    optimize = load("scipy.optimize", "study")
    starts = [np.array([0.0, own, -2.0]) for own in (-2.0, 2.0)]  # the reader, or ours, is the better one
    ends = [optimize.minimize(loss, start, method="L-BFGS-B", bounds=[(-MOST, MOST)] * 3) for start in starts]
    return _at(min(ends, key=lambda end: float(end.fun)).x)


def _at(place: Vector) -> Calibration:
    """Return the calibration at a place: log of the exponent, logits of own and even against the reader's share."""
    weights = np.exp([0.0, place[1], place[2]])
    _, own, even = weights / weights.sum()
    return Calibration(exponent=float(np.exp(place[0])), own=float(own), even=max(float(even), 1e-9))


def write_calibration(path: Path, calibration: Calibration, *, count: int, source: str) -> None:
    """Write a file that `calibration_of` reads, and that says what it was fitted to: `count` requests of a source."""
    lines = [
        f"# Fitted to {count} requests: {' '.join(source.split())}",
        "# What each one means: fetch_pomdp/core/language/reading/calibration.py.",
        "",
        "[calibration]",
        *(f"{name} = {getattr(calibration, name):.6g}" for name in NAMES),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
