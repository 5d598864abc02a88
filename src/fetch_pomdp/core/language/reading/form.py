"""Meanings: the small logical forms that a grammar makes of words and a table gives degrees to.

A `Description` says which items are meant: all of its parts hold. The other forms are its parts. Every form is
immutable, compares by value and prints as a person would check it ("red, left of (bowl)").
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any, TypeVar, get_args, get_type_hints


class Person(Enum):
    """Somebody at the table, as the one who speaks names them."""

    ME = "me"
    YOU = "you"


@dataclass(frozen=True, slots=True)
class Select:
    """Items that a word may refer to."""

    word: str  # "#" before it if it is an id

    def __str__(self) -> str:
        return self.word.removeprefix("#")


@dataclass(frozen=True, slots=True)
class Side:
    """On one side or another of the table ("left", "top right"), as `viewer` sees it where that is said.

    extreme: the farthest of all on that side ("leftmost"). edge: the one nearest to that side's edge.
    """

    sides: tuple[str, ...]
    viewer: Person | None = None
    extreme: bool = False

    def __str__(self) -> str:
        whose = "" if self.viewer is None else "my " if self.viewer is Person.ME else "your "
        return ("far " if self.extreme else "") + whose + " ".join(self.sides)


@dataclass(frozen=True, slots=True)
class Superlative:
    """The nearest or farthest to a person, a side or other items, or the n-th of them (an ordinal).

    by: None is near to whom goes without saying. rank: 1 for the first, -1 for the last.
    """

    by: Person | Side | Description | None
    far: bool = False
    rank: int = 1

    def __str__(self) -> str:
        number = "" if self.rank == 1 else "last " if self.rank < 0 else f"number {self.rank} "
        of = "" if self.by is None else f" {'from' if self.far else 'to'} {_inside(self.by)}"
        return f"{number}{'farthest' if self.far else 'closest'}{of}"


@dataclass(frozen=True, slots=True)
class Relation:
    """Somewhere relative to a landmark: a person, or items that are uncertain themselves.

    direct: "directly", "right", "immediately".
    """

    name: str
    landmark: Person | Description | Anaphor
    viewer: Person | None = None
    direct: bool = False

    def __str__(self) -> str:
        return f"{'directly ' if self.direct else ''}{self.name} {_inside(self.landmark)}"


@dataclass(frozen=True, slots=True)
class Between:
    """Between two landmarks, or between some two of one plural landmark."""

    first: Description | Anaphor
    second: Description | Anaphor | None = None

    def __str__(self) -> str:
        other = "" if self.second is None else f" and {_inside(self.second)}"
        return f"between {_inside(self.first)}{other}"


@dataclass(frozen=True, slots=True)
class Middle:
    """In the middle of the table's items, or of a landmark."""

    of: Description | Anaphor | None = None

    def __str__(self) -> str:
        return "in the middle" if self.of is None else f"in the middle of {_inside(self.of)}"


@dataclass(frozen=True, slots=True)
class Alone:
    """With no other near it."""

    def __str__(self) -> str:
        return "by itself"


@dataclass(frozen=True, slots=True)
class Crowded:
    """With others close around it."""

    def __str__(self) -> str:
        return "surrounded"


@dataclass(frozen=True, slots=True)
class Within:
    """One of a group of items, or one of several that a description fits."""

    group: Description | Anaphor

    def __str__(self) -> str:
        return f"one of {_inside(self.group)}"


@dataclass(frozen=True, slots=True)
class Count:
    """How many items a description means together; 1 for "the only one"."""

    number: int

    def __str__(self) -> str:
        return f"{self.number} together" if self.number > 1 else "the only one"


@dataclass(frozen=True, slots=True)
class Cluster:
    """Items that stand together, however many. shape: "row" (side by side), "column" (behind each other), or any."""

    shape: str = ""

    def __str__(self) -> str:
        return f"in a {self.shape}" if self.shape else "together"


@dataclass(frozen=True, slots=True)
class Ordinal:
    """A number in a row whose order another part of the description gives."""

    rank: int

    def __str__(self) -> str:
        return f"number {self.rank}"


@dataclass(frozen=True, slots=True)
class Near:
    """Near or far, to what another part of the description says."""

    far: bool = False

    def __str__(self) -> str:
        return "far" if self.far else "close"


@dataclass(frozen=True, slots=True)
class Toward:
    """What an ordinal counts from, or near and far are measured to: a person or a side."""

    whom: Person | Side

    def __str__(self) -> str:
        return f"from {_inside(self.whom)}"


