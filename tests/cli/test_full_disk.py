"""Commands that write, on a disk that fills up while they do."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from fetch_pomdp.files.recordings import read_recording
from fetch_pomdp.study.record import NAME, read_trials
from tests.cli.conftest import Run
from tests.files.disk import room_for

CONFIG = 'people = 2\ntrials = 1\n[paradigms]\nalways = "paper-always"\nquick = {planner = "threshold", pick = 0.8}\n'


def test_a_log_keeps_the_whole_lines_or_is_not_there(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("a thing\n" * 60))
    run("fetch", "ambiguous", "--planner", "paper-always")  # Numba's cache has room
    path = tmp_path / "log.jsonl"
    for room, left in ((10, []), (3000, [path])):
        monkeypatch.setattr(sys, "stdin", io.StringIO("a thing\n" * 60))
        with room_for(room):
            code, _, err = run("fetch", "ambiguous", "--planner", "paper-always", "--log", path)
        assert (code, list(tmp_path.iterdir())) == (2, left)
        assert err == f"fetch-pomdp: {path}: cannot be written: File too large, expected room for it\n"
    assert read_recording(path).torn is None


def test_a_study_keeps_the_whole_trials_and_goes_on_from_them(run: Run, tmp_path: Path) -> None:
    out, config = tmp_path / "out", tmp_path / "study.toml"
    config.write_text(CONFIG)
    command = ("study", "--config", config, "--out", out, "--workers", 1, "--json")
    run(*command[:4], tmp_path / "elsewhere", *command[5:])  # Numba's cache has room
    for room in (100, 5000):
        with room_for(room):
            code, printed, err = run(*command)
        assert (code, printed) == (2, "")
        told = f"fetch-pomdp: {out / NAME}: cannot be written: File too large, expected room for it"
        assert err.splitlines()[-1] == told
        assert [path.name for path in out.iterdir()] == ([] if room == 100 else [NAME])
    whole = len(list(read_trials(out / NAME)))
    assert 0 < whole < 24
    assert (out / NAME).read_bytes().endswith(b"\n")
    with room_for((out / NAME).stat().st_size + 50):
        assert run(*command)[0] == 2
    code, _, _ = run(*command)
    assert code == 0
    assert len(list(read_trials(out / NAME))) == 24


def test_an_export_is_whole_or_not_there(run: Run, tmp_path: Path) -> None:
    new = tmp_path / "scene.pomdp"
    run("export", "ambiguous", new)  # Numba's cache has room
    new.unlink()
    with room_for(2000):
        code, _, err = run("export", "ambiguous", new)
    assert (code, list(tmp_path.iterdir())) == (2, [])
    assert err == f"fetch-pomdp: {new}: cannot be written: File too large, expected room for it\n"
