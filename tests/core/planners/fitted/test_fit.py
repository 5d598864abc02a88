"""Least squares with a narrow band, against NumPy's dense solver."""

from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.core.planners.fitted.fit import WIDTH, add_outer, add_row, factor, smoothness, solve


def dense(band: np.ndarray) -> np.ndarray:
    size, width = band.shape
    full = np.zeros((size, size))
    for row in range(size):
        for k in range(width):
            column = row - width + 1 + k
            if column >= 0:
                full[row, column] = full[column, row] = band[row, k]
    return full


@pytest.mark.parametrize(("size", "width"), [(1, 1), (5, 2), (9, 4), (12, 12), (3, 7)])
def test_solves_what_numpy_solves(size: int, width: int) -> None:
    rng = np.random.default_rng(size)
    band = rng.normal(size=(size, width))
    band[:, -1] = 3.0 * width
    right = rng.normal(size=size)
    expected = np.linalg.solve(dense(band), right)
    factor(band)
    solve(band, right)
    assert right == pytest.approx(expected, abs=1e-12)


def test_a_plane_has_no_second_differences_and_a_bump_has() -> None:
    penalty = dense(smoothness()) - 1e-3 * np.eye(33 * 9)  # without the anchor
    rows, columns = np.meshgrid(np.arange(33.0), np.arange(9.0), indexing="ij")
    plane = (3.0 + 2.0 * rows - columns).ravel()
    assert plane @ penalty @ plane == pytest.approx(0.0, abs=1e-6)
    bump = np.zeros(33 * 9)
    bump[16 * 9 + 4] = 1.0
    assert bump @ penalty @ bump == pytest.approx(0.2 * 2 * (4 + 1 + 1))  # both directions: 1, -2, 1


def test_rows_are_outer_products_of_bilinear_weights() -> None:
    band, expected = np.zeros((33 * 9, WIDTH)), np.zeros(33 * 9)
    add_row(band, 4, 2, 0.25, 0.5)
    expected[[4 * 9 + 2, 4 * 9 + 3, 5 * 9 + 2, 5 * 9 + 3]] = [0.375, 0.375, 0.125, 0.125]
    assert dense(band) == pytest.approx(np.outer(expected, expected))
    other = np.zeros((33 * 9, WIDTH))
    add_outer(other, (40, 49, 58), (1.0, -2.0, 1.0), 0.5)
    assert dense(other)[49, 49] == 2.0
    assert dense(other)[40, 58] == 0.5
