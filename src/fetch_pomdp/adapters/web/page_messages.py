"""What a page sends to the server: JSON texts over a WebSocket, and sound as binary frames.

A page says hello, and from then on what its person types and where they point. Every message has a `type`; an unknown
field is refused, so that a misspelt one is noticed.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from fetch_pomdp import checks
from fetch_pomdp.checks import Point3, shown
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.language.names import named
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.live.person import live_scene, live_scene_from
from fetch_pomdp.core.planners.catalogue import DEFAULT, PLANNERS
from fetch_pomdp.core.scene import Scene
from fetch_pomdp.documents import parse_toml, read_text
from fetch_pomdp.errors import MessageError, SceneError
from fetch_pomdp.files.header import Header

VERSION = 1
LARGEST_MESSAGE = 65_536  # bytes, of text or sound
LONGEST_TEXT = 300  # characters in a line
MOST_ITEMS = 40  # a planner solves so many in a second or two
SIGMAS = (0.02, 0.3)  # rad, of a calibrated camera: nobody's arm is surer, and with a less sure one the mouse is used


@dataclass(frozen=True, slots=True, kw_only=True)
class Hello:
    """The first message: what the page may do (`token`), whom it belongs to, and which interaction it wants.

    choices: the fields `scene`, `sigma`, `planner` and `seed` as they were sent. Reading a scene is work, which is done
    for those who may come in and have a seat (`header_of`).
    participant: the secret of a participant of a study; it means nothing on a server without a study.
    """

    choices: Mapping[str, Any]
    resume: str | None
    participant: str | None
    token: str | None


@dataclass(frozen=True, slots=True)
class Typed:
    """The person has typed a line; the robot hears it as if it were spoken."""

    text: str


@dataclass(frozen=True, slots=True)
class Typing:
    """The person is typing; the text so far, empty if they have deleted it."""

    text: str


@dataclass(frozen=True, slots=True)
class Pointed:
    """The person points now, from head through wrist (m)."""

    head: Point3
    wrist: Point3


@dataclass(frozen=True, slots=True)
class Microphone:
    """The page starts or stops sending sound."""

    on: bool


PageMessage: TypeAlias = Hello | Typed | Typing | Pointed | Microphone
# For each type of message: its fields, and the function that reads them.
Readers: TypeAlias = Mapping[str, tuple[Sequence[str], Callable[[Mapping[str, Any]], Any]]]


def read_page_message(text: str) -> PageMessage:
    """Read a message of a page. Raises MessageError, naming the field, if it is invalid."""
    message: PageMessage = read_message(text, {"hello": _HELLO, **TALK})
    return message


def read_message(text: str, readers: Readers) -> Any:
    """Read a message of one of the types of `readers`. Raises MessageError, naming the field, if it is invalid."""
    if len(text.encode("utf-8", "surrogatepass")) > LARGEST_MESSAGE:
        raise MessageError(f"message too large, expected at most {LARGEST_MESSAGE} bytes")
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        raise MessageError("invalid JSON, expected a JSON object") from None
    fields = dict(checks.mapping(data, "", MessageError))
    kind = fields.pop("type", None)
    if not isinstance(kind, str) or kind not in readers:
        raise MessageError(f"found {shown(kind)}, expected one of {', '.join(readers)}", field="type")
    names, read = readers[kind]
    checks.known(fields, names, "field", MessageError)
    return read(fields)


def _hello(data: Mapping[str, Any]) -> Hello:
    if type(data.get("version")) is not int or data["version"] != VERSION:
        raise MessageError(f"found {shown(data.get('version'))}, expected {VERSION}", field="version")
    secrets = {field: _optional_text(data.get(field), field) for field in ("resume", "participant", "token")}
    return Hello(choices={field: data[field] for field in CHOICES if field in data}, **secrets)


def header_of(hello: Hello) -> Header:
    """Return the interaction that a page wants. Raises MessageError or SceneError, naming the field.

    The scene's model has the spread of pointing (`sigma`, rad) to which the page's camera was calibrated, if it was.
    """
    data = hello.choices
    planner, seed = data.get("planner", DEFAULT), data.get("seed", 0)
    if not isinstance(planner, str) or planner not in PLANNERS:
        raise MessageError(f"found {shown(planner)}, expected one of {', '.join(PLANNERS)}", field="planner")
    if type(seed) is not int or not 0 <= seed < 2**53:
        raise MessageError(f"found {shown(seed)}, expected a whole number from 0", field="seed")
    sigma = data.get("sigma")
    if sigma is not None:
        expected = f"an angle from {SIGMAS[0]} to {SIGMAS[1]} rad"
        sigma = checks.within(sigma, *SIGMAS, "sigma", expected, MessageError)
    scene, name = _scene(data.get("scene", "ambiguous"))
    if sigma is not None:
        scene = dataclasses.replace(scene, model=dataclasses.replace(scene.model, sigma=sigma))
    return Header(scene=scene, scene_name=name, planner=planner, seed=seed)


def _scene(value: object) -> tuple[Scene, str | None]:
    """Read a built-in scene's name, or {"toml": the text of a scene file}."""
    if isinstance(value, str):
        if value not in LAYOUTS:
            raise MessageError(f"found {shown(value)}, expected one of {', '.join(LAYOUTS)}", field="scene")
        return named(live_scene(value)), value
    data = checks.mapping(value, "scene", MessageError)
    checks.known(data, ("toml",), "field", MessageError)
    checks.required(data, ("toml",), MessageError)
    text = checks.text(data["toml"], "scene.toml", "the text of a scene file", MessageError)
    scene = parse_toml(text, "table", SceneError).build(live_scene_from)
    if len(scene.items) > MOST_ITEMS:
        raise SceneError(f"found {len(scene.items)}, expected at most {MOST_ITEMS}", field="items", source="table")
    return named(scene), None


