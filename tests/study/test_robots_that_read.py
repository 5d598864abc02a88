"""A study whose robots read with a grammar: the same whoever plays it, and replayed from its logs."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from fetch_pomdp.files.checking import differences
from fetch_pomdp.files.recordings import read_recording
from fetch_pomdp.study.experiment import run
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.record import LOGS, NAME, read_trials
from tests.study.small import small


def test_robots_that_read_are_played_and_replayed_alike(tmp_path: Path) -> None:
    reading = small(logs=True, reader="table", population=People(grammar="reader", p_place=0.8))
    one, two, words = (tmp_path / name for name in ("one", "two", "words"))
    for folder in (one, two):
        run(reading, folder)
    assert (one / NAME).read_bytes() == (two / NAME).read_bytes()
    paths = sorted((one / LOGS).iterdir())
    assert [path.read_bytes() for path in paths] == [path.read_bytes() for path in sorted((two / LOGS).iterdir())]
    logs = [read_recording(path) for path in paths]
    assert {log.header.reader for log in logs} == {"table"}
    for log in logs:
        assert list(differences(log)) == []
    run(dataclasses.replace(reading, reader="words"), words)
    assert list(read_trials(words / NAME)) != list(read_trials(one / NAME))
