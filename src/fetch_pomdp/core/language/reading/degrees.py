"""Soft degrees: from places to how far "closest", "second from the left", "next to" or "between" hold, from 0 to 1.

Pure functions of arrays whose last axis is the items. Weights may be numbers or carry an axis of variants in front.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector

Array = Any  # of floats, with any axes in front


def sigmoid(x: Array) -> Array:
    """Return the logistic function."""
    half = np.tanh(0.5 * x)
    return 0.5 * half + 0.5


def precedes(values: Array, blur: Array) -> Array:
    """Return how far each other item's value is the smaller one, softly (..., n, n): of an item, and another.

    Its transpose is that of the values' negatives.
    """
    return sigmoid((values[..., :, None] - values[..., None, :]) / np.expand_dims(np.asarray(blur), -1))


def before(order: Array, candidates: Array) -> Array:
    """Return how many candidates come before each item, softly (..., n).

    order: (..., n, n), as `precedes` gives it. candidates: (..., n), how far each item counts as one.
    """
    return np.matmul(order, candidates[..., None])[..., 0] - 0.5 * candidates


def ranked(order: Array, candidates: Array, rank: int, fall: Array) -> Array:
    """Return how far each item is number `rank` of the candidates in an order (..., n); -1 is the last."""
    if rank < 0:
        order, rank = np.swapaxes(order, -1, -2), -rank
    return np.exp(-fall * np.abs(before(order, candidates) - (rank - 1)))


def share(candidates: Array) -> Array:
    """Return degrees scaled so that the best item's is 1."""
    return candidates / np.maximum(candidates.max(axis=-1, keepdims=True), 1e-30)


def related(landmarks: Array, holds: Array) -> Array:
    """Return how far a relation holds of each item and some landmark (..., n): it does with one or another.

    landmarks: (..., n), how far each item is one. holds: (..., n, n), of an item and a landmark.
    """
    return 1.0 - np.prod(1.0 - np.minimum(holds * landmarks[..., None, :], 0.999), axis=-1)


def middle(points: Vector, members: Array) -> Array:
    """Return the distance of each item to the middle of the members (..., n), in the unit of points, (n, 2)."""
    total = np.maximum(members.sum(axis=-1, keepdims=True), 1e-12)
    centre = (members[..., None] * points).sum(axis=-2) / total
    return np.sqrt(((points - centre[..., None, :]) ** 2).sum(axis=-1))


def toward(offsets: Array, near: Array, axis: Array, turn: Array, reach: Array) -> Array:
    """Return how far each item is in a direction from each landmark (..., n, n), from 0 to 1.

    offsets: (n, n, 2), from landmark to item. near: (n, n), their distances. axis: (..., n or 1, 2), unit
    direction, of each landmark or of all.
    """
    lengths = np.sqrt((offsets**2).sum(axis=-1))
    along = (offsets * axis[..., None, :, :]).sum(axis=-1) / np.maximum(lengths, 1e-9)
    turn, reach = np.expand_dims(np.asarray(turn), -1), np.expand_dims(np.asarray(reach), -1)
    degree = np.exp(turn * (along - 1.0) - np.maximum(near - 1.0, 0.0) / (2.0 * reach))
    return degree * (1.0 - np.eye(near.shape[0]))


def beside(near: Array, reach: Array) -> Array:
    """Return how far each item is next to each landmark (..., n, n), from 0 to 1. near: (n, n), their distances."""
    reach = np.expand_dims(np.asarray(reach), -1)
    return np.exp(-np.maximum(near - 0.8, 0.0) / reach) * (1.0 - np.eye(near.shape[0]))


def between(distances: Array, some: Integers, others: Integers, shape: tuple[Array, Array, Array]) -> Array:
    """Return how far each item is between each two landmarks (..., n, some, others), from 0 to 1.

    distances: (n, n). some, others: indices of the landmarks. shape: the detour that still is between, how far apart
    the two may be, and how much unevenness counts.
    """
    wide, reach, even = (np.expand_dims(np.asarray(each), (-1, -2)) for each in shape)
    one, other = distances[:, some, None], distances[:, None, others]
    both = distances[np.ix_(some, others)]
    detour, uneven = one + other - both, np.abs(one - other) / np.maximum(both, 1e-9)
    degree = np.exp(-detour / wide - np.maximum(both - 2.0, 0.0) / (4.0 * reach) - uneven * even)
    return degree * ((one > 0.0) & (other > 0.0) & (both > 0.0))
