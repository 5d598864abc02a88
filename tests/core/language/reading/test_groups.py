"""Sets of items that may be a group."""

from __future__ import annotations

import numpy as np
import pytest

from fetch_pomdp.core.language.reading.groups import groups

PLACES = np.array([0.0, 1.0, 2.0, 10.0, 11.0])
DISTANCES = np.abs(PLACES[:, None] - PLACES[None])
EVERY = np.ones(5, dtype=bool)


def sets(number: int | None, candidates: np.ndarray = EVERY) -> list[list[int]]:
    return [np.flatnonzero(row).tolist() for row in groups(candidates, number, DISTANCES).members]


def test_a_number_of_items_may_be_any_of_them() -> None:
    assert len(sets(2)) == 10
    assert sets(5) == [[0, 1, 2, 3, 4]]
    assert sets(9) == [[0, 1, 2, 3, 4]]


def test_items_together_are_those_within_reach() -> None:
    assert sorted(sets(None)) == [[0, 1, 2], [3, 4]]


def test_the_lengths_of_a_group() -> None:
    found = groups(EVERY, 3, DISTANCES)
    index = [np.flatnonzero(row).tolist() for row in found.members].index([0, 1, 2])
    assert found.near[index] == 1.0
    assert found.spread[index] == pytest.approx((1 + 1 + 2) / 3 / np.sqrt(3))
    assert found.apart[index] == 2.0
    assert found.near.argmin() == index


def test_no_candidates_make_an_empty_group() -> None:
    assert groups(np.zeros(5, dtype=bool), 2, DISTANCES).members.sum() == 0
