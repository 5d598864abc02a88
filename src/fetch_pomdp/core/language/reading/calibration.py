"""How far to believe a reader that is not ours: what it says of each item, made as sure as it turned out to be right.

Choice: p = own q_own + even / n + (1 - own - even) q^exponent / sum(q^exponent), with q the chances that the reader
gave and q_own those of our reader. An exponent below 1 makes it less sure (as a temperature above 1 does); a share of
our own reader helps where the other one is wrong; a share for all items alike bounds what one utterance can do.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fetch_pomdp import checks
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError

LEAST = 1e-12
NAMES = ("exponent", "own", "even")


@dataclass(frozen=True, slots=True, kw_only=True)
class Calibration:
    """What is believed of a reader's chances; the defaults hold before any data."""

    exponent: float = 1.0  # above 0
    own: float = 0.0  # share of our own reader, 0 to 1
    even: float = 0.05  # share of all items alike, above 0

    def __post_init__(self) -> None:
        checks.within(self.exponent, 1e-6, 1e6, "exponent", "a number above 0", InputError)
        checks.within(self.own, 0.0, 1.0, "own", "a share from 0 to 1", InputError)
        checks.within(self.even, 1e-9, 1.0, "even", "a share above 0, at most 1", InputError)
        if self.own + self.even > 1.0 + 1e-9:
            raise InputError(f"found {self.own} and {self.even}, expected shares of at most 1 together", field="own")

    def believed(self, chances: Vector, own: Vector) -> Vector:
        """Return the chance of each item, (n_items,). chances, own: (n_items,), of the reader and of ours."""
        log = self.exponent * np.log(np.maximum(chances, LEAST))
        sharp = np.exp(log - log.max())
        sharp /= sharp.sum()
        return np.asarray(self.own * own + self.even / len(own) + (1.0 - self.own - self.even) * sharp)


def calibration_of(path: str | Path) -> Calibration:
    """Return the calibration in a file. Raises InputError for a name or value that is none."""
    return read_toml(path, InputError).build(_checked)


def _checked(data: Mapping[str, Any]) -> Calibration:
    checks.required(data, ("calibration",), InputError)
    found = checks.mapping(data["calibration"], "calibration", InputError)
    checks.known(found, NAMES, "number", InputError)
    try:
        return Calibration(**found)
    except InputError as error:
        raise error.within("calibration") from None
