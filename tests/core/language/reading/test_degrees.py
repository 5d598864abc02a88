"""Soft degrees against values worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fetch_pomdp.core.language.reading import degrees

VALUES = np.array([3.0, 1.0, 2.0])
EVERY = np.ones(3)


def test_order_counts_who_comes_before() -> None:
    order = degrees.precedes(VALUES, 1e-3)
    assert degrees.before(order, EVERY) == pytest.approx([2.0, 0.0, 1.0])
    assert degrees.before(order, np.array([1.0, 0.0, 1.0])) == pytest.approx([1.0, 0.0, 0.0])


def test_a_blurred_order_shares_who_comes_first() -> None:
    order = degrees.precedes(np.array([1.0, 1.0]), 0.5)
    assert degrees.before(order, np.ones(2)) == pytest.approx([0.5, 0.5])


def test_ranks_fall_from_the_one_that_is_meant() -> None:
    order = degrees.precedes(VALUES, 1e-3)
    assert degrees.ranked(order, EVERY, 2, 1.0) == pytest.approx([math.exp(-1), math.exp(-1), 1.0])
    assert degrees.ranked(order, EVERY, -1, 1.0) == pytest.approx([1.0, math.exp(-2), math.exp(-1)])


def test_variants_go_through_together() -> None:
    falls = np.array([0.5, 2.0])[:, None, None]
    order = degrees.precedes(VALUES[None, None], np.full((2, 1, 1), 1e-3))
    found = degrees.ranked(order, np.ones((1, 1, 3)), 1, falls)
    assert found.shape == (2, 1, 3)
    for variant, fall in enumerate((0.5, 2.0)):
        alone = degrees.ranked(degrees.precedes(VALUES, 1e-3), EVERY, 1, fall)
        assert found[variant, 0] == pytest.approx(alone)


def test_related_holds_with_one_landmark_or_another() -> None:
    holds = np.array([[0.0, 0.5, 0.5], [0.5, 0.0, 0.0], [0.5, 0.0, 0.0]])
    assert degrees.related(np.array([0.0, 1.0, 1.0]), holds) == pytest.approx([0.75, 0.0, 0.0])


def test_middle_is_the_distance_to_the_members_mean() -> None:
    points = np.array([[0.0, 0.0], [2.0, 0.0], [5.0, 0.0]])
    assert degrees.middle(points, np.array([1.0, 1.0, 0.0])) == pytest.approx([1.0, 1.0, 4.0])


def test_toward_is_surest_straight_ahead_and_nothing_at_itself() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])
    offsets = points[:, None] - points[None]
    distances = np.linalg.norm(offsets, axis=2)
    found = degrees.toward(offsets, distances, np.array([[1.0, 0.0]]), 2.0, 1.0)[:, 0]
    assert found == pytest.approx([0.0, 1.0, math.exp(-4), math.exp(-2)])


def test_between_is_surest_on_the_line_and_nothing_at_its_ends() -> None:
    points = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    found = degrees.between(distances, np.array([0]), np.array([1]), (1.0, 1.0, 1.0))[:, 0, 0]
    assert found == pytest.approx([0.0, 0.0, 1.0, math.exp(2.0 - 2.0 * math.sqrt(2.0))])