@dataclass(frozen=True, slots=True)
class Seen:
    """As a person sees it ("from your point of view")."""

    viewer: Person

    def __str__(self) -> str:
        return f"as seen by {self.viewer.value}"


@dataclass(frozen=True, slots=True)
class Not:
    """What a form does not hold of."""

    form: Form

    def __str__(self) -> str:
        return f"not {_inside(self.form)}"


@dataclass(frozen=True, slots=True)
class Anaphor:
    """What was spoken of before: "it", "that one" (`plural` False), "them", "those"; "the other one" (`other`)."""

    plural: bool = False
    other: bool = False

    def __str__(self) -> str:
        return "the other" if self.other else "those" if self.plural else "it"


@dataclass(frozen=True, slots=True)
class Known:
    """The very item that was spoken of, such as the one that the robot asked about."""

    index: int

    def __str__(self) -> str:
        return "the one asked about"


@dataclass(frozen=True, slots=True)
class Same:
    """What was meant before."""

    def __str__(self) -> str:
        return "the same"


@dataclass(frozen=True, slots=True)
class Union:
    """What either of two descriptions fits."""

    first: Description | Anaphor
    second: Description | Anaphor

    def __str__(self) -> str:
        return f"{_inside(self.first)} or {_inside(self.second)}"


@dataclass(frozen=True, slots=True)
class Description:
    """Items of which all parts hold."""

    parts: tuple[Form, ...] = ()
    # Computed once, when they are first asked for: some meanings are looked up often, most never.
    _hash: int | None = field(init=False, repr=False, compare=False, default=None)
    _extent: tuple[int, int] | None = field(init=False, repr=False, compare=False, default=None)

    def __hash__(self) -> int:
        if self._hash is None:
            object.__setattr__(self, "_hash", hash(self.parts))
        return self._hash or 0

    @property
    def extent(self) -> tuple[int, int]:
        """Of how many forms it is made, and how many descriptions and negations are at most within each other."""
        if self._extent is None:
            inside = [extent(part) for part in self.parts]
            found = (1 + sum(size for size, _ in inside), 1 + max((deep for _, deep in inside), default=0))
            object.__setattr__(self, "_extent", found)
        return self._extent or (1, 1)

    def __str__(self) -> str:
        return ", ".join(map(str, self.parts)) or "something"

    @property
    def plural(self) -> bool:
        """Whether it means several items together."""
        return any(isinstance(part, Cluster) or (isinstance(part, Count) and part.number > 1) for part in self.parts)

    def plus(self, *parts: Form) -> Description:
        """Return the description with more parts; one said twice counts once."""
        return Description(tuple(dict.fromkeys((*self.parts, *parts))))


Form = (
    Select | Side | Superlative | Relation | Between | Middle | Alone | Crowded | Within | Count | Cluster | Ordinal
    | Near | Toward | Seen | Not | Anaphor | Known | Same | Union | Description
)  # fmt: skip

Made = TypeVar("Made", bound=Form)
_FORMS = frozenset(get_args(Form))


def _may_hold(hint: Any) -> bool:
    return hint in _FORMS or any(map(_may_hold, get_args(hint)))


# Of each kind of form the fields that may hold other forms.
_NAMES = {kind: tuple(name for name, hint in get_type_hints(kind).items() if _may_hold(hint)) for kind in _FORMS}


def inner(form: Form) -> Iterator[Form]:
    """Yield the forms that a form is directly made of."""
    for name in _NAMES[type(form)]:
        value = getattr(form, name)
        for each in value if isinstance(value, tuple) else (value,):
            if type(each) in _FORMS:
                yield each


def extent(form: Form) -> tuple[int, int]:
    """Return how many forms a form is made of, and how many descriptions and negations are within each other."""
    if isinstance(form, Description):
        return form.extent
    size, deep = 1, 0
    for more, deeper in map(extent, inner(form)):
        size, deep = size + more, max(deep, deeper)
    return size, deep + isinstance(form, Not)


def rebuilt(form: Made, change: Callable[[Any], Any]) -> Made:
    """Return a form with each form that it is directly made of changed; itself where none changes."""
    new: dict[str, Any] = {}
    for name in _NAMES[type(form)]:
        value = getattr(form, name)
        if isinstance(value, tuple):
            parts = tuple(map(change, value))
            if any(part is not old for part, old in zip(parts, value, strict=True)):
                new[name] = parts
        elif type(value) in _FORMS and (part := change(value)) is not value:
            new[name] = part
    return replace(form, **new) if new else form


def _inside(form: Form | Person) -> str:
    if isinstance(form, Person):
        return form.value
    text = str(form)
    return f"({text})" if "," in text or " " in text else text
