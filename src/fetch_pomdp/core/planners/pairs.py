"""How alike two items are to what is heard and seen: what a wait can tell about the leading pair.

Two twins and two different items may have the same beliefs, and yet a wait is worth nothing between the first and much
between the second. So a fitted value keeps a table for each class of pairs.
"""

from __future__ import annotations

import math

import numpy as np

from fetch_pomdp.core.compiled import Vector, inlined
from fetch_pomdp.core.problem import Tables

MOST_CLASSES = 3
_LLOYD_ROUNDS = 20
_RAREST = 0.03  # share of the pairs seen: a class of fewer has too little to be fitted on


@inlined
def closeness(one: int, other: int, tables: Tables) -> float:
    """Return the Bhattacharyya coefficient of a step's base words and pointing under two items; 1 for twins in a place.

    Words by Eq. 4 and 5. Pointing as if on a plane: rays spread by sigma around two directions.
    """
    shared = 0
    starts, words = tables.item_starts, tables.item_words
    for left in range(starts[one], starts[one + 1]):
        for right in range(starts[other], starts[other + 1]):
            if words[left] == words[right]:
                shared += 1
    own = starts[one + 1] - starts[one] + starts[other + 1] - starts[other] - 2 * shared
    alpha, rest = tables.alpha, len(tables.word_starts) - 1 - own - shared
    mass = shared * (1.0 + alpha) + own * math.sqrt(alpha * (1.0 + alpha)) + rest * alpha
    word = mass * math.sqrt(tables.smoothing[one] * tables.smoothing[other])
    a, b = tables.directions[one], tables.directions[other]
    ray = math.exp((a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - 1.0) / (4.0 * tables.sigma * tables.sigma))
    return float((1.0 - tables.p_l + tables.p_l * word) * (1.0 - tables.p_g + tables.p_g * ray))


@inlined
def pair_class(one: int, other: int, breaks: Vector, tables: Tables) -> int:
    """Return the class of a pair: how many of the rising `breaks` its closeness is above."""
    if len(breaks) == 0:
        return 0
    found, close = 0, closeness(one, other, tables)
    for limit in breaks:
        if close > limit:
            found += 1
    return found


def class_breaks(seen: Vector) -> Vector:
    """Return the breaks between up to MOST_CLASSES classes of the closenesses seen, (n,), by one-dimensional k-means.

    Classes are compact in the logarithm of what a step tells, log(1 / closeness - 1): what counts is how many waits it
    takes to tell a pair apart.
    """
    if not len(seen):
        return np.empty(0)
    told = np.log(1.0 / np.minimum(seen, 1.0 - 1e-4) - 1.0 + 1e-3)
    if np.ptp(told) < 0.1:
        return np.empty(0)
    centres = np.linspace(told.min(), told.max(), MOST_CLASSES)
    nearest = np.abs(told[:, None] - centres).argmin(axis=1)
    for _ in range(_LLOYD_ROUNDS):
        members = [told[nearest == index] for index in range(MOST_CLASSES)]
        centres = np.array([own.mean() if len(own) else old for own, old in zip(members, centres, strict=True)])
        nearest = np.abs(told[:, None] - centres).argmin(axis=1)
    shares = np.bincount(nearest, minlength=MOST_CLASSES) / len(told)
    kept = np.sort(centres[shares >= _RAREST])
    return np.sort(1.0 / (np.exp((kept[1:] + kept[:-1]) / 2.0) - 1e-3 + 1.0))
