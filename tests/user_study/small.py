"""A small study: a table with two markers, a robot that asks, four trials a person."""

from __future__ import annotations

from pathlib import Path

TABLE = """
head = [0.0, 0.0, 1.6]
[[items]]
id = "marker-1"
position = [-0.3, 1.2, 0.75]
vocabulary = ["marker", "green"]
[[items]]
id = "marker-2"
position = [0.3, 1.2, 0.75]
vocabulary = ["marker", "green"]
"""
STUDY = """
people = 2
trials = 1
layouts = ["pair.toml"]
[paradigms]
asks = "threshold"
[participation]
practice = 1
countdown = 0.1
keep_sound = true
title = {en = "Fetching", de = "Holen"}
consent = {en = "You talk to a robot.", de = "Sie sprechen mit einem Roboter."}
[[participation.questions]]
id = "open"
kind = "text"
text = {en = "What did it understand?", de = "Was hat er verstanden?"}
[[participation.questions]]
id = "kinds"
kind = "choices"
page = 2
required = false
text = {en = "Which of these?"}
options = [{id = "names", en = "Names"}, {id = "places", en = "Places"}]
[[participation.questions]]
id = "ease"
kind = "scale"
page = 2
text = {en = "It was"}
options = [{en = "hard"}, {en = "easy"}]
"""


def small_study(folder: Path, text: str = STUDY) -> Path:
    """Write the study's files, and return that of the study."""
    (folder / "pair.toml").write_text(TABLE)
    path = folder / "small.toml"
    path.write_text(text)
    return path
