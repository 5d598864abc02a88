"""The participants of a study in the database: who they are, how far they are, and their deletion."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import sqlalchemy as sa
from sqlalchemy import Connection

from fetch_pomdp import checks
from fetch_pomdp.errors import StoreError
from fetch_pomdp.user_study.store.schema import ANSWERS, EVENTS, PARTICIPANTS, SOUNDS, STUDIES, TRIALS

STAGES = ("instructions", "practice", "trials", "questions", "done")
LETTERS = "23456789BCDFGHJKMNPQRSTVWXYZ"  # none that are easily confused, and no vowels, which could make words


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """What a person has agreed to, and the text that they were shown."""

    language: str
    given: Mapping[str, bool]
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Participant:
    """A person who takes part in a study.

    code: shown to them; they quote it to have their data deleted. completion: shown at the end, None before.
    """

    id: int
    person: int  # number in the study, from 0
    code: str
    stage: str  # of STAGES
    language: str
    consent: Mapping[str, bool]
    answers: Mapping[str, Any]  # by question
    completion: str | None
    practice_done: int
    trials_done: int


def new_code() -> str:
    """Return a random code, such as K7Q-2MP."""
    letters = "".join(secrets.choice(LETTERS) for _ in range(6))
    return f"{letters[:3]}-{letters[3:]}"


def code_of(text: str) -> str:
    """Return a code as it was given out, from one as it was typed."""
    letters = "".join(letter for letter in text.upper() if letter.isalnum())
    return f"{letters[:3]}-{letters[3:]}"


def hashed(text: str) -> str:
    """Return the hash that is kept of a secret, or of a text that was agreed to: SHA-256, in hexadecimal digits."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def now() -> str:
    """Return the time, UTC, ISO 8601, to the second."""
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def as_json(value: object, field: str) -> str:
    """Return a value as JSON that any database can hold. Raises StoreError for a value that JSON cannot hold."""
    try:
        text = json.dumps(value, ensure_ascii=False, allow_nan=False)
        text.encode("utf-8")
    except (TypeError, ValueError, RecursionError) as cause:
        raise StoreError(f"cannot be kept as JSON: {cause}, expected text, numbers or lists", field=field) from None
    return text


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """How far a person is in a study. Times are UTC, ISO 8601; trials are without practice."""

    study: str
    person: int
    code: str
    stage: str
    language: str
    joined: str
    consented: str | None  # when
    consent_text: str | None  # hash of the text that they agreed to
    last: str  # when something was last written, to within half a minute
    finished: str | None
    trials_done: int
    of: int  # how many they are to have
    interruptions: int  # how often a trial was left and gone on with
    given_up: int
    completion: str | None  # the code shown to them at the end


def progress_of(connection: Connection, study: str | None) -> tuple[Progress, ...]:
    """Return how far everybody is, by study and person; nobody for an unknown study."""
    people, trials = PARTICIPANTS, TRIALS
    count = {
        "trials_done": sa.func.count(trials.c.finished),
        "interruptions": sa.func.coalesce(sa.func.sum(trials.c.interruptions), 0),
        "given_up": sa.func.coalesce(sa.func.sum(sa.case((trials.c.given_up, 1), else_=0)), 0),
    }
    plain = (
        "person", "code", "stage", "language", "joined", "consented", "consent_text", "last", "finished", "completion",
    )  # fmt: skip
    query = (
        sa.select(
            STUDIES.c.name.label("study"),
            *(people.c[name] for name in plain),
            people.c.trials.label("of"),
            *(value.label(name) for name, value in count.items()),
        )
        .join_from(people, STUDIES, people.c.study == STUDIES.c.id)
        .outerjoin(trials, sa.and_(trials.c.participant == people.c.id, trials.c.part == "trial"))
        .where(sa.true() if study is None else STUDIES.c.name == study)
        .group_by(STUDIES.c.name, people.c.id)
        .order_by(STUDIES.c.name, people.c.person)
    )
    return tuple(Progress(**row) for row in connection.execute(query).mappings())


def study_named(connection: Connection, study: str | None) -> str:
    """Return the name of the study that is meant: None means the only one.

    Raises StoreError, naming those there are, for an unknown one, and for None if there are several.
    """
    names: Sequence[str] = connection.execute(sa.select(STUDIES.c.name).order_by(STUDIES.c.name)).scalars().all()
    if not names:
        raise StoreError("the database has no study yet", field="study")
    if study is None and len(names) > 1:
        raise StoreError(f"found {', '.join(names)}; say which one", field="study")
    if study is not None:
        checks.known([study], names, "study", StoreError)
    return study or names[0]


@dataclass(frozen=True, slots=True)
class Deleted:
    """What was deleted: how many rows of each table."""

    code: str
    rows: Mapping[str, int]


def delete(connection: Connection, code: str) -> Deleted:
    """Delete the person with a code, as given out or as typed, and all their rows.

    Raises StoreError for an unknown code. Their number in the study is free again.
    """
    people, trials, given = PARTICIPANTS, TRIALS, code_of(code)
    found = connection.execute(people.select().where(people.c.code == given).with_for_update()).one_or_none()
    if found is None:
        raise StoreError("no participant has this code", field="code")
    theirs = sa.select(trials.c.id).where(trials.c.participant == found.id)
    rows = {
        "participants": 1,
        "trials": _count(connection, trials, trials.c.participant == found.id),
        "events": _count(connection, EVENTS, EVENTS.c.trial.in_(theirs)),
        "answers": _count(connection, ANSWERS, ANSWERS.c.participant == found.id),
        "sounds": _count(connection, SOUNDS, SOUNDS.c.trial.in_(theirs)),
    }
    connection.execute(people.delete().where(people.c.id == found.id))  # with all rows that refer to it
    return Deleted(given, rows)


def _count(connection: Connection, table: sa.Table, where: sa.ColumnElement[bool]) -> int:
    return int(connection.execute(sa.select(sa.func.count()).select_from(table).where(where)).scalar_one())
