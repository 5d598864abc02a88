"""What is read does not depend on what people do not mean: where the origin is, the unit, the order of the items."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable

import numpy as np
import pytest

from fetch_pomdp.core.language.reading.reader import Context
from fetch_pomdp.core.language.reading.tokens import words_of
from fetch_pomdp.core.scene import Scene
from tests.core.language.reading.dialogues import GRID, KITCHEN
from tests.core.language.reading.tables import LINE, READER, ROOM

# Each says where everybody is, so that nothing hangs on a distance in metres.
TABLES = [dataclasses.replace(each, robot=each.robot or (0.1, 1.9, 1.2)) for each in (LINE, ROOM, GRID, KITCHEN)]
SENTENCES = (
    "the red one on my left", "second from the right", "the one closest to you", "the bowl next to the pan",
    "the block between the two red ones", "the middle one of the three", "not the white one, the one behind it",
    "the leftmost one from my point of view", "the blue one to the right of the yellow one", "the cup by itself",
    "the one in front of me", "the third one from your left in the row closest to you", "the two on the far right",
)  # fmt: skip


def chances(text: str, table: Scene) -> np.ndarray:
    return np.exp(READER.read(words_of(text), table, Context()).log_likelihood)


def moved(table: Scene, move: Callable[[np.ndarray], np.ndarray]) -> Scene:
    """A table with every place moved, (x, y) -> (x, y)."""

    def place(point: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y = move(np.array(point[:2])).tolist()
        return x, y, point[2]

    items = tuple(dataclasses.replace(item, position=place(item.position)) for item in table.items)
    assert table.robot is not None
    return dataclasses.replace(table, items=items, head=place(table.head), robot=place(table.robot))


def turned(point: np.ndarray) -> np.ndarray:
    x, y = point
    return np.array([0.6 * x - 0.8 * y + 3.0, 0.8 * x + 0.6 * y - 2.0])


@pytest.mark.parametrize("text", SENTENCES)
@pytest.mark.parametrize("move", [turned, lambda point: 2.5 * point], ids=["elsewhere", "larger"])
def test_where_and_how_large_a_table_is_does_not_matter(text: str, move: Callable[[np.ndarray], np.ndarray]) -> None:
    for table in TABLES:
        assert chances(text, moved(table, move)) == pytest.approx(chances(text, table), abs=1e-6)


@pytest.mark.parametrize("text", SENTENCES)
def test_left_and_right_are_each_others_mirror(text: str) -> None:
    swapped = re.sub("left|right", lambda found: {"left": "right", "right": "left"}[found[0]], text)
    for table in TABLES:
        mirrored = moved(table, lambda point: point * np.array([-1.0, 1.0]))
        assert chances(swapped, mirrored) == pytest.approx(chances(text, table), abs=1e-6)


@pytest.mark.parametrize("text", SENTENCES)
def test_the_order_of_the_items_does_not_matter(text: str) -> None:
    for table in TABLES:
        order = np.random.default_rng(0).permutation(len(table.items))
        other = dataclasses.replace(table, items=tuple(table.items[index] for index in order))
        assert chances(text, other) == pytest.approx(chances(text, table)[order], abs=1e-6)
