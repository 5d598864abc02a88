"""How far the participants of a study are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from fetch_pomdp import checks
from fetch_pomdp.adapters.store.schema import EXTRA, schema
from fetch_pomdp.errors import StoreError
from fetch_pomdp.extras import load


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """Where somebody is in a study. Times are UTC, ISO 8601; trials are those of the study, without practice."""

    study: str
    person: int
    code: str
    stage: str
    language: str
    joined: str
    consented: str | None  # when
    consent_text: str | None  # hash of the text that they have agreed to
    last: str  # when something was last written, to within half a minute
    finished: str | None
    trials_done: int
    of: int  # how many they are to have
    interruptions: int  # how often a trial was left after its beginning and gone on with
    given_up: int
    completion: str | None  # the code that was shown to them at the end


def progress(connection: Any, study: str | None) -> tuple[Progress, ...]:
    """Return how far everybody is, by study and person; nobody for a study that nobody has begun."""
    sa, tables = load("sqlalchemy", EXTRA), schema()
    people, trials = tables.participants, tables.trials
    count = {
        "trials_done": sa.func.count(trials.c.finished),
        "interruptions": sa.func.coalesce(sa.func.sum(trials.c.interruptions), 0),
        "given_up": sa.func.coalesce(sa.func.sum(sa.case((trials.c.given_up, 1), else_=0)), 0),
    }
    plain = (
        "person",
        "code",
        "stage",
        "language",
        "joined",
        "consented",
        "consent_text",
        "last",
        "finished",
        "completion",
    )
    query = (
        sa.select(
            tables.studies.c.name.label("study"),
            *(people.c[name] for name in plain),
            people.c.trials.label("of"),
            *(value.label(name) for name, value in count.items()),
        )
        .join_from(people, tables.studies, people.c.study == tables.studies.c.id)
        .outerjoin(trials, sa.and_(trials.c.participant == people.c.id, trials.c.part == "trial"))
        .where(sa.true() if study is None else tables.studies.c.name == study)
        .group_by(tables.studies.c.name, people.c.id)
        .order_by(tables.studies.c.name, people.c.person)
    )
    return tuple(Progress(**row) for row in connection.execute(query).mappings())


def known(connection: Any, study: str | None) -> str:
    """Return the name of the study that is meant: the only one if it is not said.

    Raises StoreError, naming those there are, for one that is not there, or if it is not said and not clear.
    """
    table = schema().studies
    query = table.select().with_only_columns(table.c.name).order_by(table.c.name)
    names: Sequence[str] = connection.execute(query).scalars().all()
    if not names:
        raise StoreError("found no study, expected one that somebody has begun", field="study")
    if study is None and len(names) > 1:
        raise StoreError(f"found {', '.join(names)}, expected the name of one", field="study")
    if study is not None:
        checks.known([study], names, "study", StoreError)
    return study or names[0]
