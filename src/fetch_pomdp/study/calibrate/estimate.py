"""Estimates and intervals of a few parameters from independent pieces of a likelihood.

Estimates are the mode of likelihood times prior on the scales' lines (MAP). An interval holds the places where the
log-posterior, along the line on which the other parameters follow by their Hessian, is within q^2 / 2 of the mode: the
profile likelihood to second order. People are not the model: steps of one interaction or person go together. So the
drop is scaled by the variance that the scores of independent pieces really have, over the one that the model claims
(Chandler and Bate 2007, "Inference for clustered data using the independence loglikelihood").
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.extras import load
from fetch_pomdp.study.calibrate.scales import Scale

LEVEL = 0.9
FALL = 1.35  # of the log-likelihood towards an end of a line, half the 90 % quantile of chi-squared: less tells nothing
STEP = 0.02  # on a line, of numeric derivatives
GRID = 9  # places on a line, of the coarse search
UNBOUNDED = 10**9  # degrees of freedom of a variance that is the model's own
LEAST = 1e-3  # information that every line is held to have
FEW = 3.0  # information, below which the scores are too few for their variance to be trusted where it is the smaller
ENOUGH_PEOPLE = 8  # below it, interactions are the independent pieces

Known = Literal["both", "low", "high", "none"]  # the limits that the logs set
Likelihood = Callable[[Vector], Vector]  # places on the lines to the log-likelihood of each step


@dataclass(frozen=True, slots=True)
class Pieces:
    """The independent pieces of logs: people, or interactions.

    Choice: how many of them are at which table is held to be chosen by whoever made the study. So differences between
    tables are no part of the variance: scores are compared within a table's pieces (a stratum).
    """

    of_step: Integers  # (n_steps,), number of each step's piece
    stratum: Integers  # (n_pieces,)


@dataclass(frozen=True, slots=True)
class Estimate:
    """A parameter: its most likely value, 90 % interval, and which limits the logs set; the others are its range's."""

    name: str
    value: float
    low: float
    high: float
    known: Known
    inflation: float  # the variance of the scores over the model's own
    unit: str = ""

    def covers(self, value: float) -> bool:
        """Whether the interval holds a value."""
        return self.low <= value <= self.high


def estimates(scales: Sequence[Scale], likelihood: Likelihood, pieces: Pieces) -> list[Estimate]:
    """Return estimates of parameters that are fitted together."""

    def log_posterior(places: Vector) -> float:
        prior = sum(scale.log_prior(place) for scale, place in zip(scales, places.tolist(), strict=True))
        return float(likelihood(places).sum()) + prior

    mode = _mode(scales, log_posterior)
    hessian = _hessian(log_posterior, mode)
    model_variance = _inverse(-hessian)
    robust, free = _robust_variance(likelihood, mode, pieces, model_variance)
    found = []
    for index, scale in enumerate(scales):
        information = -hessian[index, index]
        ratio = float(robust[index, index] / model_variance[index, index])
        inflation = ratio if information >= FEW else max(1.0, ratio)
        direction = model_variance[:, index] / model_variance[index, index]
        path = _Path(mode, direction, index, tuple(one.line for one in scales))
        limits = [_limit(log_posterior, path, side, _drop(inflation, free)) for side in (0, 1)]
        found.append(_estimate(scale, index, mode, limits, likelihood, inflation))
    return found


@dataclass(frozen=True, slots=True)
class _Path:
    """The line on which one parameter moves and the others follow."""

    mode: Vector
    direction: Vector
    index: int
    lines: tuple[tuple[float, float], ...]

    @property
    def line(self) -> tuple[float, float]:
        return self.lines[self.index]

    @property
    def begin(self) -> float:
        return float(self.mode[self.index])

    def at(self, place: float) -> Vector:
        lows, highs = zip(*self.lines, strict=True)
        return np.clip(self.mode + (place - self.begin) * self.direction, lows, highs)


def _drop(inflation: float, free: int) -> float:
    """Return how far the log-posterior may fall within an interval. free: degrees of freedom of the inflation."""
    stats = load("scipy.stats", "study")
    quantile = float(stats.t.ppf((1.0 + LEVEL) / 2.0, free))
    return 0.5 * inflation * quantile**2


