"""How alike items are, against sums over words written out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fetch_pomdp.core.planners.pairs import class_breaks, closeness, pair_class
from tests.oracles.model import word_chance
from tests.tables import table, world_of


@pytest.mark.parametrize(("one", "other"), [(0, 1), (0, 2), (1, 2), (2, 3), (0, 3), (1, 1)])
def test_words_are_those_of_equation_5(one: int, other: int) -> None:
    problem = table([["cup", "red"], ["red", "cup"], ["cup", "blue", "small"], ["pot"]], p_g=0.0, alpha=0.3, p_l=0.8)
    world = world_of(problem)
    words = sum(math.sqrt(word_chance(w, one, world) * word_chance(w, other, world)) for w in world.words)
    assert closeness(one, other, problem.tables) == pytest.approx(0.2 + 0.8 * words, abs=1e-12)


def test_pointing_tells_items_apart_by_their_angle() -> None:
    near = table([["cup"], ["cup"]], [(0.0, 2.0, 1.6), (0.01, 2.0, 1.6)], p_g=0.5, sigma=0.1)
    far = table([["cup"], ["cup"]], [(0.0, 2.0, 1.6), (2.0, 0.0, 1.6)], p_g=0.5, sigma=0.1)
    assert closeness(0, 1, near.tables) == pytest.approx(1.0, abs=1e-3)
    assert closeness(0, 1, far.tables) == pytest.approx(0.5, abs=1e-9)  # a ray would settle it
    # A small angle t: the overlap of two normal densities in the plane is exp(-t^2 / 8 sigma^2).
    some = table([["cup"], ["cup"]], [(0.0, 2.0, 1.6), (0.2, 2.0, 1.6)], p_g=0.5, sigma=0.1)
    assert closeness(0, 1, some.tables) == pytest.approx(0.5 + 0.5 * math.exp(-(0.1**2) / 0.08), abs=2e-3)


def test_classes_lie_between_the_kinds_seen() -> None:
    seen = np.array([0.999] * 50 + [0.9] * 50 + [0.2] * 50)
    breaks = class_breaks(seen)
    assert len(breaks) == 2
    assert 0.2 < breaks[0] < 0.9 < breaks[1] < 0.999
    assert len(class_breaks(np.full(9, 0.7))) == 0
    assert len(class_breaks(np.empty(0))) == 0
    assert len(class_breaks(np.array([0.9] * 99 + [0.1]))) == 0  # one in a hundred is too few for a class


def test_class_of_a_pair() -> None:
    problem = table([["cup"], ["cup"], ["pot"]], p_g=0.0)
    breaks = np.array([0.9])
    assert pair_class(0, 1, breaks, problem.tables) == 1
    assert pair_class(0, 2, breaks, problem.tables) == 0
    assert pair_class(0, 1, np.empty(0), problem.tables) == 0
