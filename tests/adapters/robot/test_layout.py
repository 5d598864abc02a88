"""Where robot and table stand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fetch_pomdp.adapters.robot.mujoco.description import RobotDescription
from fetch_pomdp.adapters.robot.mujoco.layout import layout
from fetch_pomdp.core.scene import Item, Scene

BAXTER = RobotDescription.load("baxter")


def test_the_robot_stands_across_the_table_and_faces_the_person() -> None:
    found = layout(Scene.load("ambiguous"), BAXTER)
    assert found.base == pytest.approx((0.0, 3.2 + BAXTER.table_distance, BAXTER.height))
    assert found.forward == pytest.approx((0.0, -1.0))
    assert found.yaw == pytest.approx(-math.pi / 2)
    assert found.table == pytest.approx((0.0, 3.2, 0.75))
    assert [body.yaw for body in found.bodies][2] == pytest.approx(math.atan2(3.2, -0.075)), "away from the person"


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.5, -1.9])
def test_a_turned_scene_is_a_turned_layout(turn: float) -> None:
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    scene = Scene.load("unambiguous")
    items = []
    for item in scene.items:
        x, y = rotation @ item.position[:2] + [3.0, -2.0]
        items.append(Item(id=item.id, position=(x, y, item.position[2]), vocabulary=item.vocabulary))
    turned = Scene(items=tuple(items), head=(3.0, -2.0, 1.6))
    one, other = layout(scene, BAXTER), layout(turned, BAXTER)
    assert np.array(other.base[:2]) == pytest.approx(rotation @ one.base[:2] + [3.0, -2.0])
    assert np.array(other.forward) == pytest.approx(rotation @ one.forward)
    assert other.table_half == pytest.approx(one.table_half)


def test_all_items_are_on_the_table() -> None:
    found = layout(Scene.load("unambiguous"), BAXTER)
    ahead = np.array(found.forward)
    for body in found.bodies:
        off = np.array(body.place[:2]) - found.table[:2]
        assert abs(off @ ahead) + body.kind.radius <= found.table_half[0]
        assert abs(off @ [-ahead[1], ahead[0]]) + body.kind.radius <= found.table_half[1]


def test_a_generator_turns_things() -> None:
    scene = Scene.load("ambiguous")
    one, again = (layout(scene, BAXTER, np.random.default_rng(5)) for _ in range(2))
    assert one == again
    assert np.std([body.yaw for body in one.bodies]) > 0.5
