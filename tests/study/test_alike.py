"""Scenes of alike items."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import StudyError
from fetch_pomdp.study.alike import alike


def test_six_have_the_places_of_the_unambiguous_layout() -> None:
    ours = np.array([item.position for item in alike(6).items])
    paper = np.array([item.position for item in Scene.load("unambiguous").items])
    assert ours == pytest.approx(paper, abs=1e-12)
    assert alike(6).head == Scene.load("unambiguous").head


@settings(max_examples=20, deadline=None)
@given(count=st.integers(2, 120))
def test_items_have_the_same_words_and_room(count: int) -> None:
    scene = alike(count)
    assert len(scene.items) == count
    assert len({item.vocabulary for item in scene.items}) == 1
    gaps = [math.dist(a.position, b.position) for a, b in itertools.combinations(scene.items, 2)]
    assert min(gaps) > 0.44  # the chord of an arc of 0.45 m at 1.22 m
    assert sum(item.position[0] for item in scene.items) == pytest.approx(0.0, abs=1e-9)


def test_the_seventh_begins_a_second_arc_which_holds_seven() -> None:
    """1.845 rad of 1.67 m are 3.08 m: six gaps of 0.45 m and seven items."""
    radii = [round(math.hypot(*item.position[:2]), 6) for item in alike(14).items]
    assert radii == [1.22] * 6 + [1.67] * 7 + [2.12]
    assert alike(7).items[6].position[:2] == pytest.approx((0.0, 1.67))


@pytest.mark.parametrize("count", [1, 0, 2001, True, 2.0])
def test_other_counts_are_refused(count: int) -> None:
    with pytest.raises(StudyError, match=r"items: found .*, expected a whole number from 2 to 2000"):
        alike(count)