def _mode(scales: Sequence[Scale], log_posterior: Callable[[Vector], float]) -> Vector:
    """Return the places of the largest log-posterior: the best of a coarse search of each line, then uphill."""
    optimize = load("scipy.optimize", "study")
    best = np.array([scale.centre_place for scale in scales])
    for index, scale in enumerate(scales):
        tried = [_at(best, index, place) for place in np.linspace(*scale.line, GRID)[1:-1].tolist()]
        best = max([best, *tried], key=log_posterior)
    bounds = [scale.line for scale in scales]
    found = optimize.minimize(lambda places: -log_posterior(places), best, method="L-BFGS-B", bounds=bounds)
    return np.asarray(found.x)


def _at(places: Vector, index: int, place: float) -> Vector:
    result = places.copy()
    result[index] = place
    return result


def _moved(places: Vector, *moves: tuple[int, float]) -> Vector:
    result = places.copy()
    for index, by in moves:
        result[index] += by
    return result


def _hessian(function: Callable[[Vector], float], at: Vector) -> Vector:
    size = len(at)
    result = np.empty((size, size))
    for row in range(size):
        for column in range(row + 1):
            corners = [
                sign * other * function(_moved(at, (row, sign * STEP), (column, other * STEP)))
                for sign in (1, -1)
                for other in (1, -1)
            ]
            result[row, column] = result[column, row] = sum(corners) / (4 * STEP**2)
    return result


def _inverse(information: Vector) -> Vector:
    """Return the inverse of an information matrix; at the end of a line it may have lost its curvature."""
    values, vectors = np.linalg.eigh(information)
    return np.asarray(vectors / np.maximum(values, LEAST) @ vectors.T)


def _robust_variance(
    likelihood: Likelihood, mode: Vector, pieces: Pieces, model_variance: Vector
) -> tuple[Vector, int]:
    """Return the sandwich variance of the mode, and its degrees of freedom: pieces beyond one a stratum."""
    strata = np.unique(pieces.stratum, return_inverse=True)[1]
    sizes = np.bincount(strata)
    free = len(strata) - len(sizes)
    if free < 1:
        return model_variance, UNBOUNDED
    scores = np.empty((len(strata), len(mode)))
    for index in range(len(mode)):
        up, down = (likelihood(_at(mode, index, mode[index] + by)) for by in (STEP, -STEP))
        scores[:, index] = np.bincount(pieces.of_step, (up - down) / (2 * STEP), len(strata))
    for stratum, size in enumerate(sizes):
        within = strata == stratum
        scores[within] -= scores[within].mean(axis=0)
        scores[within] *= np.sqrt(size / max(size - 1, 1))
    return np.asarray(model_variance @ scores.T @ scores @ model_variance), free


def _limit(log_posterior: Callable[[Vector], float], path: _Path, side: int, drop: float) -> float:
    """Return the place of an interval's end, or of the line's where the log-posterior does not fall so far."""
    optimize = load("scipy.optimize", "study")
    sign, end, begin = (1, -1)[side == 0], path.line[side], path.begin
    floor = log_posterior(path.at(begin)) - drop

    def height(place: float) -> float:
        return log_posterior(path.at(place)) - floor

    reach = 0.1
    while reach < abs(end - begin) and height(begin + sign * reach) > 0:
        reach *= 2.0
    far = begin + sign * min(reach, abs(end - begin))
    if (end - begin) * sign <= 0 or height(far) > 0:
        return end
    return float(optimize.brentq(height, begin, far, xtol=1e-3))


def _estimate(
    scale: Scale, index: int, mode: Vector, limits: list[float], likelihood: Likelihood, inflation: float
) -> Estimate:
    """Return an estimate; a limit that only the prior sets gives way to the end of the range."""
    at_mode = likelihood(mode).sum()
    known = [bool(at_mode - likelihood(_at(mode, index, end)).sum() > FALL) for end in scale.line]
    pairs = zip(limits, known, scale.extremes, strict=True)
    ends = [scale.value(limit) if told else extreme for limit, told, extreme in pairs]
    if scale.extremes[0] > scale.extremes[1]:
        ends, known = ends[::-1], known[::-1]
    names: dict[tuple[bool, bool], Known] = {(True, True): "both", (True, False): "low", (False, True): "high"}
    told = names.get((known[0], known[1]), "none")
    return Estimate(scale.name, scale.value(float(mode[index])), ends[0], ends[1], told, inflation, scale.unit)
