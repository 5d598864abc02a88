"""A scene written for other planners, in a format that the file's ending names."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

from fetch_pomdp.checks import shown
from fetch_pomdp.core.discrete import Discrete
from fetch_pomdp.errors import ExportError
from fetch_pomdp.files.pomdp import DISCOUNT, pomdp_lines
from fetch_pomdp.files.pomdpx import pomdpx_lines

FORMATS: Mapping[str, Callable[[Discrete, float], Iterator[str]]] = {".pomdp": pomdp_lines, ".pomdpx": pomdpx_lines}


def export(model: Discrete, path: str | Path, discount: float = DISCOUNT) -> None:
    """Write a scene to a new file, whole or not at all; its ending, .pomdp or .pomdpx, names the format.

    Raises ExportError for another ending, a file that is there already, cannot be written or would be too large;
    ModelError for a discount that is none.
    """
    path = Path(path)
    if path.suffix not in FORMATS:
        expected = f"expected a name that ends in {' or '.join(FORMATS)}"
        raise ExportError(f"found {shown(path.suffix)}, {expected}", source=str(path))
    lines = FORMATS[path.suffix](model, discount)
    try:
        _write_new(path, lines)
    except FileExistsError:
        raise ExportError("found a file there already, expected a new one", source=str(path)) from None
    except (OSError, ValueError) as cause:
        reason = getattr(cause, "strerror", None) or cause
        raise ExportError(f"cannot be written: {reason}, expected a folder for it", source=str(path)) from None


def _write_new(path: Path, lines: Iterable[str]) -> None:
    """Write lines beside the file, then give them its name. Raises FileExistsError if there is a file of that name."""
    if os.path.lexists(path):
        raise FileExistsError
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with part.open("x", encoding="ascii", newline="\n") as stream:
            stream.writelines(f"{line}\n" for line in lines)
        _rename(part, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            part.unlink()


def _rename(part: Path, path: Path) -> None:
    try:
        path.hardlink_to(part)  # unlike a renaming it never replaces a file that came in the meantime
    except FileExistsError:
        raise
    except OSError:  # a file system without links
        part.rename(path)
