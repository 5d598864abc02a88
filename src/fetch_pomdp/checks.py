"""Checks of single values, shared by all that takes input: each returns the value, or raises the error it is given."""

from __future__ import annotations

import math
import numbers
import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from fetch_pomdp.errors import InputError

Point3 = tuple[float, float, float]
CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")  # what XML cannot hold
FARTHEST = 1e6  # m: beyond it squared distances lose the precision that an angle needs


def shown(value: object, limit: int = 60) -> str:
    """Return `value` as a short single line for a message."""
    try:
        text = re.sub(r"\s+", " ", repr(value))
    except (RecursionError, ValueError):  # nested too deeply, or an int of thousands of digits
        text = f"a huge {type(value).__name__}"
    return text if len(text) <= limit else text[: limit - 3] + "..."


def number(value: object, field: str, expected: str, error: type[InputError]) -> float:
    """Return a finite number, Python's or NumPy's, as a float; bool and text are refused."""
    try:
        real = isinstance(value, float | int | numbers.Real) and not isinstance(value, bool)
        result = float(value) if real else math.nan  # type: ignore[arg-type]
    except OverflowError:  # an int too large for a float
        result = math.nan
    if not math.isfinite(result):
        raise error(f"found {shown(value)}, expected {expected}", field=field)
    return result


def whole(value: object, least: int, most: int, field: str, error: type[InputError]) -> int:
    """Return a whole number in [least, most], Python's or NumPy's, as an int; bool is refused."""
    result = int(value) if isinstance(value, int | numbers.Integral) and not isinstance(value, bool) else least - 1
    if not least <= result <= most:
        raise error(f"found {shown(value)}, expected a whole number from {least} to {most}", field=field)
    return result


def within(value: object, low: float, high: float, field: str, expected: str, error: type[InputError]) -> float:
    """Return a number in [low, high]."""
    checked = number(value, field, expected, error)
    if not low <= checked <= high:
        raise error(f"found {shown(value)}, expected {expected}", field=field)
    return checked


def point(value: object, field: str, error: type[InputError]) -> Point3:
    """Return a position, three finite numbers in metres, as a tuple."""
    expected = "[x, y, z], three finite numbers in metres"
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != 3:
        raise error(f"found {shown(value)}, expected {expected}", field=field)
    x, y, z = (within(part, -FARTHEST, FARTHEST, field, expected, error) for part in value)
    return x, y, z


def text(value: object, field: str, expected: str, error: type[InputError]) -> str:
    """Return a text that is not empty."""
    if not isinstance(value, str) or not value.strip():
        raise error(f"found {shown(value)}, expected {expected}", field=field)
    if any("\ud800" <= letter <= "\udfff" for letter in value):  # JSON can spell them, no file can hold them
        raise error(f"found {shown(value)}, expected text that UTF-8 can hold", field=field)
    return value


def name(value: object, field: str, expected: str, error: type[InputError]) -> str:
    """Return a text that a page and a picture can show: not empty, and without control characters."""
    found = text(value, field, expected, error)
    if CONTROL.search(found):
        raise error(f"found {shown(found)}, expected {expected} without control characters", field=field)
    return found


def mapping(value: object, field: str, error: type[InputError]) -> Mapping[str, Any]:
    """Return a mapping with text keys: a table in TOML, an object in JSON."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise error(f"found {shown(value)}, expected a table of named fields", field=field)
    return value


def known(found: Iterable[str], names: Sequence[str], kind: str, error: type[InputError]) -> None:
    """Raise `error` for the first of `found` that is not among `names`, answered with the known ones."""
    for name in found:
        if name not in names:
            raise error(f"unknown {kind}, expected one of {', '.join(names)}{hint(name, names)}", field=name)


def hint(name: str, names: Iterable[str]) -> str:
    """Return the end of a message that asks whether another name was meant; empty if none is like it."""
    close = get_close_matches(name, list(names), n=1)
    return f", did you mean {close[0]!r}" if close else ""


def required(data: Mapping[str, Any], names: Iterable[str], error: type[InputError]) -> None:
    """Raise `error` for the first of `names` that is missing in `data`."""
    for name in names:
        if name not in data:
            raise error(f"found no such field, expected one among {', '.join(map(repr, data)) or 'none'}", field=name)
