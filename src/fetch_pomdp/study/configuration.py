"""A study's configuration as a TOML file (docs/study.md), and as the plain data that tells two studies apart."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError, StudyError
from fetch_pomdp.files.models import changed
from fetch_pomdp.study.design import Paradigm, Study
from fetch_pomdp.study.durations import Durations
from fetch_pomdp.study.people.parameters import People

Read = TypeVar("Read")

PLAIN = ("people", "trials", "seed", "logs", "real_speech", "reader")
FIELDS = (*PLAIN, "layouts", "paradigms", "model", "rewards", "population", "clock")


def load_study(path: str | Path) -> Study:
    """Read a study from a TOML file; whatever is missing is as in the paper.

    Paths in the file start at its own folder. Raises InputError with file, line and field.
    """
    folder = Path(path).parent
    return read_toml(path, StudyError).build(lambda data: study_from_mapping(data, folder))


def study_from_mapping(
    data: Mapping[str, Any], folder: Path, load: Callable[[str | Path], Scene] = Scene.load
) -> Study:
    """Build a study from the fields of a file in `folder`; load: makes a scene of a name or path."""
    checks.known(data, FIELDS, "field", StudyError)
    fields: dict[str, Any] = {name: data[name] for name in PLAIN if name in data}
    layouts = _layouts(data.get("layouts", list(LAYOUTS)), folder, load)
    fields["layouts"] = {name: changed(scene, data, StudyError) for name, scene in layouts.items()}
    if "paradigms" in data:
        table = checks.mapping(data["paradigms"], "paradigms", StudyError)
        fields["paradigms"] = {name: _paradigm(value, f"paradigms.{name}") for name, value in table.items()}
    if "population" in data:
        path = folder / checks.text(data["population"], "population", "the path of a TOML file", StudyError)
        fields["population"] = _elsewhere("population", lambda: People.load(path))
    if "clock" in data:
        fields["clock"] = _clock(checks.mapping(data["clock"], "clock", StudyError))
    return Study(**fields)


def _layouts(value: object, folder: Path, load: Callable[[str | Path], Scene]) -> dict[str, Scene]:
    if not isinstance(value, list | tuple):
        raise StudyError(f"found {shown(value)}, expected a list of names and of paths of TOML files", field="layouts")
    layouts: dict[str, Scene] = {}
    for entry in value:
        given = checks.text(entry, "layouts", "the name of a layout or the path of a TOML file", StudyError)
        name = Path(given).stem
        if name in layouts:
            raise StudyError(f"found {name!r} twice, expected layouts of different names", field="layouts")
        source = given if given in LAYOUTS else folder / given
        layouts[name] = _elsewhere("layouts", lambda source=source: load(source))  # type: ignore[misc]
    return layouts


def _paradigm(value: object, path: str) -> Paradigm:
    try:
        fields = {"planner": value} if isinstance(value, str) else dict(checks.mapping(value, "", StudyError))
        checks.required(fields, ("planner",), StudyError)
        planner = checks.text(fields.pop("planner"), "planner", "a planner's name", StudyError)
        changes = {
            name: checks.mapping(fields.pop(name), name, StudyError) for name in ("model", "rewards") if name in fields
        }
        return Paradigm(planner=planner, parameters=fields, **changes)
    except InputError as error:
        raise error.within(path) from None


def _clock(data: Mapping[str, Any]) -> Durations:
    try:
        checks.known(data, [field.name for field in dataclasses.fields(Durations)], "time", StudyError)
        return Durations(**{name: checks.within(value, 0.0, 1e3, name, "seconds, from 0 to 1000", StudyError)
                        for name, value in data.items()})  # fmt: skip
    except InputError as error:
        raise error.within("clock") from None


def _elsewhere(field: str, read: Callable[[], Read]) -> Read:
    """Return what another file holds; a complaint about it keeps its own place, after that of the field naming it."""
    try:
        return read()
    except InputError as error:
        raise StudyError(str(error), field=field) from None


def to_plain(study: Study) -> dict[str, Any]:
    """Return all that a study's trials depend on as plain data, in the form that JSON gives back."""
    fields = dataclasses.asdict(study)
    for fields_of, name, unset in (
        (fields, "reader", Study.__dataclass_fields__["reader"].default),
        (fields["population"], "grammar", People.__dataclass_fields__["grammar"].default),
        (fields["population"], "p_unknown", People.__dataclass_fields__["p_unknown"].default),
    ):
        if fields_of[name] == unset:  # without it, a study is what it was before there was any
            del fields_of[name]
    for name, scene in study.layouts.items():
        layout = fields["layouts"][name]
        del layout["answers"]
        if answers := scene.answers.to_mapping():  # without any, a study is what it was before there were any
            layout["answers"] = answers
        for fields_of, unset in (
            (layout["model"], "turns"),
            (layout, "robot"),
            *((item, "facing") for item in layout["items"]),
        ):
            if fields_of[unset] is None:  # likewise
                del fields_of[unset]
    plain: dict[str, Any] = json.loads(json.dumps(fields))
    return plain


def digest(plain: Mapping[str, Any]) -> str:
    """Return a short text that is the same for the same plain data in the same order, and for no other."""
    return hashlib.sha256(json.dumps(plain).encode()).hexdigest()[:16]


def difference(there: object, here: object, path: str = "") -> str | None:
    """Return where two pieces of plain data differ first, and how; None if they do not."""
    if isinstance(there, dict) and isinstance(here, dict):
        for name in dict.fromkeys([*here, *there]):
            inner = difference(there.get(name), here.get(name), f"{path}.{name}" if path else name)
            if inner is not None:
                return inner
        return None if list(there) == list(here) else f"{path} in another order"
    return None if there == here else f"{path} {shown(there)}, not {shown(here)}"
