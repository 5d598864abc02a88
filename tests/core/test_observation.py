"""Observations, checked when built."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.errors import ObservationError


def test_a_list_of_words_becomes_a_tuple() -> None:
    assert Observation(["green", "marker"]) == Observation(("green", "marker"))  # type: ignore[arg-type]
    assert Observation((np.str_("marker"),)).words == ("marker",)
    ray = Ray(np.array([0, 0, 1.6]), np.array([0, 1, 1.2], dtype=np.float32))  # type: ignore[arg-type]
    assert Observation(ray=ray).ray == ray


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"words": "marker"}, r"^words: found 'marker', expected a tuple of words, such as tokenize"),
        ({"words": None}, "^words: found None, expected a tuple of words"),
        ({"words": ("green", 3)}, r"^words\[1\]: found 3, expected a word$"),
        ({"words": (b"marker",)}, r"^words\[0\]: found b'marker', expected a word$"),
        ({"ray": ((0, 0, 1.6), (0, 1, 1.2))}, r"^ray: found \(\(0, 0, 1.6\), .*, expected a Ray or None$"),
    ],
)
def test_anything_else_is_refused(given: Any, message: str) -> None:
    with pytest.raises(ObservationError, match=message):
        Observation(**given)
