"""The 2|I| + 1 actions of Section III-B, and questions of other kinds; an item is named by its index in the scene."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral
from typing import TypeAlias

from fetch_pomdp.checks import shown
from fetch_pomdp.errors import ActionError


@dataclass(frozen=True, slots=True)
class Wait:
    """Do nothing for one step and listen."""


@dataclass(frozen=True, slots=True)
class Point:
    """Point at an item and ask "this one?". Raises ActionError for an item that is not an index."""

    item: int

    def __post_init__(self) -> None:
        if type(self.item) is not int:
            object.__setattr__(self, "item", _index(self.item))


@dataclass(frozen=True, slots=True)
class Pick:
    """Take an item to the person: the end of the interaction. Raises ActionError for an item that is not an index."""

    item: int

    def __post_init__(self) -> None:
        if type(self.item) is not int:
            object.__setattr__(self, "item", _index(self.item))


@dataclass(frozen=True, slots=True)
class Ask:
    """Ask a question of another kind than `Point`, by its number in `Problem.questions`.

    Raises ActionError for what is no number.
    """

    question: int

    def __post_init__(self) -> None:
        if type(self.question) is not int:
            object.__setattr__(self, "question", _index(self.question, "question"))


def _index(index: object, of: str = "item") -> int:
    """Return NumPy's integers as Python's; how many items or questions there are only the scene knows."""
    if isinstance(index, bool) or not isinstance(index, int | Integral):
        raise ActionError(f"found {shown(index)}, expected the index of an item, a whole number", field=of)
    return int(index)


Action: TypeAlias = Wait | Point | Pick
AnyAction: TypeAlias = Action | Ask
