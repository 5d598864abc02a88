"""The header of a scene whose items are called by their labels."""

from __future__ import annotations

import pytest

from fetch_pomdp.core.language.names import named
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EventError
from fetch_pomdp.files.header import Header, header_from_json, header_to_json


def test_a_built_in_scene_with_names_is_written_by_its_name_and_comes_back() -> None:
    header = Header(scene=named(live_scene("ambiguous")), scene_name="ambiguous")
    fields = header_to_json(header)
    assert (fields["scene"], fields["names"]) == ("ambiguous", True)
    assert header_from_json(fields) == header
    assert "names" not in header_to_json(Header(scene=Scene.load("ambiguous"), scene_name="ambiguous"))


def test_a_table_of_ones_own_has_its_names_among_its_words() -> None:
    header = Header(scene=named(live_scene("ambiguous")))
    fields = header_to_json(header)
    assert "names" not in fields
    assert header_from_json(fields).scene.items == header.scene.items


def test_names_are_there_or_not() -> None:
    with pytest.raises(EventError, match="names: found 1, expected true or false"):
        header_from_json({"scene": "ambiguous", "names": 1})
