"""What a participant's page may send, besides what its person says and shows to the robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from fetch_pomdp import checks
from fetch_pomdp.adapters.web.page_messages import TALK, Readers
from fetch_pomdp.errors import MessageError


@dataclass(frozen=True, slots=True)
class Reply:
    """The form of a stage, filled in."""

    stage: str
    values: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Ready:
    """The countdown may begin."""


@dataclass(frozen=True, slots=True)
class Next:
    """The person has seen the end of a trial."""


@dataclass(frozen=True, slots=True)
class GiveUp:
    """The person gives the trial up."""


@dataclass(frozen=True, slots=True)
class Withdraw:
    """The person withdraws; all that is kept of them is deleted."""


Command: TypeAlias = Reply | Ready | Next | GiveUp | Withdraw


def _reply(data: Mapping[str, Any]) -> Reply:
    checks.required(data, ("stage", "values"), MessageError)
    stage = checks.text(data["stage"], "stage", "a stage", MessageError)
    return Reply(stage, checks.mapping(data["values"], "values", MessageError))


def _bare(kind: Callable[[], Command]) -> tuple[tuple[()], Callable[[Mapping[str, Any]], Command]]:
    return (), lambda _: kind()


PARTICIPANT: Readers = {
    **TALK,
    "reply": (("stage", "values"), _reply),
    "ready": _bare(Ready),
    "next": _bare(Next),
    "give_up": _bare(GiveUp),
    "withdraw": _bare(Withdraw),
}
