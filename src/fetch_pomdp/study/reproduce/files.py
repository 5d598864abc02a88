"""A fit as files: the people, and a study of them with its clock."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from fetch_pomdp.errors import StudyError
from fetch_pomdp.files.writing import replaced
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people.parameters import People
from fetch_pomdp.study.reproduce.free import changed
from fetch_pomdp.study.reproduce.search import Fit
from fetch_pomdp.study.reproduce.targets import Targets

STUDY = "fitted.toml"
DIGITS = 4  # of a fitted number: more would be chance


def write_fit(targets: Targets, found: Fit, path: Path) -> tuple[Path, Path]:
    """Write the people to `path`, and a study of them beside it; only what is not as by default is in either.

    Layouts and paradigms are left to the default, which is the paper's.

    Raises StudyError for a place that cannot be written to.
    """
    study = changed(targets.study, {name: float(f"{value:.{DIGITS}g}") for name, value in found.values.items()})
    why = {free.name: free.why for free in targets.free}
    people = _lines(study.population, People(), why)
    clock = _lines(study.clock, Durations(), why)
    beside = path.with_name(STUDY)
    head = f"# Fitted to the cells of the paper: loss {found.loss:.1f} after {found.evaluations} evaluations"
    study_lines = [f"{name} = {getattr(study, name)}" for name in ("people", "trials", "seed")]
    text = [head, "", *study_lines, f"population = {json.dumps(path.name)}", "", "[clock]", *clock]
    for target, lines in ((path, [head, "", *people, ""]), (beside, [*text, ""])):
        with replaced(target, StudyError) as file:
            file.write("\n".join(lines).encode())
    return path, beside


def _lines(given: People | Durations, default: People | Durations, why: Mapping[str, str]) -> Iterable[str]:
    """Return a line for each field that is not as by default, with the reason of one that was free."""
    fields: dict[str, Any] = {field.name: getattr(given, field.name) for field in dataclasses.fields(given)}
    return [
        f"{name} = {json.dumps(value)}  # {f'fitted: {why[name]}' if name in why else 'fixed, as the targets say'}"
        for name, value in fields.items()
        if value != getattr(default, name)
    ]
