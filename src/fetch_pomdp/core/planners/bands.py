"""Least squares with a narrow band: Cholesky's factor and its solution, without a dependency on SciPy.

A symmetric matrix is kept as (size, width): `band[row, k]` is the entry at (row, row - width + 1 + k), the diagonal
last.
"""

from __future__ import annotations

import math

from fetch_pomdp.core.compiled import Vector, compiled


@compiled
def factor(band: Vector) -> None:
    """Replace a positive definite matrix by its lower Cholesky factor, in place."""
    size, width = band.shape
    for row in range(size):
        for k in range(width):
            column = row - width + 1 + k
            if column < 0:
                continue
            total = band[row, k]
            for inner in range(max(0, row - width + 1, column - width + 1), column):
                total -= band[row, inner - row + width - 1] * band[column, inner - column + width - 1]
            band[row, k] = math.sqrt(total) if column == row else total / band[column, width - 1]


@compiled
def solve(lower: Vector, right: Vector) -> None:
    """Replace the right-hand side, (size,), by the solution, in place; lower: what `factor` left."""
    size, width = lower.shape
    for row in range(size):
        for column in range(max(0, row - width + 1), row):
            right[row] -= lower[row, column - row + width - 1] * right[column]
        right[row] /= lower[row, width - 1]
    for row in range(size - 1, -1, -1):
        right[row] /= lower[row, width - 1]
        for column in range(max(0, row - width + 1), row):
            right[column] -= lower[row, column - row + width - 1] * right[row]
