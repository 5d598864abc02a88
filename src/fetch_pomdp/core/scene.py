"""What stands on the table: items with their places and words, and the person's head."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from fetch_pomdp import checks
from fetch_pomdp.checks import Point3
from fetch_pomdp.core.language.phrases import Answers
from fetch_pomdp.core.language.words import RESPONSES, tokenize
from fetch_pomdp.core.layouts import LAYOUTS
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.documents import read_toml
from fetch_pomdp.errors import InputError, SceneError


@dataclass(frozen=True, slots=True, kw_only=True)
class Item:
    """An item of Section III-B. Raises SceneError for a field that cannot be one."""

    id: str
    position: Point3  # m
    vocabulary: tuple[str, ...]  # the words that may refer to it, lower case
    facing: tuple[float, float] | None = None  # horizontal direction of its front, if it has one

    def __post_init__(self) -> None:
        checks.text(self.id, "id", "a name that is not empty", SceneError)
        object.__setattr__(self, "position", checks.point(self.position, "position", SceneError))
        if self.facing is not None:
            object.__setattr__(self, "facing", _direction(self.facing))
        words = self.vocabulary
        if isinstance(words, str) or not isinstance(words, list | tuple) or not words:
            raise SceneError(f"found {checks.shown(words)}, expected a list of one word or more", field="vocabulary")
        checked = [_vocabulary_word(word, f"vocabulary[{index}]") for index, word in enumerate(words)]
        object.__setattr__(self, "vocabulary", tuple(dict.fromkeys(checked)))

    def to_mapping(self) -> dict[str, Any]:
        """Return the item as plain data, in the form of a scene file."""
        plain = {"id": self.id, "position": list(self.position), "vocabulary": list(self.vocabulary)}
        return plain if self.facing is None else plain | {"facing": list(self.facing)}


def _direction(value: object) -> tuple[float, float]:
    expected = "a horizontal direction: two numbers, not both 0"
    if isinstance(value, str) or not isinstance(value, list | tuple) or len(value) != 2:
        raise SceneError(f"found {checks.shown(value)}, expected {expected}", field="facing")
    x, y = (checks.number(each, "facing", expected, SceneError) for each in value)
    if x == y == 0.0:
        raise SceneError(f"found {checks.shown(value)}, expected {expected}", field="facing")
    return x, y


def _vocabulary_word(value: object, path: str) -> str:
    word = checks.text(value, path, "a word", SceneError)
    tokens = tokenize(word)
    if tokens != (word.strip().lower(),):
        raise SceneError(f"found {checks.shown(word)}, expected a single word without punctuation", field=path)
    if tokens[0] in RESPONSES:
        raise SceneError(f"found {word!r}, expected a word that is no answer to a question", field=path)
    return tokens[0]


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """The items of a table, the head of the person before it, and the model measured there.

    Raises SceneError for no items, ids used twice, an item in the middle of the head, or a field of another type.
    """

    items: tuple[Item, ...]
    head: Point3  # m, where the person's head is
    model: Model = field(default_factory=Model)
    rewards: Rewards = field(default_factory=Rewards)
    answers: Answers = field(default_factory=Answers)  # what is understood as an answer here, beside what is everywhere
    robot: Point3 | None = None  # m, where the robot looks from; None: from across the table

    def __post_init__(self) -> None:
        object.__setattr__(self, "items", _items(self.items))
        object.__setattr__(self, "head", checks.point(self.head, "head", SceneError))
        if self.robot is not None:
            object.__setattr__(self, "robot", checks.point(self.robot, "robot", SceneError))
        for name, kind in (("model", Model), ("rewards", Rewards)):
            if not isinstance(getattr(self, name), kind):
                found = f"found {checks.shown(getattr(self, name))}, expected {kind.__name__}(...)"
                raise SceneError(found, field=name)
        seen: dict[str, int] = {}
        for index, item in enumerate(self.items):
            if item.id in seen:
                found = f"found {item.id!r}, which items[{seen[item.id]}] has, expected an id of its own"
                raise SceneError(found, field=f"items[{index}].id")
            if item.position == self.head:
                found = "found the position of the head, expected one that can be pointed at"
                raise SceneError(found, field=f"items[{index}].position")
            seen[item.id] = index

    @property
    def words(self) -> tuple[str, ...]:
        """All words of all items, sorted: the "words" of Eq. 5."""
        return tuple(sorted({word for item in self.items for word in item.vocabulary}))

    def index(self, id: str, field: str = "item") -> int:
        """Return the index of the item with this id. Raises SceneError, with the known ids, if there is none."""
        for index, item in enumerate(self.items):
            if item.id == id:
                return index
        names = [item.id for item in self.items[:20]]
        more = "" if len(names) == len(self.items) else f" and {len(self.items) - len(names)} more"
        raise SceneError(f"found {checks.shown(id)}, expected one of {', '.join(names)}{more}", field=field)

    @classmethod
    def load(cls, name_or_path: str | Path, model: Model | None = None) -> Self:
        """Return a built-in scene by name (ambiguous, unambiguous) or read one from a TOML file.

        model: what holds where the file does not say; the paper's unless given.

        Raises SceneError or ModelError, with file, line and field, for what is not a scene.
        """
        if not isinstance(name_or_path, str | os.PathLike):
            found = f"found {checks.shown(name_or_path)}, expected a Scene, its name, or the path of a TOML file"
            raise SceneError(found, field="scene")
        if str(name_or_path) in LAYOUTS:
            return cls.from_mapping(LAYOUTS[str(name_or_path)], model)
        path = Path(name_or_path)
        if not path.suffix and not _exists(path):
            expected = f"expected one of {', '.join(LAYOUTS)}, or a TOML file{checks.hint(path.name, LAYOUTS)}"
            raise SceneError(f"found no such scene or file, {expected}", source=str(path))
        return read_toml(path, SceneError).build(lambda data: cls.from_mapping(data, model))

    @classmethod
    def from_mapping(cls, data: Mapping[str, Any], model: Model | None = None) -> Self:
        """Build a scene from the fields of a scene file: head, items, and optionally model, rewards and answers.

        model: what holds where the fields do not say; the paper's unless given.
        """
        checks.known(data, ("head", "items", "model", "rewards", "answers", "robot"), "field", SceneError)
        checks.required(data, ("head", "items"), SceneError)
        if not isinstance(data["items"], list | tuple):
            found = checks.shown(data["items"])
            raise SceneError(f"found {found}, expected [[items]] tables, one an item", field="items")
        items = tuple(_item(fields, f"items[{index}]") for index, fields in enumerate(data["items"]))
        try:
            section = "model"
            model = (model or Model()).with_changes(checks.mapping(data.get("model", {}), "", SceneError))
            section = "rewards"
            rewards = Rewards().with_changes(checks.mapping(data.get("rewards", {}), "", SceneError))
            section = "answers"
            answers = Answers.from_mapping(checks.mapping(data.get("answers", {}), "", SceneError))
        except InputError as error:
            raise error.within(section) from None
        robot = data.get("robot")
        return cls(items=items, head=data["head"], model=model, rewards=rewards, answers=answers, robot=robot)

    def to_mapping(self) -> dict[str, Any]:
        """Return the head, the items and the answers that it adds as plain data, in the form of a scene file."""
        items = [item.to_mapping() for item in self.items]
        answers = self.answers.to_mapping()
        robot = {} if self.robot is None else {"robot": list(self.robot)}
        return {"head": list(self.head), "items": items} | robot | ({"answers": answers} if answers else {})


def _items(given: object) -> tuple[Item, ...]:
    items = tuple(given) if isinstance(given, Iterable) else (given,)
    for index, item in enumerate(items):
        if not isinstance(item, Item):
            raise SceneError(f"found {checks.shown(item)}, expected Item(...)", field=f"items[{index}]")
    if not items:
        raise SceneError("found no items, expected one or more", field="items")
    return items


def _exists(path: Path) -> bool:
    try:
        return os.path.exists(path)  # noqa: PTH110 (Path.exists raises for a name that is too long)
    except ValueError:  # a NUL in it, before Python 3.12
        return False


def _item(fields: object, path: str) -> Item:
    try:
        data = checks.mapping(fields, "", SceneError)
        checks.known(data, ("id", "position", "vocabulary", "facing"), "field", SceneError)
        checks.required(data, ("id", "position", "vocabulary"), SceneError)
        return Item(**data)
    except InputError as error:
        raise error.within(path) from None
