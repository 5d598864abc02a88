"""The shapes of what stands on the table."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from fetch_pomdp.adapters.robot.mujoco.kinds import (
    BLOCK,
    BOWL,
    CUP,
    KINDS,
    MARKER,
    SPOON,
    Kind,
    Part,
    color_of,
    kind_of,
)
from fetch_pomdp.core.layouts import LAYOUTS


def rotated(part: Part, point: np.ndarray) -> np.ndarray:
    """A point of a part in the frame of its body."""
    w, vector = part.rotation[0], np.array(part.rotation[1:])
    turned = 2 * np.cross(vector, point)
    found: np.ndarray = point + w * turned + np.cross(vector, turned) + np.array(part.place)
    return found


def corners(part: Part) -> list[np.ndarray]:
    """The corners of the box around a part."""
    radius, half, _ = part.size
    size = {"box": part.size, "ellipsoid": part.size, "cylinder": (radius, radius, half)}[part.shape]
    return [rotated(part, np.array(signs) * size) for signs in itertools.product((-1.0, 1.0), repeat=3)]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_things_stand_on_the_table_and_are_as_high_and_wide_as_they_say(kind: Kind) -> None:
    points = np.array([point for part in kind.parts for point in corners(part)])
    assert points[:, 2].min() == pytest.approx(0.0, abs=5e-4)
    assert points[:, 2].max() == pytest.approx(kind.top, abs=1e-3)
    assert np.abs(points[:, :2]).max() <= kind.radius + 1e-3
    assert 0.03 < sum(part.mass for part in kind.parts) < 0.3


@pytest.mark.parametrize(
    ("words", "kind"),
    [
        (("mug", "cup", "red"), CUP),
        (("whisk", "metal"), SPOON),
        (("marker", "green", "expo", "pen"), MARKER),
        (("bowl", "black"), BOWL),
        (("thing",), BLOCK),
    ],
)
def test_words_name_a_kind(words: tuple[str, ...], kind: Kind) -> None:
    assert kind_of(words) is kind


def test_the_items_of_the_paper_have_their_kinds() -> None:
    kinds = [kind_of(item["vocabulary"]).name for item in LAYOUTS["ambiguous"]["items"]]
    assert kinds == ["bowl", "bowl", "marker", "marker", "spoon", "spoon"]


def test_words_name_a_colour() -> None:
    assert color_of(("marker", "green"))[:3] == (0.1, 0.6, 0.2)
    assert color_of(("marker",)) == color_of(("pot",))
