"""Text files as plain mappings that remember the line of each field.

It stands below the core, so that `Scene.load` can read a file while no module of the core opens one itself.
"""

from __future__ import annotations

import io
import json
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, AnyStr, TypeVar, cast

from fetch_pomdp.checks import shown
from fetch_pomdp.errors import InputError

Made = TypeVar("Made")
LARGEST_FILE = 1 << 26  # bytes: of a file that is read at once
LONGEST_LINE = 1 << 24  # bytes, or letters of a text: of a file that is read line by line

LARGEST_TOML = 1_000_000  # bytes: thousands of items
MOST_LEVELS = 16  # of a dotted key; tomllib takes time with the square of their number
# Texts, to their end if there is one, and comments; what ends a key; a dot of a key.
_TOML_PARTS = re.compile(
    r"""
      "{3} (?: [^"\\] | \\. | "(?!"") )*+ (?: "{3,5} )?+
    | '{3} (?: [^'] | '(?!'') )*+ (?: '{3,5} )?+
    | " (?: [^"\\\n] | \\. )*+ "?+
    | ' [^'\n]*+ '?+
    | \# [^\n]*+
    | (?P<end> [\n=,\[\]{}] )
    | (?P<dot> \. )
    """,
    re.DOTALL | re.VERBOSE,
)


@dataclass(frozen=True, slots=True)
class Document:
    """A mapping read from `source`; `line_of` gives the line (from 1) of a field's path, or None."""

    source: str
    data: Mapping[str, Any]
    line_of: Callable[[str], int | None]

    def build(self, make: Callable[[Mapping[str, Any]], Made]) -> Made:
        """Return `make(data)`; what it complains about is raised again with file and line."""
        try:
            return make(self.data)
        except InputError as error:
            raise error.located(self.source, self.line_of(error.field)) from None


def read_text(path: str | Path, error: type[InputError]) -> str:
    """Return a UTF-8 file's text. Raises `error` for a file that is missing, unreadable or not UTF-8."""
    return _decoded(read_raw(path, error), str(path), 1, error)


def read_raw(path: str | Path, error: type[InputError]) -> bytes:
    """Return a file's bytes. Raises `error` for a file that is missing, unreadable, or over LARGEST_FILE."""
    larger = f"found more than {LARGEST_FILE >> 20} MiB, expected a smaller file"
    return _at_most(LARGEST_FILE, path, error, larger)


def read_toml(path: str | Path, error: type[InputError]) -> Document:
    """Read a TOML file. Raises `error` as `parse_toml`, and for a file that cannot be read."""
    raw = _at_most(LARGEST_TOML, path, error, f"file too large, expected at most {LARGEST_TOML} bytes")
    return parse_toml(_decoded(raw, str(path), 1, error), str(path), error)


def _at_most(most: int, path: str | Path, error: type[InputError], larger: str) -> bytes:
    """Return a file's bytes, and read no more than `most` of them; larger: what to say of a file that has more."""
    try:
        with Path(path).open("rb") as stream:
            found = stream.read(most + 1)
    except (OSError, ValueError) as cause:
        raise error(_reason(cause), source=str(path)) from None
    if len(found) > most:
        raise error(larger, source=str(path))
    return found


def parse_toml(text: str, source: str, error: type[InputError]) -> Document:
    """Read TOML from a text; `source` is its name in messages.

    Raises `error`, with the line, for broken TOML, a text beyond LARGEST_TOML and a key of more than MOST_LEVELS parts.
    """
    if len(text) > LARGEST_TOML:
        raise error(f"text too large, expected at most {LARGEST_TOML} bytes", source=source)
    if line := _line_of_long_key(text):
        raise error(f"key with too many dots, expected at most {MOST_LEVELS} parts", source=source, line=line)
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as cause:
        message = str(cause)
        place = re.search(r"\s*\(at line (\d+), column \d+\)", message)
        line = int(place[1]) if place else text.count("\n") + 1
        broken = f"broken TOML: {message[: place.start()] if place else message}, expected `field = value` or a [table]"
        raise error(broken, source=source, line=line) from None
    except RecursionError:
        raise error("broken TOML: nested too deeply, expected a few levels", source=source) from None
    except ValueError as cause:  # a whole number of thousands of digits
        found, _, _ = str(cause).partition(";")
        raise error(f"broken TOML: {found}, expected numbers of ordinary size", source=source) from None
    lines = _toml_lines(text)

    def line_of(field: str) -> int | None:
        while field and field not in lines:
            field = field.rpartition("[" if field.endswith("]") else ".")[0]
        return lines.get(field, 1)

    return Document(source, data, line_of)


