"""Skeletons from JSON Lines, and the robot of the terminal."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from fetch_pomdp import extras
from fetch_pomdp.adapters.robot.console import ConsoleRobot
from fetch_pomdp.adapters.vision.recorded import RecordedSkeleton
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import MissingExtraError, SkeletonError


def line(**fields: Any) -> bytes:
    return json.dumps(fields).encode() + b"\n"


HEAD, WRIST = [0.0, 0.0, 1.6], [0.0, 0.7, 1.4]


def test_frames_come_each_once_up_to_their_time(tmp_path: Path) -> None:
    path = tmp_path / "skeleton.jsonl"
    path.write_bytes(b"".join(line(t=t, head=HEAD, wrist=WRIST) for t in (0.0, 0.5, 1.0, 1.0, 1.1)))
    eyes = RecordedSkeleton.open(path)
    assert [frame.time for frame in eyes.see(0.5)] == [0.0, 0.5]
    assert [frame.time for frame in eyes.see(0.6)] == []
    assert [frame.time for frame in eyes.see(1.0)] == [1.0, 1.0]
    assert [frame.time for frame in eyes.see(99.0)] == [1.1]
    assert list(eyes.see(199.0)) == []


def test_both_arms() -> None:
    left = [0.2, 0.7, 1.4]
    eyes = RecordedSkeleton.stream(
        [line(t=0, head=HEAD, left_wrist=left, right_wrist=WRIST), line(t=1, head=HEAD, wrist=None, left_wrist=left)]
    )
    first, second = eyes.see(2.0)
    assert first.wrists == (tuple(left), tuple(WRIST))
    assert second.wrists == (tuple(left),)
    assert first.head == tuple(HEAD)


def test_a_stream_is_read_no_farther_than_the_first_later_frame() -> None:
    read: list[float] = []

    def lines() -> Iterator[bytes]:
        for t in (0.0, 1.0, 2.0, 3.0):
            read.append(t)
            yield line(t=t, head=HEAD, wrist=WRIST)

    eyes = RecordedSkeleton.stream(lines())
    assert len(eyes.see(0.5)) == 1
    assert read == [0.0, 1.0]
    assert len(eyes.see(2.5)) == 2
    assert read == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"t": 1, "head": HEAD}, "wrist: found none, expected wrist, left_wrist or right_wrist"),
        ({"t": 1, "wrist": WRIST}, "head: found no such field"),
        ({"head": HEAD, "wrist": WRIST}, "t: found no such field"),
        ({"t": -1, "head": HEAD, "wrist": WRIST}, "t: found -1, expected a time in seconds from 0"),
        ({"t": 0.4, "head": HEAD, "wrist": WRIST}, "t: found 0.4, expected at least 0.5, the time of the frame before"),
        ({"t": float("nan"), "head": HEAD, "wrist": WRIST}, "t: found nan"),
        ({"t": True, "head": HEAD, "wrist": WRIST}, "t: found True"),
        ({"t": 1, "head": HEAD, "wrist": HEAD}, "wrist: found the position of the head"),
        ({"t": 1, "head": HEAD, "wrist": WRIST, "right_wrist": HEAD}, "right_wrist: found the position of the head"),
        ({"t": 1, "head": [0, 0, float("inf")], "wrist": WRIST}, "head: found inf"),
        ({"t": 1, "head": HEAD, "wrist": [1, 2]}, "wrist: found [1, 2]"),
        ({"t": 1, "head": HEAD, "rist": WRIST}, "rist: unknown field, expected one of t, head, wrist"),
        ({"t": 1, "head": HEAD, "wrist": {"x": 1}}, "wrist: found {'x': 1}"),
    ],
)
def test_frames_that_are_none(tmp_path: Path, fields: dict[str, Any], message: str) -> None:
    path = tmp_path / "skeleton.jsonl"
    path.write_bytes(line(t=0.5, head=HEAD, wrist=WRIST) + line(**fields))
    with pytest.raises(SkeletonError) as caught:
        RecordedSkeleton.open(path)
    assert str(caught.value).startswith(f"{path}:2: {message}")
    eyes = RecordedSkeleton.stream(path.read_bytes().splitlines(keepends=True))
    with pytest.raises(SkeletonError) as caught:
        eyes.see(9.0)
    assert str(caught.value).startswith(f"standard input:2: {message}")


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(SkeletonError, match="cannot be read"):
        RecordedSkeleton.open(tmp_path / "none.jsonl")


def test_console_robot_shows_what_it_does() -> None:
    shown: list[str] = []
    robot, item = ConsoleRobot(shown.append), Scene.load("ambiguous").items[2]
    assert [robot.point(item), robot.pick(item), robot.say("Hello.")] == [Outcome.DONE] * 3
    robot.stop()
    assert shown == ["(points at marker-1) This one?", "(hands over marker-1) Here you are.", "Hello."]


def test_a_missing_library_is_answered_with_the_line_that_installs_it() -> None:
    with pytest.raises(MissingExtraError, match=r'pip install "fetch-pomdp\[speech\]"'):
        extras.load("no_such_library", "speech")
    assert extras.load("json", "speech") is json
