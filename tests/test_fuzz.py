"""Readers under random input: whatever they are given, nothing but the package's InputError escapes."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from fetch_pomdp.adapters.vision.recorded import RecordedSkeleton
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import InputError
from fetch_pomdp.files.header import header_to_json
from fetch_pomdp.files.recordings import EventLog, read_recording

fuzz = settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])

RECORDING = b"""\
{"scene": {"head": [0, 0, 1.6], "items": [{"id": "cup", "position": [0, 1, 1], "vocabulary": ["cup"]}]}, "seed": 1}
{"action": "point", "item": "cup", "t": 2.8}
{"observation": {"utterance": "yes", "words": [{"text": "yes", "start": 1, "end": 2}]}}
{"observation": {"utterance": null, "head": [0, 0, 1.6], "wrist": [0, 1, 1]}}
{"action": "pick", "item": "cup", "outcome": "done"}
"""
SKELETON = b"""\
{"t": 0.0, "head": [0, 0, 1.6], "wrist": [0, 1, 1.2]}
{"t": 0.5, "head": [0, 0, 1.6], "left_wrist": [0, 1, 1.2], "right_wrist": [0, 0, 1]}
"""
TABLE = b"""\
head = [0.0, 0.0, 1.6]
[model]
sigma = 0.2
[[items]]
id = "cup"
position = [0.0, 2.0, 0.75]
vocabulary = ["cup", "mug"]
"""

scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(-(10**400), 10**400),
    st.floats(),
    st.text(),
    st.sampled_from(["ambiguous", "wait", "point", "pick", "cup", "exact", "done", "\ud800", "a\nb", "x" * 5_000]),
)
NAMES = [
    "scene",
    "head",
    "items",
    "id",
    "position",
    "vocabulary",
    "model",
    "sigma",
    "rewards",
    "version",
    "planner",
    "name",
    "seed",
    "target",
    "action",
    "item",
    "outcome",
    "observation",
    "utterance",
    "words",
    "text",
    "start",
    "end",
    "wrist",
    "t",
]
keys = st.text() | st.sampled_from(NAMES)
structures = st.recursive(
    scalars, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=4), max_leaves=12
)


@st.composite
def mutated(draw: st.DrawFn, valid: bytes) -> bytes:
    """A valid file with some of its bytes replaced, removed or doubled."""
    content = bytearray(valid)
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(content) - 1))
        piece = draw(
            st.binary(max_size=2)
            | st.sampled_from([b"NaN", b"1e999", b"-", b"[", b"{", b'"', b"\\ud800", b"9" * 5_000])
        )
        length = draw(st.integers(0, 6))
        content[at : at + length] = piece
    return bytes(content)


def places(value: object, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield (*path, key)
            yield from places(inner, (*path, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield (*path, index)
            yield from places(inner, (*path, index))


@st.composite
def altered_lines(draw: st.DrawFn, valid: bytes) -> bytes:
    """Valid JSON Lines with one value replaced by anything."""
    lines: list[Any] = [json.loads(line) for line in valid.splitlines()]
    *parents, last = draw(st.sampled_from(list(places(lines))))
    target = lines
    for key in parents:
        target = target[key]  # type: ignore[index]
    target[last] = draw(structures)  # type: ignore[index]
    return "".join(json.dumps(line) + "\n" for line in lines).encode()


def check(message: str) -> None:
    assert message.isprintable()
    assert len(message) < 12_000


def read_log(path: Path) -> None:
    try:
        recording = read_recording(path)
    except InputError as error:
        check(str(error))
        return
    log = EventLog.begin(io.TextIOWrapper(io.BytesIO(), encoding="utf-8"), recording.header)
    for event in recording.events:
        log.write(event)
    json.dumps(header_to_json(recording.header), allow_nan=False)
    try:
        for _ in recording.replay(recording.header.agent()):
            pass
    except InputError as error:
        check(str(error))


def read_skeleton(path: Path) -> None:
    for read in (lambda: RecordedSkeleton.open(path), lambda: RecordedSkeleton.stream(path.open("rb")).see(9.0)):
        try:
            read()
        except InputError as error:
            check(str(error))


def read_scene(path: Path) -> None:
    try:
        Scene.load(path)
    except InputError as error:
        check(str(error))


@pytest.mark.parametrize("read", [read_log, read_skeleton, read_scene])
@given(content=st.binary(max_size=200))
@fuzz
def test_random_bytes(tmp_path: Path, read: Any, content: bytes) -> None:
    path = tmp_path / "input.toml"
    path.write_bytes(content)
    read(path)


@given(content=mutated(RECORDING) | altered_lines(RECORDING))
@example(content=b'{"scene": ' + b"[" * 985 + b"]" * 985 + b"}")
@example(content=RECORDING.replace(b'"id": "cup"', b'"id": "a\\nb"'))
@fuzz
def test_recordings(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "events.jsonl"
    path.write_bytes(content)
    read_log(path)


@given(content=mutated(SKELETON) | altered_lines(SKELETON))
@fuzz
def test_skeletons(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "skeleton.jsonl"
    path.write_bytes(content)
    read_skeleton(path)


@given(content=mutated(TABLE))
@fuzz
def test_scenes(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "scene.toml"
    path.write_bytes(content)
    read_scene(path)


@given(value=structures)
@fuzz
def test_scenes_from_anything(value: object) -> None:
    for data in (
        value,
        {"head": [0, 0, 1], "items": value},
        {"head": value, "items": [{"id": "a", "position": value, "vocabulary": value}]},
    ):
        try:
            Scene.from_mapping(data)  # type: ignore[arg-type]
        except InputError as error:
            check(str(error))
        except TypeError:
            assert not isinstance(data, dict), "a mapping is all that is promised to be read"


@pytest.mark.parametrize("depth", [*range(940, 1_000, 3), 5_000, 200_000])
def test_deep_nesting(tmp_path: Path, depth: int) -> None:
    path = tmp_path / "events.jsonl"
    for opening, closing in (("[", "]"), ('{"a":', "}")):
        inner = opening * depth + "0" + closing * depth
        path.write_text(f'{{"scene": {inner}}}\n')
        read_log(path)
        path.write_text(f'{{"t": 0, "head": {inner}, "wrist": [0, 0, 1]}}\n')
        read_skeleton(path)
    path.write_text(f"head = {'[' * depth}{']' * depth}\n")
    read_scene(path)
