"""The 2|I| + 1 actions of Section III-B; an item is named by its index in the scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True, slots=True)
class Wait:
    """Do nothing for one step and listen."""


@dataclass(frozen=True, slots=True)
class Point:
    """Point at an item and ask "this one?"."""

    item: int


@dataclass(frozen=True, slots=True)
class Pick:
    """Take an item to the person: the end of the interaction."""

    item: int


Action: TypeAlias = Wait | Point | Pick
