"""Which items may be "the three bowls that stand together": sets of items, and how well each makes a group."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import comb

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.language.reading.table import Array, Mask

MOST = 250  # sets of a number of items that are looked at one by one
ROWS_APART = 0.45  # distances of neighbours
LINKS = (1.15, 1.45, 1.9)  # distances of neighbours below which items stand together


@dataclass(frozen=True, slots=True, eq=False)
class Groups:
    """Sets of items of a table, g of them, and three lengths of each, in distances of neighbours."""

    members: Array  # (g, n), 0 or 1
    near: Vector  # (g,), the longest distance of a member to its nearest
    spread: Vector  # (g,), mean distance between members, by the square root of their number
    apart: Vector  # (g,), how much farther away the next candidate is, at most 2


def groups(candidates: Mask, number: int | None, distances: Array, along: Vector | None = None) -> Groups:
    """Return the sets of candidates, (n,), that may be a group of a number of items, or of any number.

    along: (n,), where each item is across the rows that a group may be, in distances of neighbours; None for any group.
    """
    chosen = np.flatnonzero(candidates)
    if number is None:
        sets = _clusters(chosen, distances)
        sets += [] if along is None else [row for row in _rows(chosen, along) if row not in sets]
    elif len(chosen) <= number:
        sets = [tuple(chosen.tolist())]
    elif comb(len(chosen), number) <= MOST:
        sets = list(combinations(chosen.tolist(), number))
    else:
        nearest = chosen[np.argsort(distances[np.ix_(chosen, chosen)], axis=1, kind="stable")[:, :number]]
        sets = list(dict.fromkeys(tuple(sorted(row.tolist())) for row in nearest))
    if not sets or not sets[0]:
        return Groups(np.zeros((1, len(candidates))), np.zeros(1), np.zeros(1), np.zeros(1))
    return _measured(sets, candidates, distances)


def _clusters(chosen: Integers, distances: Array) -> list[tuple[int, ...]]:
    found: dict[tuple[int, ...], None] = {}
    among = distances[np.ix_(chosen, chosen)]
    for link in LINKS:
        linked = among <= link
        left = np.ones(len(chosen), dtype=bool)
        while left.any():
            grown = linked[left.argmax()]
            while (more := linked[grown].any(axis=0)).sum() > grown.sum():
                grown = more
            left &= ~grown
            if grown.sum() > 1:
                found[tuple(chosen[grown].tolist())] = None
    return list(found) or [tuple(chosen.tolist())]


def _rows(chosen: Integers, along: Vector) -> list[tuple[int, ...]]:
    """Return the candidates that stand side by side, in rows as far apart as ROWS_APART."""
    order = chosen[np.argsort(along[chosen], kind="stable")]
    cuts = np.flatnonzero(np.diff(along[order]) > ROWS_APART) + 1
    return [tuple(sorted(row.tolist())) for row in np.split(order, cuts) if len(row) > 1]


def _measured(sets: list[tuple[int, ...]], candidates: Mask, distances: Array) -> Groups:
    members = np.zeros((len(sets), len(candidates)))
    near, spread, apart = np.zeros((3, len(sets)))
    sizes = np.array(list(map(len, sets)))
    for size in np.unique(sizes):
        here = np.flatnonzero(sizes == size)
        inside = np.array([sets[index] for index in here])  # (sets of the size, size)
        members[here[:, None], inside] = 1.0
        if size > 1:
            within = distances[inside[:, :, None], inside[:, None, :]]
            near[here] = _longest_links(within)
            spread[here] = within.sum(axis=(1, 2)) / (size * (size - 1)) / np.sqrt(size)
        others = candidates & (members[here] == 0.0)
        gap = np.where(others, distances[inside].min(axis=1), np.inf).min(axis=1)
        apart[here] = np.minimum(np.maximum(gap - near[here], 0.0), 2.0)
    return Groups(members, near, spread, apart)


def _longest_links(distances: Array) -> Vector:
    """Return the longest edge of the shortest tree that joins all of each set (Prim's), (sets,), of (sets, n, n)."""
    every, size = np.arange(len(distances)), distances.shape[1]
    reach = distances[:, 0].copy()
    reach[:, 0] = np.inf
    joined = np.zeros(reach.shape, dtype=bool)
    joined[:, 0] = True
    longest = np.zeros(len(distances))
    for _ in range(size - 1):
        item = reach.argmin(axis=1)
        longest = np.maximum(longest, reach[every, item])
        joined[every, item] = True
        reach = np.where(joined, np.inf, np.minimum(reach, distances[every, item]))
    return longest
