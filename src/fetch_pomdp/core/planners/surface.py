"""Least squares on a table that is bilinear between its entries, with small second differences.

Bands are those of `planners.bands`; an entry's place is row * COLUMNS + column.
"""

from __future__ import annotations

import numpy as np

from fetch_pomdp.core.compiled import Vector, inlined, lean
from fetch_pomdp.core.planners.afterstate import COLUMNS, ROWS

SMOOTHNESS = 0.2  # weight of a squared second difference, as of so many backups
ANCHOR = 1e-3  # weight of the table before, so that a cell never met stays
WIDTH = 2 * COLUMNS + 1  # of the band: second differences reach two rows


def smoothness() -> Vector:
    """Return the penalty on second differences of a table's entries, as a band (see `planners.bands`)."""
    band = np.zeros((ROWS * COLUMNS, WIDTH))
    for row in range(ROWS):
        for column in range(COLUMNS):
            here = row * COLUMNS + column
            for inside, apart in ((0 < row < ROWS - 1, COLUMNS), (0 < column < COLUMNS - 1, 1)):
                if inside:
                    add_outer(band, (here - apart, here, here + apart), (1.0, -2.0, 1.0), SMOOTHNESS)
    band[:, -1] += ANCHOR
    return band


def add_outer(band: Vector, places: tuple[int, int, int], weights: tuple[float, float, float], scale: float) -> None:
    """Add the outer product of a sparse vector with itself to a band."""
    for row, one in zip(places, weights, strict=True):
        for column, other in zip(places, weights, strict=True):
            if column <= row:
                band[row, column - row + WIDTH - 1] += scale * one * other


@lean
def add_row(band: Vector, row: int, column: int, down: float, along: float) -> None:
    """Add the outer product of the weights of a cell's four corners."""
    for one in range(4):
        here = (row + one // 2) * COLUMNS + column + one % 2
        weight = corner(one, down, along)
        for other in range(one + 1):
            there = (row + other // 2) * COLUMNS + column + other % 2
            band[here, there - here + WIDTH - 1] += weight * corner(other, down, along)


@inlined
def corner(number: int, down: float, along: float) -> float:
    """Return the bilinear weight of one of a cell's corners."""
    return (down if number // 2 else 1.0 - down) * (along if number % 2 else 1.0 - along)
