"""A skeleton from JSON Lines, a file or a stream: one frame a line.

    {"t": 0.033, "head": [x, y, z], "wrist": [x, y, z]}
    {"t": 0.066, "head": [x, y, z], "left_wrist": [x, y, z], "right_wrist": [x, y, z]}

Times in seconds, never going back; positions in metres in the frame of the scene.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

from fetch_pomdp import checks
from fetch_pomdp.core.ports import Frame
from fetch_pomdp.documents import Document, json_lines, read_json_lines
from fetch_pomdp.errors import SkeletonError

WRISTS = ("wrist", "left_wrist", "right_wrist")


class RecordedSkeleton:
    """A SkeletonSource over JSON Lines; after the last line there is nobody to see."""

    def __init__(self, frames: Iterator[Frame]) -> None:
        self._frames = frames
        self._next: Frame | None = None

    @classmethod
    def open(cls, path: str | Path) -> Self:
        """Read a file, all of it at once. Raises SkeletonError, with line and field, for what is not a skeleton."""
        return cls(iter(list(frames_of(read_json_lines(path, SkeletonError)))))

    @classmethod
    def stream(cls, lines: Iterable[bytes], source: str = "standard input") -> Self:
        """Read lines as they come; SkeletonError is raised when a bad one is reached."""
        return cls(frames_of(json_lines(lines, source, SkeletonError)))

    def see(self, until: float) -> Sequence[Frame]:
        """Return the frames up to a time (s), each exactly once; a stream is read until a later frame comes."""
        seen: list[Frame] = []
        while True:
            frame = self._next if self._next is not None else next(self._frames, None)
            self._next = frame
            if frame is None or frame.time > until:
                return seen
            seen.append(frame)
            self._next = None


def frames_of(documents: Iterable[Document]) -> Iterator[Frame]:
    """Yield the frames of the lines of a skeleton. Raises SkeletonError for a bad one, or a time that goes back."""
    before = -math.inf
    for document in documents:
        frame = document.build(_frame)
        if frame.time < before:
            problem = f"found {frame.time!r}, expected at least {before!r}, the time of the frame before"
            raise SkeletonError(problem, field="t", source=document.source, line=document.line_of("t"))
        before = frame.time
        yield frame


def _frame(data: Mapping[str, Any]) -> Frame:
    checks.known(data, ("t", "head", *WRISTS), "field", SkeletonError)
    checks.required(data, ("t", "head"), SkeletonError)
    head = checks.point(data["head"], "head", SkeletonError)
    wrists = {name: checks.point(data[name], name, SkeletonError) for name in WRISTS if data.get(name) is not None}
    if not wrists:
        raise SkeletonError("found none, expected wrist, left_wrist or right_wrist", field="wrist")
    for name, wrist in wrists.items():
        if math.dist(head, wrist) < 1e-9:
            raise SkeletonError("found the position of the head, expected one away from it", field=name)
    time = checks.within(data["t"], 0.0, 1e9, "t", "a time in seconds from 0", SkeletonError)
    return Frame(time, head, tuple(wrists.values()))
