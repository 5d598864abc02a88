"""Which items may be "the three bowls that stand together": sets of items, and how well each makes a group."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import comb

import numpy as np

from fetch_pomdp.core.compiled import Integers, Vector
from fetch_pomdp.core.language.reading.table import Array, Mask

MOST = 250  # sets of a number of items that are looked at one by one
LINKS = (1.15, 1.45, 1.9)  # distances of neighbours below which items stand together


@dataclass(frozen=True, slots=True, eq=False)
class Groups:
    """Sets of items of a table, g of them, and three lengths of each, in distances of neighbours."""

    members: Array  # (g, n), 0 or 1
    near: Vector  # (g,), the longest distance of a member to its nearest
    spread: Vector  # (g,), mean distance between members, by the square root of their number
    apart: Vector  # (g,), how much farther away the next candidate is, at most 2


def groups(candidates: Mask, number: int | None, distances: Array) -> Groups:
    """Return the sets of candidates, (n,), that may be a group of a number of items, or of any number."""
    chosen = np.flatnonzero(candidates)
    if number is None:
        sets = _clusters(chosen, distances)
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
    for link in LINKS:
        left = set(chosen.tolist())
        while left:
            grown, agenda = set[int](), [left.pop()]
            while agenda:
                item = agenda.pop()
                grown.add(item)
                near = {other for other in left if distances[item, other] <= link}
                left -= near
                agenda += near
            if len(grown) > 1:
                found[tuple(sorted(grown))] = None
    return list(found) or [tuple(chosen.tolist())]


def _measured(sets: list[tuple[int, ...]], candidates: Mask, distances: Array) -> Groups:
    members = np.zeros((len(sets), len(candidates)))
    near, spread, apart = np.zeros((3, len(sets)))
    for index, each in enumerate(sets):
        inside = np.array(each)
        members[index, inside] = 1.0
        within = distances[np.ix_(inside, inside)]
        if len(inside) > 1:
            near[index] = _longest_link(within)
            spread[index] = within.sum() / (len(inside) * (len(inside) - 1)) / np.sqrt(len(inside))
        rest = candidates.copy()
        rest[inside] = False
        gap = distances[np.ix_(inside, np.flatnonzero(rest))].min() if rest.any() else np.inf
        apart[index] = min(max(gap - near[index], 0.0), 2.0)
    return Groups(members, near, spread, apart)


def _longest_link(distances: Array) -> float:
    """Return the longest edge of the shortest tree that joins all (Prim's)."""
    size = len(distances)
    reach, joined = distances[0].copy(), np.zeros(size, dtype=bool)
    joined[0] = True
    longest = 0.0
    for _ in range(size - 1):
        reach[joined] = np.inf
        item = int(reach.argmin())
        longest = max(longest, float(reach[item]))
        joined[item] = True
        reach = np.minimum(reach, distances[item])
    return longest
