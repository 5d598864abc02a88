"""The model of a live person: what the robot expects of people wherever it meets somebody.

The defaults of `Model` are the paper's, of people who speak in 19 of 20 seconds. Live people say a thing once and wait
(`turns`), so that the robot would wait for their next word for ever; Section V saw that too.

Choice: alpha and p_truth are those of our simulated people, as `fetch-pomdp calibrate` finds them: a word that is not
the item's is rarer than the paper has it, and answers are misheard more often than once in a hundred. sigma lies
between the paper's 0.15 rad and the 0.07 of a steady arm whose eye and fingertip line up: an arm that is held counts
little anew in each step (`Turns.held`), but how it errs is not known before somebody has calibrated it.

Choice: prices are the paper's. A question at the price of the time it takes is asked at the first sight of an arm; and
where a wrong item is dearer, robots that never ask never hand over one of two alike items, for their search sees two
waits and no end of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fetch_pomdp.core.model import Model
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.core.turns import Turns

LIVE_MODEL = Model(alpha=0.04, p_l=0.3, p_g=0.1, sigma=0.1, p_truth=0.95, turns=Turns())


def live_scene(name_or_path: str | Path) -> Scene:
    """Load a scene as `Scene.load` does, before live people where its file does not say otherwise."""
    return Scene.load(name_or_path, LIVE_MODEL)


def live_scene_from(data: Mapping[str, Any]) -> Scene:
    """Build a scene from the fields of a scene file as `Scene.from_mapping` does, before live people."""
    return Scene.from_mapping(data, LIVE_MODEL)
