"""Every parameter and reward of Section III, checked when built."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, Self, get_args

from fetch_pomdp import checks
from fetch_pomdp.core.turns import Turns
from fetch_pomdp.errors import ModelError

GestureLikelihood = Literal["eq7", "exact"]
LARGEST_SIGMA = 0.7  # rad: above it a sampled ray might wrap around the sphere (chance over 1e-5)
LARGEST_REWARD = 1e6


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """Parameters of Section III-C; the defaults are the paper's. Raises ModelError for one out of its range."""

    alpha: float = 0.2  # smoothing of the unigram model (Eq. 5), above 0
    p_l: float = 0.95  # chance that base words, and that a response, are spoken in a step (Eq. 4, 6), in (0, 1)
    p_g: float = 0.1  # chance that the person points in a step (Eq. 7), in [0, 1)
    sigma: float = 0.15  # rad, spread of pointing (Eq. 7), in (0, 0.7]
    p_truth: float = 0.99  # chance that a response is the true one (Table I), in [0.5, 1]
    gesture_threshold: float = 0.3  # rad: a ray farther than this from every item is no pointing, in (0, pi]
    gesture_likelihood: GestureLikelihood = "eq7"  # or "exact", the density of the sampled rays
    p_answer_again: float = 1.0  # factor on p_l for a response in a step after a wait, in [0, 1]
    turns: Turns | None = None  # of live people, who speak and point by where the talk stands; none in the paper

    def __post_init__(self) -> None:
        ranges = {
            "alpha": (1e-9, 1e9, "a number above 0"),
            "p_l": (1e-9, 1 - 1e-9, "a probability above 0 and below 1"),
            "p_g": (0.0, 1 - 1e-9, "a probability from 0 to below 1"),
            "sigma": (1e-6, LARGEST_SIGMA, f"an angle above 0 and at most {LARGEST_SIGMA} rad"),
            "p_truth": (0.5, 1.0, "a probability from 0.5 to 1"),
            "gesture_threshold": (1e-6, math.pi, "an angle above 0 and at most pi rad"),
            "p_answer_again": (0.0, 1.0, "a factor from 0 to 1"),
        }
        for name, (low, high, expected) in ranges.items():
            value = checks.within(getattr(self, name), low, high, name, expected, ModelError)
            object.__setattr__(self, name, value)
        if not isinstance(self.gesture_likelihood, str) or self.gesture_likelihood not in get_args(GestureLikelihood):
            found = checks.shown(self.gesture_likelihood)
            raise ModelError(f"found {found}, expected 'eq7' or 'exact'", field="gesture_likelihood")
        if self.turns is not None and not isinstance(self.turns, Turns):
            raise ModelError(f"found {checks.shown(self.turns)}, expected a table of chances, or none", field="turns")

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return this model with some parameters changed. Raises ModelError for a parameter that it does not have."""
        checks.mapping(changes, "", ModelError)
        checks.known(changes, [field.name for field in dataclasses.fields(self)], "parameter", ModelError)
        if changes.get("turns") is False:  # what a TOML file can say for none
            changes = {**changes, "turns": None}
        elif isinstance(turns := changes.get("turns"), Mapping):
            try:
                changes = {**changes, "turns": (self.turns or Turns()).with_changes(turns)}
            except ModelError as error:
                raise error.within("turns") from None
        return dataclasses.replace(self, **changes)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rewards:
    """The table R(s, a) of Section III-B. Raises ModelError where a price could not be one."""

    pick_correct: float = 10.0
    pick_wrong: float = -12.5
    point: float = -6.0  # a question, at most `wait`: it takes the robot no less time
    wait: float = -1.0  # at most 0

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            expected = f"a finite number within {LARGEST_REWARD:.0e}"
            value = getattr(self, field.name)
            value = checks.within(value, -LARGEST_REWARD, LARGEST_REWARD, field.name, expected, ModelError)
            object.__setattr__(self, field.name, value)
        self._check_order("pick_wrong", self.pick_correct, "below pick_correct", strict=True)
        self._check_order("wait", 0.0, "at most 0: waiting is no gain", strict=False)
        self._check_order("point", self.wait, "at most the reward of wait", strict=False)

    def _check_order(self, name: str, limit: float, expected: str, *, strict: bool) -> None:
        value = getattr(self, name)
        if value > limit or (strict and value == limit):
            raise ModelError(f"found {value!r}, expected {expected} ({limit!r})", field=name)

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return these rewards with some changed. Raises ModelError for a reward that does not exist."""
        checks.mapping(changes, "", ModelError)
        checks.known(changes, [field.name for field in dataclasses.fields(self)], "reward", ModelError)
        return dataclasses.replace(self, **changes)
