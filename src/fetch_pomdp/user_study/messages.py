"""What a page of a study may send, besides what its person says and shows to the robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from fetch_pomdp import checks
from fetch_pomdp.adapters.web.protocol import TALK, Readers
from fetch_pomdp.errors import MessageError


@dataclass(frozen=True, slots=True)
class Reply:
    """What was filled in at a stage."""

    stage: str
    values: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Ready:
    """The countdown may begin."""


@dataclass(frozen=True, slots=True)
class Next:
    """The end of a trial has been seen."""


@dataclass(frozen=True, slots=True)
class GiveUp:
    """The robot will never bring what is desired."""


@dataclass(frozen=True, slots=True)
class Withdraw:
    """The person takes part no longer, and all that is kept of them goes."""


Answer: TypeAlias = Reply | Ready | Next | GiveUp | Withdraw


def _reply(data: Mapping[str, Any]) -> Reply:
    checks.required(data, ("stage", "values"), MessageError)
    stage = checks.text(data["stage"], "stage", "a stage", MessageError)
    return Reply(stage, checks.mapping(data["values"], "values", MessageError))


def _bare(kind: Callable[[], Answer]) -> tuple[tuple[()], Callable[[Mapping[str, Any]], Answer]]:
    return (), lambda _: kind()


STUDY: Readers = {
    **TALK,
    "reply": (("stage", "values"), _reply),
    "ready": _bare(Ready),
    "next": _bare(Next),
    "give_up": _bare(GiveUp),
    "withdraw": _bare(Withdraw),
}
