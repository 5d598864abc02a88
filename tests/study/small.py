"""Small studies for tests: two or three items, robots that decide at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.study.design import Paradigm, Study
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people.parameters import People

PARADIGMS = {
    "sure": Paradigm(planner="paper-always", parameters={"confidence": 0.9}),
    "quick": Paradigm(planner="threshold", parameters={"pick": 0.8}),
}


def row(count: int) -> Scene:
    items = tuple(
        Item(id=f"item-{index}", position=(0.5 * index, 2.0, 0.75), vocabulary=("thing", f"kind{index}"))
        for index in range(count)
    )
    return Scene(items=items, head=(0.0, 0.0, 1.6))


def small(**changes: Any) -> Study:
    layouts: Mapping[str, Scene] = {"near": row(2), "far": row(3)}
    plain = {"population": People(), "clock": Durations()}
    return Study(**{"people": 2, "trials": 1, "layouts": layouts, "paradigms": PARADIGMS, **plain, **changes})
