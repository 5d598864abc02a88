"""One person's data deleted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fetch_pomdp.adapters.store.participant import code_of
from fetch_pomdp.adapters.store.schema import EXTRA, schema
from fetch_pomdp.errors import StoreError
from fetch_pomdp.extras import load


@dataclass(frozen=True, slots=True)
class Forgotten:
    """What was deleted: how many rows of each table."""

    code: str
    rows: Mapping[str, int]


def forget(connection: Any, code: str) -> Forgotten:
    """Delete the person with a code, as given out or as typed, and all rows that belong to them.

    Raises StoreError if nobody has it. Their number in the study is free again.
    """
    tables, given = schema(), code_of(code)
    people, trials = tables.participants, tables.trials
    found = connection.execute(people.select().where(people.c.code == given).with_for_update()).one_or_none()
    if found is None:
        raise StoreError("found nobody with it, expected the code of somebody who takes part", field="code")
    theirs = trials.select().with_only_columns(trials.c.id).where(trials.c.participant == found.id)
    rows = {
        "participants": 1,
        "trials": _count(connection, trials, trials.c.participant == found.id),
        "events": _count(connection, tables.events, tables.events.c.trial.in_(theirs)),
        "answers": _count(connection, tables.answers, tables.answers.c.participant == found.id),
        "sounds": _count(connection, tables.sounds, tables.sounds.c.trial.in_(theirs)),
    }
    connection.execute(people.delete().where(people.c.id == found.id))  # all that refers to it goes along
    return Forgotten(given, rows)


def _count(connection: Any, table: Any, where: Any) -> int:
    sa = load("sqlalchemy", EXTRA)
    return int(connection.execute(sa.select(sa.func.count()).select_from(table).where(where)).scalar_one())
