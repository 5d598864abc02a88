"""Files on a disk that fills up: whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from fetch_pomdp.core.action import Wait
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EventError, ModelError, StudyError
from fetch_pomdp.files.header import Header
from fetch_pomdp.files.models import write_model
from fetch_pomdp.files.recordings import EventLog, read_recording
from fetch_pomdp.files.writing import LineFile, replaced, write_new
from tests.files.disk import room_for

HEADER = Header(scene=Scene.load("ambiguous"), scene_name="ambiguous")


def test_a_log_without_room_for_its_first_line_is_not_left_behind(tmp_path: Path) -> None:
    with room_for(10), pytest.raises(EventError, match=r"log.jsonl: cannot be written: File too large, expected room"):
        EventLog.create(tmp_path / "log.jsonl", HEADER)
    assert list(tmp_path.iterdir()) == []


def fill(log: EventLog) -> None:
    while True:
        log.write(Acted(Wait()))


def test_a_log_ends_with_a_whole_line(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    with room_for(200), EventLog.create(path, HEADER) as log, pytest.raises(EventError, match=r"log.jsonl: cannot be"):
        fill(log)
    recording = read_recording(path)
    assert recording.torn is None
    assert len(recording.events) >= 2
    recording, log = EventLog.resume(path)
    with log:
        log.write(Acted(Wait()))
    assert len(read_recording(path).events) == len(recording.events) + 1


def test_a_new_file_is_whole_or_not_there(tmp_path: Path) -> None:
    lines = ["x" * 100] * 1000
    with room_for(5000), pytest.raises(ModelError, match=r"new.txt: cannot be written: .*, expected room for it"):
        write_new(tmp_path / "new.txt", lines, ModelError)
    with room_for(20), pytest.raises(ModelError, match="expected room for it"):
        write_model(tmp_path / "model.toml", ["a comment"], {"sigma": (0.2, "0.1 to 0.3 rad")})
    with pytest.raises(ModelError, match=r"cannot be written: .*null byte, expected a folder for it"):
        write_new("a\0b", lines, ModelError)
    assert list(tmp_path.iterdir()) == []
    write_new(tmp_path / "new.txt", ["grün"], ModelError)
    assert (tmp_path / "new.txt").read_bytes() == "grün\n".encode()
    with pytest.raises(ModelError, match="found an existing file"):
        write_new(tmp_path / "new.txt", lines, ModelError)


def test_what_was_there_is_kept_where_there_is_no_room(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("old")
    with (
        room_for(5000),
        pytest.raises(StudyError, match=r"table.csv: cannot be written: .*, expected room for it"),
        replaced(path, StudyError) as file,
    ):
        file.write(b"x" * 100_000)
    assert path.read_text() == "old"
    (tmp_path / "table.csv.part").write_text("left by a kill")
    with replaced(path, StudyError) as file:
        file.write(b"new")
    assert path.read_text() == "new"
    with pytest.raises(StudyError, match=r"^found"), replaced(path, StudyError):
        raise StudyError("found something else, expected this to pass")
    assert list(tmp_path.iterdir()) == [path]


def test_a_line_file_takes_all_of_a_line_or_nothing(tmp_path: Path) -> None:
    file = LineFile(tmp_path / "lines", "x", EventError)
    file.write("first\n")
    with room_for(10), pytest.raises(EventError, match="cannot be written"):
        file.write("second\n")
    file.write("third\n")
    file.close()
    assert (tmp_path / "lines").read_text() == "first\nthird\n"
