"""Tables for live people: those of scene files, with what the robot expects of people where a file does not say.

Choice: in most seconds live people neither speak nor point, and who has said what they want falls silent. At the
paper's chances of speaking and pointing in a step, 0.95 and 0.1, the robot would wait for their next word for ever
(Section V saw that too). Live tables have 0.3 and 0.02 unless a file says otherwise. What a word or a gesture does to
the belief is the same with both; only what the robot expects of the next second differs.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import SceneError

LIVE_MODEL: Mapping[str, Any] = {"p_l": 0.3, "p_g": 0.02}


def lively(data: Mapping[str, Any]) -> Scene:
    """Build a scene from the fields of a scene file. Raises SceneError or ModelError, with the field."""
    model = data.get("model", {})
    return Scene.from_mapping({**data, "model": {**LIVE_MODEL, **model} if isinstance(model, Mapping) else model})


def live_scene(name_or_path: str | Path) -> Scene:
    """Return a built-in scene by name or read one from a TOML file. Raises as `Scene.load`."""
    if str(name_or_path) in LAYOUTS:
        return lively(LAYOUTS[str(name_or_path)])
    return read_toml(name_or_path, SceneError).build(lively)