def _line_of_long_key(text: str) -> int | None:
    """Return the line of the first key with more than MOST_LEVELS parts, None if there is none."""
    dots = 0
    for part in _TOML_PARTS.finditer(text):
        if part["end"]:
            dots = 0
        elif part["dot"]:
            dots += 1
            if dots >= MOST_LEVELS:
                return text.count("\n", 0, part.start()) + 1
    return None


def _toml_lines(text: str) -> dict[str, int]:
    """Map each field's path to its line, for tables and arrays of tables written one field a line."""
    lines: dict[str, int] = {}
    counts: dict[str, int] = {}
    table = ""
    for number, line in enumerate(text.split("\n"), start=1):
        if many := re.match(r"\s*\[\[\s*([\w.-]+)\s*\]\]", line):
            name = many[1]
            counts[name] = counts.get(name, -1) + 1
            table = f"{name}[{counts[name]}]"
            lines.setdefault(name, number)
        elif single := re.match(r"\s*\[\s*([\w.-]+)\s*\]", line):
            table = single[1]
        elif key := re.match(r"\s*[\"']?([\w.-]+)[\"']?\s*=", line):
            lines.setdefault(f"{table}.{key[1]}" if table else key[1], number)
            continue
        else:
            continue
        lines.setdefault(table, number)
    return lines


def read_json_lines(path: str | Path, error: type[InputError]) -> Iterator[Document]:
    """Yield the JSON objects of a file, one a line. Raises `error` for a file that is missing or unreadable."""
    try:
        with Path(path).open("rb") as stream:
            yield from json_lines(stream, str(path), error)
    except (OSError, ValueError) as cause:
        if isinstance(cause, InputError):
            raise
        raise error(_reason(cause), source=str(path)) from None


def json_lines(stream: Iterable[bytes], source: str, error: type[InputError]) -> Iterator[Document]:
    """Yield the JSON objects of a stream as they come, one a line; empty lines are skipped.

    Raises `error` for a line that is not UTF-8, not JSON, not an object, repeats a field, or is over LONGEST_LINE where
    the stream is a file.
    """
    lines = bounded(cast("IO[bytes]", stream), source, error) if isinstance(stream, io.IOBase) else stream
    for number, raw in enumerate(lines, start=1):
        if (document := json_line(raw, source, number, error)) is not None:
            yield document


def bounded(stream: IO[AnyStr], source: str, error: type[InputError]) -> Iterator[AnyStr]:
    """Yield the lines of a file, so that one without end ends. Raises `error` for a line over LONGEST_LINE."""
    number = 0
    while line := stream.readline(LONGEST_LINE + 1):
        number += 1
        if len(line) > LONGEST_LINE:
            found = f"found a line of more than {LONGEST_LINE >> 20} MiB, expected a shorter one"
            raise error(found, source=source, line=number)
        yield line


def json_line(raw: bytes, source: str, line: int, error: type[InputError]) -> Document | None:
    """Return the JSON object of a line, None for an empty one. Raises `error` as `json_lines` does."""
    text = _decoded(raw, source, line, error)
    return Document(source, _json_object(text, source, line, error), lambda _: line) if text.strip() else None


def _json_object(text: str, source: str, line: int, error: type[InputError]) -> dict[str, Any]:
    def no_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        fields = dict(pairs)
        if len(fields) < len(pairs):
            names = [name for name, _ in pairs]
            twice = next(name for name in names if names.count(name) > 1)
            raise error("found twice, expected once", field=twice, source=source, line=line)
        return fields

    try:
        value = json.loads(text, object_pairs_hook=no_repeats)
    except json.JSONDecodeError as cause:
        problem = f"broken JSON: {cause.msg} at column {cause.colno}, expected one JSON object a line"
        raise error(problem, source=source, line=line) from None
    except RecursionError:
        raise error("broken JSON: nested too deeply, expected a few levels", source=source, line=line) from None
    except ValueError as cause:
        if isinstance(cause, InputError):
            raise
        raise error(f"broken JSON: {cause}, expected one JSON object a line", source=source, line=line) from None
    if not isinstance(value, dict):
        raise error(f"found {shown(value)}, expected a JSON object", source=source, line=line)
    return value


def _decoded(raw: bytes, source: str, line: int, error: type[InputError]) -> str:
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as cause:
        bad = line + raw[: cause.start].count(b"\n")
        found = f"found byte 0x{raw[cause.start]:02x}, expected UTF-8 text"
        raise error(found, source=source, line=bad) from None


def _reason(cause: Exception) -> str:
    return f"cannot be read: {getattr(cause, 'strerror', None) or cause}, expected a readable file"
