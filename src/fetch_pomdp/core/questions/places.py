"""Parts of a table that a robot may ask about: halves and thirds, as the person sees them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from fetch_pomdp.core.compiled import Vector
from fetch_pomdp.core.language.reading import degrees
from fetch_pomdp.core.language.reading.table import SPEAKER, Table

BLUR = 0.1  # of the border between parts, in spreads of the items
NARROWEST = 0.1  # m, of a table that has parts in a direction


class Region(NamedTuple):
    """A part of a table: how it is said, and how far each item is in it, (n_items,), from 0 to 1."""

    said: str
    holds: Vector


def regions(table: Table) -> Iterator[Region]:
    """Yield a half and the thirds from left to right, and from near to far, where the items lie apart that way.

    The other half is what is denied.

    Choice: parts divide the places evenly from the first to the last, for that is what people see, not their items'
    numbers. Sides are the person's own, and the question says so.

    Choice: whether an item is beyond a border is answered as `reading.degrees` has it, softly, with a border narrower
    than that of unasked words: people who are asked look where the middle is.
    """
    ways = (
        (table.right[SPEAKER], ("on your left?", "in the third to your left?", "in the middle third, left to right?",
                                "in the third to your right?")),
        (table.away[SPEAKER], ("in the half near you?", "in the third nearest to you?",
                               "in the middle third, near to far?", "in the third farthest from you?")),
    )  # fmt: skip
    for along, (half, *thirds) in ways:
        low, high = float(along.min()), float(along.max())
        if (high - low) * table.spread < NARROWEST:
            continue
        yield Region(half, before(along, (low + high) / 2.0))
        first, second = low + (high - low) / 3.0, low + (high - low) * 2.0 / 3.0
        for said, holds in zip(
            thirds,
            (before(along, first), before(along, second) - before(along, first), 1.0 - before(along, second)),
            strict=True,
        ):
            yield Region(said, holds)


def before(along: Vector, border: float) -> Vector:
    """Return how far each place is before a border, from 0 to 1; places in spreads of the items."""
    return np.asarray(degrees.sigmoid((border - along) / BLUR))
