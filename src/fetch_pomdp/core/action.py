"""The 2|I| + 1 actions of Section III-B; an item is named by its index in the scene."""

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


def _index(item: object) -> int:
    """Return NumPy's integers as Python's; how many items there are only the scene knows."""
    if isinstance(item, bool) or not isinstance(item, int | Integral):
        raise ActionError(f"found {shown(item)}, expected the index of an item, a whole number", field="item")
    return int(item)


Action: TypeAlias = Wait | Point | Pick
