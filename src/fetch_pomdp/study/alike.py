"""Scenes of many alike items."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from fetch_pomdp.checks import shown
from fetch_pomdp.core.layouts import HEAD, TABLE_HEIGHT
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.errors import StudyError

MOST = 2_000
GAP = 0.45  # m, between neighbours on an arc, and between arcs
NEAREST = 1.22  # m, along the floor, from the person to the first arc
HALF = 2.5 * GAP / NEAREST  # rad, to either side of straight ahead: where the six items of the paper's arc end
WORDS = ("cup", "blue", "plastic")


def alike(count: int) -> Scene:
    """Return a scene of `count` items with the same words, so that pointing and answers alone tell them apart.

    They stand on arcs around the person, 0.45 m apart along an arc and from arc to arc, the first at 1.22 m; an arc is
    filled before the next begins, from its middle outwards. Raises StudyError for a count that is not from 2 to 2000.

    Choice: six of them have the places of the paper's unambiguous layout, so that the number of items alone tells the
    scenes of this family from that table; more stand farther away, as they must.
    """
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MOST:
        raise StudyError(f"found {shown(count)}, expected a whole number from 2 to {MOST}", field="items")
    items = tuple(
        Item(id=f"cup-{number}", position=(x, y, TABLE_HEIGHT), vocabulary=WORDS)
        for number, (x, y) in enumerate(itertools.islice(_places(count), count), start=1)
    )
    return Scene(items=items, head=HEAD)


def _places(count: int) -> Iterator[tuple[float, float]]:
    """Yield places (m) on the floor plan, arc by arc, each arc from left to right."""
    left = count
    for arc in itertools.count():
        radius = NEAREST + GAP * arc
        here = min(left, 1 + math.floor(2 * HALF * radius / GAP + 1e-9))
        for index in range(here):
            angle = (index - (here - 1) / 2) * GAP / radius
            yield radius * math.sin(angle), radius * math.cos(angle)
        left -= here
