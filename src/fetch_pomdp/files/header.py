"""The first line of a recorded interaction: what it is about."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.checks import shown
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.names import named
from fetch_pomdp.core.language.reading.catalogue import WORDS, recorded_reader
from fetch_pomdp.core.language.reading.reader import Reader
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.planners.catalogue import DEFAULT, planner_named
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.errors import EventError, InputError, SceneError
from fetch_pomdp.files.events import item_index
from fetch_pomdp.files.models import changed

VERSION = 4
READ = (1, 2, 3, VERSION)
FIELDS = ("scene", "model", "rewards", "version", "planner", "seed", "target", "names")
READER = "reader"  # from version 4 on; before, words were read as in the paper
STUDY_FIELDS = ("person", "layout", "paradigm", "order", "begun")  # from version 2 on


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """What an interaction is about: the first line of its record.

    The last five fields say which trial of a study it was (`study.trial.Assignment`), where it was one.
    """

    scene: Scene  # with the model and rewards in force
    scene_name: str | None = None  # of a built-in scene
    planner: str = DEFAULT
    parameters: Mapping[str, Any] = field(default_factory=dict)  # of the planner
    seed: int = 0
    reader: str = WORDS  # what read the words, by its name (`reading.catalogue`)
    target: str | None = None  # id of the item that was desired, where that is known
    person: int | None = None
    layout: str | None = None
    paradigm: str | None = None  # how the robot decided, by its name in the study
    order: int | None = None  # place among the person's trials, from 0
    begun: float | None = None  # s, when the request began

    def agent(
        self,
        *,
        planner: str | None = None,
        seed: int | None = None,
        reader: Reader | None = None,
        **parameters: Any,
    ) -> Agent:
        """Return an agent at the start of this interaction; what is given replaces what was recorded.

        reader: that of a name that is none of ours; without it our grammar reads what is not on record.
        """
        given = {name: value for name, value in parameters.items() if value is not None}
        changed = planner is not None and planner != self.planner
        merged = given if changed else {**self.parameters, **given}
        chosen = planner_named(self.planner if planner is None else planner, **merged)
        reads = recorded_reader(self.reader) if reader is None else reader
        return Agent(self.scene, chosen, seed=self.seed if seed is None else seed, reader=reads)


def header_from_json(data: Mapping[str, Any]) -> Header:
    """Build a header from the fields of a first line."""
    version = data.get("version", VERSION)
    if type(version) is not int or version not in READ:
        raise EventError(f"found {shown(version)}, expected one of {', '.join(map(str, READ))}", field="version")
    fields = FIELDS + (STUDY_FIELDS if version > 1 else ()) + ((READER,) if version > 3 else ())
    checks.known(data, fields, "field", EventError)
    checks.required(data, ("scene",), EventError)
    scene = _scene(data["scene"])
    if _names(data.get("names", False)):
        scene = named(scene)
    scene = changed(scene, data, EventError)
    planner, parameters = _planner(data.get("planner", DEFAULT))
    target = data.get("target")
    if target is not None:
        item_index(target, scene, "target")
    return Header(
        scene=scene,
        scene_name=data["scene"] if isinstance(data["scene"], str) else None,
        planner=planner,
        parameters=parameters,
        seed=_whole(data.get("seed", 0), "seed"),
        reader=_reader(data.get(READER, WORDS)),
        target=target,
        **_trial(data),
    )


def _trial(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that say which trial of a study it was."""
    found = {name: data[name] for name in STUDY_FIELDS if data.get(name) is not None}
    for name, value in found.items():
        if name in {"person", "order"}:
            _whole(value, name)
        elif name == "begun":
            found[name] = checks.number(value, name, "a time in seconds", EventError)
        else:
            checks.text(value, name, "a name that is not empty", EventError)
    return found


def _whole(value: object, field: str) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < 2**63:
        raise EventError(f"found {shown(value)}, expected a whole number from 0", field=field)
    return value


def _scene(value: object) -> Scene:
    if isinstance(value, str):
        if value not in LAYOUTS:
            expected = f"expected one of {', '.join(LAYOUTS)}, or an object with head and items"
            raise EventError(f"found {shown(value)}, {expected}", field="scene")
        return Scene.load(value)
    try:
        data = checks.mapping(value, "", EventError)
        checks.known(data, ("head", "items", "answers", "robot"), "field", SceneError)
        return Scene.from_mapping(data)
    except InputError as error:
        raise error.within("scene") from None


def _reader(value: object) -> str:
    name = checks.text(value, READER, "a reader's name", EventError)
    recorded_reader(name)
    return name


def _names(value: object) -> bool:
    if not isinstance(value, bool):
        raise EventError(f"found {shown(value)}, expected true or false", field="names")
    return value


def _planner(value: object) -> tuple[str, dict[str, Any]]:
    fields = {"name": value} if isinstance(value, str) else dict(checks.mapping(value, "planner", EventError))
    name = fields.pop("name", DEFAULT)
    try:
        planner_named(checks.text(name, "", "a planner's name", EventError), **fields)
    except InputError as error:
        raise error if error.field == "planner" else error.within("planner") from None
    return name, fields


def header_to_json(header: Header) -> dict[str, Any]:
    """Return the fields of a header's line; whatever is as it is by default is left out."""
    scene = header.scene
    plain = Scene(items=scene.items, head=scene.head)
    fields: dict[str, Any] = {"scene": header.scene_name or scene.to_mapping(), "version": VERSION}
    if header.scene_name is not None and scene.items != Scene.load(header.scene_name).items:
        fields["names"] = True
    for section in ("model", "rewards"):
        values, defaults = dataclasses.asdict(getattr(scene, section)), dataclasses.asdict(getattr(plain, section))
        if changes := {name: value for name, value in values.items() if value != defaults[name]}:
            fields[section] = changes
    fields["planner"] = {"name": header.planner, **header.parameters} if header.parameters else header.planner
    fields["seed"] = header.seed
    if header.reader != WORDS:
        fields[READER] = header.reader
    trial = {name: getattr(header, name) for name in ("target", *STUDY_FIELDS)}
    return fields | {name: value for name, value in trial.items() if value is not None}
