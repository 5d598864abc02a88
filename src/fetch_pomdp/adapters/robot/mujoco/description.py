"""A robot as a description file names it: where its model is, its arms, its gripper, and how fast it moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Self

from fetch_pomdp import checks
from fetch_pomdp.checks import Point3
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError, MissingExtraError, RobotDescriptionError

HERE = Path(__file__).parent
KNOWN = ("baxter", "ur5e")
Rotation = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """A position servo of the gripper, at a joint or a tendon; units are those of what it moves (m and N, or rad and
    N m).
    """

    open: float
    closed: float
    stiffness: float
    damping: float
    force: float
    joint: str | None = None
    tendon: str | None = None
    armature: float | None = None  # kg or kg m^2, in place of the model's
    friction: float | None = None  # N or N m, in place of the model's


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """A solid box, added to a body of the model."""

    body: str
    low: Point3  # m, its corners in the body's frame
    high: Point3


@dataclass(frozen=True, slots=True, kw_only=True)
class Gripper:
    """Two fingers that close along a line."""

    model: str  # the file, in the package
    root: str  # the body that is mounted
    tcp: Point3  # m, between the fingertips, in the root's frame, whose z axis is the way the hand looks
    closing: Point3  # unit vector in the root's frame
    depth: float  # m, of the fingertips beyond the tcp, also when they close
    opening: float  # m, between the open fingers
    time: float  # s, to close or to open
    drives: tuple[Drive, ...]
    shift: Mapping[str, Point3]  # m, by which bodies of the model are moved


@dataclass(frozen=True, slots=True, kw_only=True)
class Arm:
    """One arm: its joints from the shoulder on."""

    name: str
    joints: tuple[str, ...]
    home: tuple[float, ...]  # rad, where it rests
    stiffness: tuple[float, ...]  # N m/rad, of its position servos
    torque: tuple[float, ...]  # N m, what its motors give at most
    shoulder: str  # a body that does not move with the elbow
    hand: str  # the body that carries the gripper
    mount: Point3 = (0.0, 0.0, 0.0)  # m, of the gripper in the hand's frame
    mount_rotation: Rotation = (1.0, 0.0, 0.0, 0.0)  # quaternion, w first


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredDurations:
    """Measured times, s, medians over random tables (benchmarks/robot.py)."""

    point: float  # from rest to pointing at an item


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotDescription:
    """A robot with one arm or more, all with the same gripper."""

    name: str
    package: str  # the Python package that ships the model
    install: str  # the line that installs it
    model: str  # the file, in the package
    root: str  # the model's outermost body
    height: float  # m, of the root above the floor
    table_distance: float  # m, from the root to the middle of the items, along the floor
    speed: float  # rad/s, of the fastest joint
    gripper: Gripper
    arms: tuple[Arm, ...]
    durations: MeasuredDurations
    without: tuple[str, ...] = ()  # geoms of the model that are left out
    boxes: tuple[Box, ...] = ()  # what stands in for them

    @classmethod
    def load(cls, name_or_path: str | Path) -> Self:
        """Return a built-in robot by name (baxter, ur5e) or read one from a TOML file.

        Raises RobotDescriptionError, with file, line and field, for what describes no robot.
        """
        path = Path(name_or_path)
        if str(name_or_path) in KNOWN:
            path = HERE / f"{name_or_path}.toml"
        elif not path.suffix:
            expected = f"expected one of {', '.join(KNOWN)}, or a TOML file{checks.hint(path.name, KNOWN)}"
            raise RobotDescriptionError(f"found no such robot, {expected}", source=str(path))
        return read_toml(path, RobotDescriptionError).build(cls.from_mapping)

    @classmethod
    def from_mapping(cls, data: Mapping[str, Any]) -> Self:
        """Build a robot from the fields of a description file."""
        values = _fields(cls, data)
        gripper = _within("gripper", _gripper, values["gripper"])
        arms = tuple(_within(f"arms[{index}]", _arm, fields) for index, fields in enumerate(values["arms"]))
        boxes = tuple(_within(f"boxes[{index}]", _box, fields) for index, fields in enumerate(values.get("boxes", ())))
        if not arms:
            raise RobotDescriptionError("found no arms, expected one or more", field="arms")
        durations = _within(
            "durations", lambda fields: MeasuredDurations(**_fields(MeasuredDurations, fields)), values["durations"]
        )
        return cls(**{**values, "durations": durations, "gripper": gripper, "arms": arms, "boxes": boxes})

    def file(self, path: str) -> Path:
        """Return where a file of the package is. Raises MissingExtraError, with the line that installs the package."""
        spec = find_spec(self.package)
        if spec is None or not spec.submodule_search_locations:
            line = (
                f"{self.package}, which has the model of {self.name}, is not installed; install it with: {self.install}"
            )
            raise MissingExtraError(line)
        return Path(spec.submodule_search_locations[0]) / path


def _gripper(data: Mapping[str, Any]) -> Gripper:
    values = _fields(Gripper, {"shift": {}, **data})
    drives = tuple(_within(f"drives[{index}]", _drive, fields) for index, fields in enumerate(values["drives"]))
    shift = checks.mapping(values["shift"], "shift", RobotDescriptionError)
    moved = {body: checks.point(by, f"shift.{body}", RobotDescriptionError) for body, by in shift.items()}
    return Gripper(**{**values, "drives": drives, "shift": moved})


def _drive(data: Mapping[str, Any]) -> Drive:
    drive = Drive(**_fields(Drive, data))
    if (drive.joint is None) == (drive.tendon is None):
        raise RobotDescriptionError("expected either a joint or a tendon", field="joint")
    return drive


def _box(data: Mapping[str, Any]) -> Box:
    return Box(**_fields(Box, data))


def _arm(data: Mapping[str, Any]) -> Arm:
    arm = Arm(**_fields(Arm, data))
    for name in ("home", "stiffness", "torque"):
        if len(getattr(arm, name)) != len(arm.joints):
            found = f"found {len(getattr(arm, name))} numbers, expected one a joint, {len(arm.joints)}"
            raise RobotDescriptionError(found, field=name)
    return arm


def _fields(cls: type, data: object) -> dict[str, Any]:
    """Return the fields of a dataclass from a table, each checked by its type."""
    table = checks.mapping(data, "", RobotDescriptionError)
    known = {field.name: field for field in fields(cls)}
    checks.known(table, tuple(known), "field", RobotDescriptionError)
    required = [name for name, field in known.items() if field.default is MISSING]
    checks.required(table, required, RobotDescriptionError)
    return {name: _checked(value, str(known[name].type), name) for name, value in table.items()}


def _checked(value: object, kind: str, name: str) -> object:
    """Return a field's value if it is of the type that the dataclass writes beside it."""
    if kind.startswith("float"):
        return checks.number(value, name, "a finite number", RobotDescriptionError)
    if kind.startswith("str"):
        return checks.text(value, name, "a name that is not empty", RobotDescriptionError)
    if kind == "Point3":
        return checks.point(value, name, RobotDescriptionError)
    if kind.startswith(("tuple", "Rotation")):
        if not isinstance(value, list | tuple):
            raise RobotDescriptionError(f"found {checks.shown(value)}, expected a list", field=name)
        if "float" in kind or kind == "Rotation":
            return tuple(checks.number(part, name, "finite numbers", RobotDescriptionError) for part in value)
        return tuple(value)
    return value


def _within(path: str, make: Any, data: object) -> Any:
    try:
        return make(data)
    except InputError as error:
        raise error.within(path) from None
