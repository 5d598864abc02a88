"""What is to be reproduced, and what a search may change for it: a file such as studies/paper.toml."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError, StudyError
from fetch_pomdp.study.configuration import study_from_mapping
from fetch_pomdp.study.design import Study
from fetch_pomdp.study.reproduce.free import MOST_FREE, Free, changed

FIELDS = ("trials", "people", "time_error", "cells", "free", "fixed", "study")


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """A cell of the paper: mean time (s), and the range of accuracies (%) that the paper leaves open."""

    layout: str
    paradigm: str
    time: float
    accuracy: tuple[float, float]
    fitted: bool  # whether a search sees it; the others are predicted

    def accuracy_off(self, accuracy: float) -> float:
        """Return how far an accuracy (%) is above the range, negative below it, 0 within."""
        low, high = self.accuracy
        return min(accuracy - low, 0.0) + max(accuracy - high, 0.0)

    def accuracy_error(self, trials: int) -> float:
        """Return the standard error (points) of an accuracy of so many trials, at the middle of the range."""
        middle = sum(self.accuracy) / 200.0
        return 100.0 * math.sqrt(middle * (1.0 - middle) / trials)


@dataclass(frozen=True, slots=True, kw_only=True)
class Targets:
    """The cells, the size of the study that they come from, and where a search starts. Raises StudyError."""

    cells: tuple[Target, ...]
    trials: int  # a cell
    people: int  # a layout
    time_error: float  # s, standard error of a cell's mean time
    free: tuple[Free, ...]
    study: Study  # with everything that a search leaves as it is

    def __post_init__(self) -> None:
        if not self.cells:
            raise StudyError("found none, expected one or more", field="cells")
        if len(self.free) > MOST_FREE:
            raise StudyError(f"found {len(self.free)}, expected at most {MOST_FREE}", field="free")
        for place, target in enumerate(self.cells):
            for name, known in (("layout", self.study.layouts), ("paradigm", self.study.paradigms)):
                if getattr(target, name) not in known:
                    found = f"found {shown(getattr(target, name))}, expected one of {', '.join(known)}"
                    raise StudyError(found, field=f"cells[{place}].{name}")

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a TOML file. Raises StudyError with file, line and field."""
        folder = Path(path).parent
        return read_toml(path, StudyError).build(lambda data: cls.from_mapping(data, folder))

    @classmethod
    def from_mapping(cls, data: Mapping[str, Any], folder: Path) -> Self:
        """Build targets from the fields of such a file in `folder`."""
        checks.known(data, FIELDS, "field", StudyError)
        checks.required(data, ("cells", "trials", "people", "time_error"), StudyError)
        return cls(
            cells=tuple(_target(row, f"cells[{place}]") for place, row in enumerate(data["cells"])),
            trials=_count(data, "trials"),
            people=_count(data, "people"),
            time_error=checks.within(data["time_error"], 1e-3, 1e3, "time_error", "seconds above 0", StudyError),
            free=tuple(_free(row, f"free[{place}]") for place, row in enumerate(data.get("free", ()))),
            study=_study(data, folder),
        )


def _study(data: Mapping[str, Any], folder: Path) -> Study:
    try:
        study = study_from_mapping(checks.mapping(data.get("study", {}), "", StudyError), folder)
    except InputError as error:
        raise error.within("study") from None
    try:
        return changed(study, checks.mapping(data.get("fixed", {}), "", StudyError))
    except InputError as error:
        raise error.within("fixed") from None


def _count(data: Mapping[str, Any], name: str) -> int:
    expected = "a whole number from 1"
    value = checks.within(data[name], 1, 1e9, name, expected, StudyError)
    if value != int(value):
        raise StudyError(f"found {shown(data[name])}, expected {expected}", field=name)
    return int(value)


def _target(row: object, path: str) -> Target:
    try:
        data = checks.mapping(row, "", StudyError)
        checks.known(data, ("layout", "paradigm", "time", "accuracy", "fitted"), "field", StudyError)
        checks.required(data, ("layout", "paradigm", "time", "accuracy", "fitted"), StudyError)
        if not isinstance(data["fitted"], bool):
            raise StudyError(f"found {shown(data['fitted'])}, expected true or false", field="fitted")
        return Target(
            layout=checks.text(data["layout"], "layout", "a layout's name", StudyError),
            paradigm=checks.text(data["paradigm"], "paradigm", "a paradigm's name", StudyError),
            time=checks.within(data["time"], 0.0, 1e4, "time", "seconds from 0", StudyError),
            accuracy=_range(data["accuracy"]),
            fitted=data["fitted"],
        )
    except InputError as error:
        raise error.within(path) from None


def _range(value: object) -> tuple[float, float]:
    expected = "[low, high] in %, from 0 to 100"
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise StudyError(f"found {shown(value)}, expected {expected}", field="accuracy")
    low, high = (checks.within(part, 0.0, 100.0, "accuracy", expected, StudyError) for part in value)
    if low > high:
        raise StudyError(f"found {shown(value)}, expected {expected}", field="accuracy")
    return low, high


def _free(row: object, path: str) -> Free:
    try:
        data = checks.mapping(row, "", StudyError)
        checks.known(data, ("name", "low", "high", "start", "why"), "field", StudyError)
        checks.required(data, ("name", "low", "high", "start", "why"), StudyError)
        return Free(**data)
    except InputError as error:
        raise error.within(path) from None
