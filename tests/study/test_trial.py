"""Logs of a study become its trials."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest

from fetch_pomdp.errors import EventError
from fetch_pomdp.files.recordings import Recording, read_recording
from fetch_pomdp.study.trial import Trial, trials_of

HEADER = {"scene": "ambiguous", "planner": "sparse", "target": "bowl-2", "person": 3}
EVENTS = [
    {"action": "wait", "t": 0.0},
    {"observation": {"utterance": "bowl"}, "t": 1.0},
    {"action": "point", "item": "bowl-1", "t": 2.8},
    {"observation": {"utterance": "no"}, "t": 3.8},
    {"action": "pick", "item": "bowl-2", "outcome": "failed", "t": 4.5},
    {"observation": {}, "t": 5.5},
    {"action": "pick", "item": "bowl-2", "t": 6.25},
]


def read(folder: Path, header: dict[str, object], events: list[dict[str, object]]) -> tuple[str, Recording]:
    path = folder / f"{len(list(folder.iterdir()))}.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in [header, *events]))
    return str(path), read_recording(path)


def test_a_log_is_scored_as_a_trial(tmp_path: Path) -> None:
    told = {**HEADER, "layout": "near", "paradigm": "fetch", "order": 7, "begun": 0.25}
    (trial,) = trials_of([read(tmp_path, told, EVENTS)])
    assert trial == Trial(3, "near", "fetch", "bowl-2", 7, 6.0, True, "bowl-2", 1, 1)


@pytest.mark.parametrize(
    "more",
    [
        [{"action": "pick", "item": "bowl-2", "outcome": "returned", "t": 7.0}, {"action": "pick", "item": "bowl-1"}],
        [
            {"observation": {"utterance": "marker"}, "t": 9.0, "anew": True},
            {"action": "point", "item": "marker-1", "t": 11.0},
            {"action": "pick", "item": "marker-1", "t": 14.0},
        ],
    ],
)
def test_a_trial_ends_with_the_first_hand_over(tmp_path: Path, more: list[dict[str, object]]) -> None:
    told = {**HEADER, "begun": 0.25}
    first, longer = trials_of([read(tmp_path, told, EVENTS), read(tmp_path, told, [*EVENTS, *more])])
    assert longer == dataclasses.replace(first, order=1)
    assert (longer.picked, longer.correct) == ("bowl-2", True)


def test_what_a_header_leaves_out(tmp_path: Path) -> None:
    logs = [read(tmp_path, {**HEADER, "person": person}, EVENTS[:-1]) for person in (3, 4, 3)]
    trials = list(trials_of(logs))
    assert [(trial.person, trial.order) for trial in trials] == [(3, 0), (4, 0), (3, 1)]
    assert trials[0] == Trial(3, "ambiguous", "sparse", "bowl-2", 0, 5.5, False, None, 1, 1)


@pytest.mark.parametrize("missing", ["person", "target"])
def test_who_wanted_what_must_be_known(tmp_path: Path, missing: str) -> None:
    header = {name: value for name, value in HEADER.items() if name != missing}
    with pytest.raises(EventError, match=rf"0.jsonl:1: {missing}: found none, expected it"):
        list(trials_of([read(tmp_path, header, [])]))


def test_a_table_of_ones_own_has_a_layout(tmp_path: Path) -> None:
    table = {"head": [0, 0, 1], "items": [{"id": "bowl-2", "position": [0, 1, 0], "vocabulary": ["bowl"]}]}
    with pytest.raises(EventError, match="layout: found none"):
        list(trials_of([read(tmp_path, {**HEADER, "scene": table}, [])]))
