"""From readings to one likelihood of every item: readings and views are weighed, and summed.

Pure arithmetic on degrees, so that the fit and the reader share it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fetch_pomdp.core.language.reading.degrees import Array, sigmoid
from fetch_pomdp.core.language.reading.denotation import DEEP, SWAPPED, WIDE, Denotation
from fetch_pomdp.core.language.reading.discourse import Candidate
from fetch_pomdp.core.language.reading.form import Description, Form, Person, Select, Side, inner
from fetch_pomdp.core.language.reading.table import VIEWS
from fetch_pomdp.core.language.reading.weights import Weights

LEAST = 1e-12
MOST_ADDITIONS = 2  # to words, that make a description longer


@dataclass(frozen=True, slots=True, eq=False)
class Understood:
    """What an utterance says of each item, after weighing its readings and views.

    chances: (..., n), the probability of each item, before anything else is known, that sums to 1; readings: (..., r),
    of each reading; views: (..., views), of each view; lost: how likely it was not understood at all.
    """

    chances: Array
    readings: Array
    views: Array
    lost: Array


def view_prior(weights: Weights) -> Array:
    """Return the logarithm of the chance of each view, (..., views), up to a constant."""
    w = weights.values
    log = w.swapped * SWAPPED + w.view_you * WIDE + w.depth_you * DEEP + w.same_view * (WIDE == DEEP)
    log = np.asarray(log, dtype=np.float64)
    return log if log.ndim == 1 else log[..., 0, :]


def understood(
    found: Sequence[Candidate],
    denotation: Denotation,
    weights: Weights,
    *,
    views: Array,
    confusion: tuple[float, float],
    ease: Array,
) -> Understood:
    """Return what readings say of each item. views: (..., views), log prior. confusion: shares of the words that nobody
    knows, and that were left out. ease: (..., n), how easily each item is told apart (`speaker`).
    """
    w, n = weights.values, denotation.table.size
    logs, fits = [], []
    for each in found:
        degree = np.maximum(denotation.of(each.meaning), LEAST) + np.zeros((1, len(VIEWS), n))
        peak = degree.max(axis=-1)
        literal = np.log(degree / degree.sum(axis=-1, keepdims=True))
        logs.append(spoken(literal, each.meaning, ease, weights))
        named = _named(each.meaning, weights)
        prior = np.asarray(views) + named
        fits.append(w_(w.fits) * np.log(peak) + prior - w_(w.cost) * (each.cost + w_(w.nested) * each.nested))
    fit = np.stack(np.broadcast_arrays(*fits), axis=-2)  # (..., r, views)
    log = np.stack(np.broadcast_arrays(*logs), axis=-3)  # (..., r, views, n)
    norm = np.logaddexp.reduce(fit.reshape(*fit.shape[:-2], -1), axis=-1)
    weight = np.exp(fit - norm[..., None, None])
    mixed = (weight[..., None] * np.exp(log)).sum(axis=(-2, -3))
    sharp = np.exp(w_(w.sharpness) * np.log(np.maximum(mixed, LEAST)))
    sharp = sharp / sharp.sum(axis=-1, keepdims=True)
    lost = sigmoid(w_(w.lost) + w_(w.lost_unknown) * confusion[0] + w_(w.lost_skipped) * confusion[1])
    return Understood((1.0 - lost) * sharp + lost / n, weight.sum(axis=-1), weight.sum(axis=-2), lost)


def spoken(literal: Array, meaning: Description, ease: Array, weights: Weights) -> Array:
    """Return how likely each item is for who hears this, (..., n), log: also by what a speaker would have said of it.

    literal: (..., views, n), the logarithm of the chance of each item by what the words mean. ease: (..., n). Who says
    nothing of an item has not left out what tells it apart.
    """
    if not meaning.parts:
        return literal
    w = weights.values
    additions = sum(not isinstance(part, Select) for part in meaning.parts)
    said = w.speaker_sharpness * literal - w.speaker_length * min(additions, MOST_ADDITIONS)
    log = literal + w.speaker * (said - np.logaddexp(said, ease[..., None, :]))
    return log - np.logaddexp.reduce(log, axis=-1, keepdims=True)


def w_(value: Any) -> Any:
    """Return a weight as it broadcasts with arrays of one axis less: (p, 1) in place of (p, 1, 1)."""
    return value[..., 0] if np.ndim(value) else value


def _named(meaning: Description, weights: Weights) -> Array:
    """Return how a view that is named somewhere speaks for the views of the rest, (..., views)."""
    whose = viewers(meaning)
    result: Array = np.zeros(len(VIEWS))
    for person in whose:
        who = SWAPPED ^ int(person is Person.YOU)
        result = result + w_(weights.values.named_view) * ((who == WIDE) + 0.5 * (who == DEEP))
    return result


def viewers(form: Form) -> frozenset[Person]:
    """Return whose sides a meaning names."""
    own = {form.viewer} if isinstance(form, Side) and form.viewer is not None else set[Person]()
    return frozenset(own).union(*map(viewers, inner(form)))
