"""Actions, checked when built."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from fetch_pomdp.core.action import Pick, Point
from fetch_pomdp.errors import ActionError


@pytest.mark.parametrize("kind", [Point, Pick])
@pytest.mark.parametrize("number", [2, np.int64(2), np.uint8(2), np.array([1, 2]).argmax() + 1])
def test_an_item_is_an_index_of_python_or_numpy(kind: Any, number: Any) -> None:
    action = kind(number)
    assert action == kind(2)
    assert type(action.item) is int
    assert pickle.loads(pickle.dumps(action)) == action


@pytest.mark.parametrize("kind", [Point, Pick])
@pytest.mark.parametrize("item", [True, np.True_, 2.0, np.float64(2), "marker-1", None, np.array([2]), 1 + 0j])
def test_anything_else_is_refused(kind: Any, item: Any) -> None:
    with pytest.raises(ActionError, match=r"^item: found .+, expected the index of an item, a whole number$"):
        kind(item)
