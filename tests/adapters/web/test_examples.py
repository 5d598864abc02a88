"""What the page proposes to say is understood, whatever stands on the table."""

from __future__ import annotations

import pytest

from fetch_pomdp.adapters.web.examples import examples
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.names import named
from fetch_pomdp.core.language.words import COURTESY
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.scene import Item, Scene

HEAD = (0.0, 0.0, 1.6)
SINGLE = Scene(items=(Item(id="thing", position=(0.0, 2.0, 0.75), vocabulary=("blue",)),), head=HEAD)
TABLES = [*(live_scene(name) for name in ("ambiguous", "unambiguous", "examples/kitchen.toml")), SINGLE]


@pytest.mark.parametrize("scene", [named(table) for table in TABLES])
def test_every_example_is_understood_to_the_last_word(scene: Scene) -> None:
    lines = examples(scene)
    assert len(lines) == 3
    for line in lines:
        understood = Agent(scene).observe(line)
        assert understood.base
        assert set(understood.unknown) <= COURTESY


def test_they_show_what_can_be_said_of_this_table() -> None:
    assert examples(named(live_scene("ambiguous"))) == [
        "hand me the bowl",
        "the green marker, please",
        "could I have spoon 2",
    ]
    assert examples(named(live_scene("examples/kitchen.toml"))) == [
        "hand me the mug",
        "the red mug, please",
        "could I have the whisk",
    ]
