"""What was said, where the recogniser is not sure: several readings with probabilities, and what they say together.

A recogniser hears "one" for "no" in noise, and knows that it may have. Its probability p_k of a reading w_k is a
posterior, of its own prior q(w_k) and of the sound; so the sound s has the likelihood

    p(s | i_d, i_r) ~ sum_k p_k / q(w_k) p(w_k | i_d, i_r).

Choice: the recogniser is taken to expect any item alike, and yes as much as no: q is the model's own chance of the
words for an item drawn uniformly, times that of the answers where the item asked about is as likely the desired one as
not. So a reading's weight stays what the recogniser gave it, whatever its number of words. A single reading has no
weight, and is read by Eq. 3 as it stands.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fetch_pomdp.checks import shown
from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.errors import ObservationError


@dataclass(frozen=True, slots=True)
class Alternative:
    """A way in which what was said may be read, lower case; none is no word to the robot.

    weight: the recogniser's probability of it. Raises ObservationError for one that is not above 0, or above 1.
    """

    words: tuple[str, ...]
    weight: float

    def __post_init__(self) -> None:
        if not 0 < self.weight <= 1:
            found = f"found {shown(self.weight)}"
            raise ObservationError(f"{found}, expected a probability above 0", field="weight")


def together(
    weights: Sequence[float], words: Sequence[Vector], answers: Sequence[Vector], asked: int | None
) -> tuple[Vector, Vector]:
    """Return the log-likelihoods of readings taken together, of their words and of their answers; each (n_items,).

    weights: p_k; words, answers: log p(l_b | i_d) and log p(l_r | i_d, i_r) of each reading, (n_items,). What answers
    add to the words is theirs: the two sum to the logarithm above. asked: index of i_r, or None.
    """
    count = len(words[0])
    uniform = np.full(count, 1.0 / count)
    even = uniform
    if asked is not None and count > 1:
        even = np.full(count, 0.5 / (count - 1))
        even[asked] = 0.5
    of_words, of_both = [], []
    for weight, base, response in zip(weights, words, answers, strict=True):
        of_words.append(math.log(weight) + base - _log_mean(base, uniform))
        of_both.append(of_words[-1] + response - _log_mean(response, even))
    alone, both = _log_sum(np.array(of_words)), _log_sum(np.array(of_both))
    return alone, both - np.where(np.isfinite(alone), alone, 0.0)


def _log_mean(logs: Vector, weights: Vector) -> float:
    """Return the logarithm of a mean; 0 where nothing is possible, so that it stays impossible."""
    largest = float(logs.max())
    return largest + math.log(float(weights @ np.exp(logs - largest))) if largest > -math.inf else 0.0


def _log_sum(logs: Vector) -> Vector:
    """Return the logarithm of the sum over the first axis."""
    largest = np.where(np.isfinite(logs.max(axis=0)), logs.max(axis=0), 0.0)
    with np.errstate(divide="ignore"):
        return np.asarray(largest + np.log(np.exp(logs - largest).sum(axis=0)))
