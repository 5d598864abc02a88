"""Answer models p(answer | desired item, question): matrices of answers by items whose columns sum to 1."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import product

import numpy as np

from fetch_pomdp.core.compiled import Vector


def yes_no(holds: Vector, truth: float) -> Vector:
    """Return the chances of yes and no, (2, n_items).

    holds: (n_items,), how far each item is what is asked about, from 0 to 1. truth: chance of the true answer (Table
    I). An item that half is what is asked about is affirmed every second time.
    """
    yes = truth * holds + (1.0 - truth) * (1.0 - holds)
    return np.stack([yes, 1.0 - yes])


def taken_for(distances: Vector, misunderstood: float, reach: float) -> Vector:
    """Return the chance that who is shown an item takes another to be meant, (n_items, n_items): shown, taken for it.

    The paper's footnote 1: a person may not understand the robot's question. distances: (n_items, n_items), in
    distances of neighbours. misunderstood: chance that another item than the one shown is understood. reach: distance
    at which an item is taken less often by a factor of e.
    """
    weights = np.exp(-distances / reach)
    np.fill_diagonal(weights, 0.0)
    sums = weights.sum(axis=1, keepdims=True)
    missed = np.where(sums > 0.0, misunderstood, 0.0)  # where there is but one item nobody mistakes it
    others = missed * weights / np.where(sums > 0.0, sums, 1.0)
    np.fill_diagonal(others, 1.0 - missed[:, 0])
    return others


def understood(members: Collection[int], taken: Vector) -> Vector:
    """Return how far each item is among those that a person understands to be meant, (n_items,).

    members: items shown. taken: as `taken_for` gives it. Each item is taken for another by itself, so that an item is
    meant if any of those shown is understood as it.
    """
    return np.asarray(1.0 - np.prod(1.0 - taken[list(members)], axis=0))


def described(groups: Sequence[Sequence[int]], n_items: int, names: float, slips: float) -> tuple[Vector, list[int]]:
    """Return the chances of descriptions, (n_answers, n_items), and which groups each names, as bits.

    groups: items of each attribute. names: chance that a person names an attribute that their item has. slips: chance
    that they describe another item in its place, any alike.

    Choice: attributes are named independently of each other; what is named is true of the item described.
    """
    owned = np.zeros((len(groups), n_items), dtype=bool)
    for group, members in enumerate(groups):
        owned[group, list(members)] = True
    found: dict[int, Vector] = {}
    for item in range(n_items):
        own = np.flatnonzero(owned[:, item])
        for named in product((False, True), repeat=len(own)):
            key = sum(1 << int(group) for group, said in zip(own, named, strict=True) if said)
            row = found.setdefault(key, np.zeros(n_items))
            row[item] += names ** sum(named) * (1.0 - names) ** (len(own) - sum(named))
    keys = sorted(found)
    true = np.stack([found[key] for key in keys])
    return (1.0 - slips) * true + slips * true.mean(axis=1, keepdims=True), keys
