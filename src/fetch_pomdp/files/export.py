"""A scene written for other planners, in a format that the file's ending names."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from fetch_pomdp.checks import shown
from fetch_pomdp.core.discrete import Discrete
from fetch_pomdp.errors import ExportError
from fetch_pomdp.files.pomdp import DISCOUNT, pomdp_lines
from fetch_pomdp.files.pomdpx import pomdpx_lines
from fetch_pomdp.files.writing import write_new

FORMATS: Mapping[str, Callable[[Discrete, float], Iterator[str]]] = {".pomdp": pomdp_lines, ".pomdpx": pomdpx_lines}


def export(model: Discrete, path: str | Path, discount: float = DISCOUNT) -> None:
    """Write a scene to a new file, whole or not at all; its ending, .pomdp or .pomdpx, names the format.

    Raises ExportError for another ending, a file that is there already, cannot be written or would be too large;
    ModelError for a discount out of its range.
    """
    path = Path(path)
    if path.suffix not in FORMATS:
        expected = f"expected a name that ends in {' or '.join(FORMATS)}"
        raise ExportError(f"found {shown(path.suffix)}, {expected}", source=str(path))
    write_new(path, FORMATS[path.suffix](model, discount), ExportError)
