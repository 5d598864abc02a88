"""The two layouts of Section IV-A, as plain data in the form of a scene file.

Choice: the paper gives the distances between items and to the person, but no coordinates, head or table height; ours
are a head at 1.6 m over the origin and a table at 0.75 m, so that 1.22 m and 3.2 m are distances along the floor.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

HEAD = (0.0, 0.0, 1.6)  # m
TABLE_HEIGHT = 0.75  # m
KINDS = {
    "bowl": ("bowl", "black", "plastic", "container"),
    "marker": ("marker", "green", "expo", "pen"),
    "spoon": ("spoon", "silver", "metal", "utensil"),
}


def _layout(kinds: list[str], places: list[tuple[float, float]]) -> dict[str, Any]:
    numbered = [f"{kind}-{kinds[: index + 1].count(kind)}" for index, kind in enumerate(kinds)]
    items = [
        {"id": name, "position": (x, y, TABLE_HEIGHT), "vocabulary": KINDS[kind]}
        for name, kind, (x, y) in zip(numbered, kinds, places, strict=True)
    ]
    return {"head": HEAD, "items": items}


def _arc(index: int) -> tuple[float, float]:
    angle = (index - 2.5) * 0.45 / 1.22
    return 1.22 * math.sin(angle), 1.22 * math.cos(angle)


LAYOUTS: Mapping[str, Mapping[str, Any]] = {
    "ambiguous": _layout(
        ["bowl", "bowl", "marker", "marker", "spoon", "spoon"],
        [(x, 3.2) for x in (-0.375, -0.225, -0.075, 0.075, 0.225, 0.375)],
    ),
    "unambiguous": _layout(
        ["bowl", "marker", "spoon", "bowl", "marker", "spoon"],
        [_arc(index) for index in range(6)],
    ),
}
