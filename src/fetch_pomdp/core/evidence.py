"""What each modality has said so far: where a belief comes from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.observation import Parts


@dataclass(frozen=True, slots=True)
class LogOdds:
    """Logarithms (nats) of how much likelier one item is than another, by where that comes from.

    Above 0 speaks for the first. Infinite where an item is impossible.
    """

    prior: float
    words: float
    answers: float
    pointing: float

    @property
    def total(self) -> float:
        """The log-odds of the belief itself."""
        return self.prior + self.words + self.answers + self.pointing


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """The prior, and the log-likelihood of all that was said and seen, a modality each. Immutable.

    Each (n_items,), read-only, in scene order. Together they are the logarithm of the belief, up to a constant.
    """

    prior: Vector
    words: Vector  # sum of log p(l_b | i_d), Eq. 4
    answers: Vector  # sum of log p(l_r | i_d, i_r), Eq. 6
    pointing: Vector  # sum of log p(g | i_d), Eq. 7
    unanswered: int | None = None  # the item asked about, as long as no response has been heard since

    def __post_init__(self) -> None:
        for sums in self._sums:
            sums.flags.writeable = False

    @classmethod
    def none(cls, log_prior: Vector) -> Self:
        """Return the evidence an interaction starts with. log_prior: (n_items,)."""
        words, answers, pointing = np.zeros((3, len(log_prior)))
        return cls(log_prior, words, answers, pointing)

    def plus(self, parts: Parts, *, answered: bool) -> Evidence:
        """Return the evidence after an observation. answered: whether it held a response."""
        return Evidence(
            self.prior,
            self.words + parts.words,
            self.answers + parts.answers,
            self.pointing + parts.pointing,
            None if answered else self.unanswered,
        )

    def without_talk(self) -> Evidence:
        """Return the evidence without what was said: somebody has taken it back."""
        nothing = np.zeros_like(self.words)
        return Evidence(self.prior, nothing, nothing.copy(), self.pointing)

    def asked(self, item: int) -> Evidence:
        """Return the evidence after a question about an item."""
        return Evidence(self.prior, self.words, self.answers, self.pointing, item)

    def log_odds(self, item: int, rival: int) -> LogOdds:
        """Return the log-odds of an item against another. NaN between two that are impossible for the same reason."""
        found = (float(sums[item]) - float(sums[rival]) for sums in self._sums)
        return LogOdds(*found)

    @property
    def _sums(self) -> tuple[Vector, Vector, Vector, Vector]:
        return self.prior, self.words, self.answers, self.pointing
