"""A population without chance or difference, to change one thing at a time in, and what tests need around it."""

from __future__ import annotations

import math
from typing import Any

from numpy.random import Generator, default_rng

from fetch_pomdp.core.scene import Scene
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.people.person import Person
from fetch_pomdp.study.people.traits import Traits

SPREADS = ("word_time", "patience", "answer_delay", "delay", "rate")
CHANCES = ("place", "reword", "heed", "unsure", "late", "elaborate", "flip", "miss", "lost", "substitute", "delete")
STILL: dict[str, Any] = {
    **{f"{name}_spread": 0.0 for name in SPREADS},
    **{f"p_{name}": 0.0 for name in (*CHANCES, "insert", "correct", "point_again")},
    **{f"{name}_correlation": 0.0 for name in ("flip", "miss", "lost", "reading")},
    **dict.fromkeys(("bias", "bias_episode", "jitter", "tracker_noise", "reading"), 0.0),
    "p_answer": 1.0,
    "p_point": 1.0,
    "p_repeat_answer": 1.0,
    "p_name": 1.0,
    "descriptors": (0.0, 1.0),
    "confusions": {},
}
CLOCK = Durations(think=0.1, wait=1.0, arm=1.0, speak=0.8)
AMBIGUOUS = Scene.load("ambiguous")


def still(**changes: Any) -> People:
    """Return people who all do the same, but for `changes`."""
    return People(**{**STILL, **changes})


def somebody(desired: int = 3, rng: Generator | None = None, **changes: Any) -> Person:
    """Return one of them who wants an item of the ambiguous layout (3: marker-2)."""
    rng = rng or default_rng(1)
    return Person(AMBIGUOUS, desired, still(**changes).traits(rng), CLOCK, rng)


def traits(**changes: Any) -> Traits:
    return still(**changes).traits(default_rng(0))


def within(found: float, expected: float, deviation: float, count: int) -> bool:
    """Whether a mean of `count` draws is within four standard errors of what it should be."""
    return abs(found - expected) <= 4.0 * deviation / math.sqrt(count) + 1e-12


def share(found: float, expected: float, count: int) -> bool:
    """Whether a share of `count` draws is within four standard errors of its chance."""
    return within(found, expected, math.sqrt(expected * (1.0 - expected)), count)
