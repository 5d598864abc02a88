"""The parameters that can be fitted, each on a line of its own: all numbers from -inf to inf make sense there."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fetch_pomdp.core.model import LARGEST_SIGMA, Model

FARTHEST = 12.0  # of a share's logit: a share within 6e-6 of 0 or 1 is as good as at the end


@dataclass(frozen=True, slots=True)
class Share:
    """A parameter between two ends, by the logit of where it stands between them.

    Prior: Beta(1/2, 1/2) of where it stands, Jeffreys' for a proportion.
    """

    name: str
    start: float  # the value at the lower end of the line
    end: float
    unit: str = ""

    @property
    def line(self) -> tuple[float, float]:
        """The ends of the line."""
        return -FARTHEST, FARTHEST

    @property
    def centre_place(self) -> float:
        """Where a search begins."""
        return 0.0

    def value(self, place: float) -> float:
        """Return the parameter at a place on the line."""
        return self.start + (self.end - self.start) / (1.0 + math.exp(-place))

    def log_prior(self, place: float) -> float:
        """Return the log density of the prior on the line, up to a constant."""
        return -0.5 * (math.log1p(math.exp(-place)) + math.log1p(math.exp(place)))

    @property
    def extremes(self) -> tuple[float, float]:
        """The values at the two ends."""
        return self.start, self.end


@dataclass(frozen=True, slots=True)
class Size:
    """A parameter above 0, by its logarithm. Prior: the logarithm is N(log centre, spread)."""

    name: str
    low: float
    high: float
    centre: float
    spread: float
    unit: str = ""

    @property
    def line(self) -> tuple[float, float]:
        """The ends of the line."""
        return math.log(self.low), math.log(self.high)

    @property
    def centre_place(self) -> float:
        """Where a search begins."""
        return math.log(self.centre)

    def value(self, place: float) -> float:
        """Return the parameter at a place on the line."""
        return min(max(math.exp(place), self.low), self.high)

    def log_prior(self, place: float) -> float:
        """Return the log density of the prior on the line, up to a constant."""
        return -0.5 * ((place - math.log(self.centre)) / self.spread) ** 2

    @property
    def extremes(self) -> tuple[float, float]:
        """The values at the two ends."""
        return 0.0, self.high


Scale = Share | Size
_PAPER = Model()

# What each modality tells of, together: given the state the modalities are independent (Eq. 3).
POINTING: tuple[Scale, ...] = (
    Size("sigma", 0.003, LARGEST_SIGMA, _PAPER.sigma, 1.0, "rad"),
    Share("p_g", 0.0, 1.0),
)
SPEAKING: tuple[Scale, ...] = (Share("p_l", 0.0, 1.0), Share("p_answer_again", 0.0, 1.0))
NAMING: tuple[Scale, ...] = (Size("alpha", 1e-4, 1e3, _PAPER.alpha, 2.0),)
ANSWERING: tuple[Scale, ...] = (Share("p_truth", 1.0, 0.5),)  # by its error rate
FITTED = (*POINTING, *SPEAKING, *NAMING, *ANSWERING)