def scene_asked_for(name_or_path: str) -> str | dict[str, str]:
    """Return the `scene` field of a hello for a built-in scene, or for one in a TOML file.

    Raises SceneError or ModelError, with file, line and field, for an invalid scene or one too large for a page.
    """
    scene = Scene.load(name_or_path)
    if name_or_path in LAYOUTS:
        return name_or_path
    if len(scene.items) > MOST_ITEMS:
        raise SceneError(f"found {len(scene.items)}, expected at most {MOST_ITEMS}", field="items", source=name_or_path)
    text = read_text(name_or_path, SceneError)
    if len(json.dumps(text).encode()) > LARGEST_MESSAGE // 2:
        raise SceneError(
            f"file too large for a page, expected at most {LARGEST_MESSAGE // 2} bytes", source=name_or_path
        )
    return {"toml": text}


def _optional_text(value: object, field: str) -> str | None:
    if value is None:
        return None
    text = checks.text(value, field, "a text or null", MessageError)
    if len(text) > LONGEST_TEXT:
        raise MessageError(f"found {len(text)} characters, expected at most {LONGEST_TEXT}", field=field)
    return text


def _typed(data: Mapping[str, Any]) -> Typed:
    return Typed(_required_text(data))


def _typing(data: Mapping[str, Any]) -> Typing:
    return Typing(_required_text(data))


def _required_text(data: Mapping[str, Any]) -> str:
    text = _optional_text(data.get("text"), "text")
    if text is None:
        raise MessageError("missing, expected what was typed", field="text")
    return text


def _pointed(data: Mapping[str, Any]) -> Pointed:
    checks.required(data, ("head", "wrist"), MessageError)
    ray = Ray(data["head"], data["wrist"])
    return Pointed(ray.head, ray.wrist)


def _microphone(data: Mapping[str, Any]) -> Microphone:
    if type(data.get("on")) is not bool:
        raise MessageError(f"found {shown(data.get('on'))}, expected true or false", field="on")
    return Microphone(data["on"])


CHOICES = ("scene", "sigma", "planner", "seed")
_HELLO = (("version", *CHOICES, "resume", "participant", "token"), _hello)
TALK: Readers = {  # what a person says and shows to the robot
    "typed": (("text",), _typed),
    "typing": (("text",), _typing),
    "ray": (("head", "wrist"), _pointed),
    "microphone": (("on",), _microphone),
}
