"""The reader's weights: what each one means, what it is before any data, and a vector of them to fit.

A weight is a number, or an array of shape (p, 1, 1) that carries p variants at once through the same arithmetic: so a
gradient by differences costs little more than one evaluation.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from fetch_pomdp import checks
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError

# name: (value before any data, whether it is positive and so fitted as a factor, what it is)
WEIGHTS: Mapping[str, tuple[float, bool, str]] = {
    "word_missing": (0.02, True, "degree of a word that an item does not have"),
    "rank_blur": (0.25, True, "differences that are seen as the same, in spreads of the items"),
    "rank_fall": (1.3, True, "fall of the degree (nats) with each item that comes before"),
    "count_fall": (1.3, True, "the same where a number is counted to"),
    "extreme_fall": (1.2, True, "the same for the farthest on a side"),
    "middle_fall": (0.8, True, "the same for the middle"),
    "group_middle_fall": (1.5, True, "the same for the middle of a group"),
    "alone_fall": (0.6, True, "the same for what stands alone"),
    "crowd_fall": (0.3, True, "the same for what is surrounded"),
    "front_fall": (0.7, True, "the same for what is in front of a person"),
    "depth": (0.5, True, "how much nearness to a person is depth, against straight distance (as odds)"),
    "aside": (0.7, True, "how much farther something is in front of a person for being to the side"),
    "side_blur": (0.35, True, "softness of the border between sides, in spreads"),
    "side_border": (0.0, False, "where the border lies, in spreads towards the side"),
    "side_fall": (0.35, True, "fall of the degree of a side with each item that is farther on it"),
    "middle_own": (0.5, True, "how much the middle is that of the items spoken of (as odds)"),
    "near_reach": (0.5, True, "how far next to reaches, in distances of neighbours"),
    "touch_reach": (0.3, True, "how far touching reaches"),
    "about_reach": (0.9, True, "how far near reaches"),
    "way_reach": (0.8, True, "how far a direction from a landmark reaches"),
    "way_turn": (2.5, True, "how sharp a direction is"),
    "direct_turn": (1.3, True, "how much sharper, said to be direct"),
    "direct_reach": (0.8, True, "how much shorter, said to be direct"),
    "missing": (0.03, True, "degree of a relation that does not hold"),
    "between_wide": (0.5, True, "detour that still is between, in distances of neighbours"),
    "between_reach": (1.2, True, "how far apart the two may be"),
    "between_even": (0.5, True, "how uneven the two distances may be"),
    "group_near": (2.5, True, "how close the items of a group must be"),
    "group_spread": (0.8, True, "how compact a group must be"),
    "group_apart": (0.7, True, "how far others must be from a group"),
    "group_outside": (0.05, True, "degree of an item outside of the group that is spoken of"),
    "not_floor": (0.03, True, "degree of what is said not to be"),
    "view_you": (0.3, False, "log-odds that the listener's left and right are meant where nobody's are named"),
    "depth_you": (0.8, False, "log-odds that the listener's front and behind are meant"),
    "same_view": (0.5, False, "log-odds that both are the same person's"),
    "swapped": (-2.0, False, "log-odds that the writer says me for the listener and you for themselves"),
    "named_view": (0.8, False, "log-odds that a view named once holds for the rest"),
    "seen_view": (2.5, True, "the same where it is said to be somebody's point of view"),
    "near_you": (2.0, False, "log-odds that the closest is the closest to the listener"),
    "speaker": (0.3, True, "how much it counts what else would have told an item apart"),
    "speaker_sharpness": (2.0, True, "how much people prefer what tells apart"),
    "speaker_length": (1.0, True, "how much they prefer a word less"),
    "fits": (0.7, True, "how much a reading that fits the table better counts"),
    "cost": (0.8, True, "how much a dearer parse counts less"),
    "nested": (0.2, False, "how much a part of a landmark, against one of what is wanted, counts as cost"),
    "sharpness": (1.0, True, "exponent of the likelihood of an item"),
    "lost": (-3.0, False, "log-odds that an utterance was not understood"),
    "lost_unknown": (2.0, True, "the same, more for a word in two that nobody knows"),
    "lost_skipped": (0.3, True, "the same, more for what was left out"),
}
NAMES = tuple(WEIGHTS)


@dataclass(frozen=True, slots=True, eq=False)
class Weights:
    """Values of all weights by name, numbers or (p, 1, 1) arrays."""

    values: Any

    @classmethod
    def default(cls) -> Weights:
        """Return those that hold before any data."""
        return cls.at(np.zeros(len(NAMES)))

    @classmethod
    def at(cls, theta: Vector) -> Weights:
        """Return those at a point of the space that is fitted: a factor's logarithm, or a difference; 0 is no data.

        theta: (n_weights,), or (n_weights, p) for p variants.
        """
        found: dict[str, Any] = {}
        for (name, (value, positive, _)), place in zip(WEIGHTS.items(), theta, strict=True):
            moved = value * np.exp(place) if positive else value + place
            found[name] = moved[:, None, None] if np.ndim(moved) else float(moved)
        return cls(SimpleNamespace(**found))

    @classmethod
    def of(cls, named: Mapping[str, float]) -> Weights:
        """Return those of a file; one that it does not name is what it is before any data."""
        return cls.at(theta_of(named))


def theta_of(named: Mapping[str, float]) -> Vector:
    """Return the point of the space that is fitted at which weights have these values, (n_weights,)."""
    return np.array([
        0.0 if name not in named else math.log(named[name] / value) if positive else named[name] - value
        for name, (value, positive, _) in WEIGHTS.items()
    ])  # fmt: skip


@functools.cache
def shipped() -> Mapping[str, float]:
    """Return the weights that come with the package, by name: learnt as their file says."""
    return weights_of(Path(__file__).with_name("weights.toml"))


def weights_of(path: str | Path) -> Mapping[str, float]:
    """Return the weights of a file, by name. Raises InputError for a name or value that is none."""
    return read_toml(path, InputError).build(_checked)


def _checked(data: Mapping[str, Any]) -> Mapping[str, float]:
    found = data.get("weights", {})
    checks.known(found, NAMES, "weight", InputError)
    for name, value in found.items():
        positive = WEIGHTS[name][1]
        expected = "a number above 0" if positive else "a number"
        checks.within(value, 1e-9 if positive else -1e9, 1e9, f"weights.{name}", expected, InputError)
    return dict(found)
