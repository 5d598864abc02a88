"""The store of a study: who takes part, how far they are, and what they did and said."""

from __future__ import annotations

import json
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

from fetch_pomdp import checks
from fetch_pomdp.adapters.store import journal
from fetch_pomdp.adapters.store.database import ConflictError, Database, file_of
from fetch_pomdp.adapters.store.exporting import Exported, Scored, export
from fetch_pomdp.adapters.store.forgetting import Forgotten, forget
from fetch_pomdp.adapters.store.participant import (
    STAGES,
    Agreement,
    Participant,
    as_json,
    hashed,
    new_code,
    now,
)
from fetch_pomdp.adapters.store.progress import Progress, progress
from fetch_pomdp.adapters.store.schema import EXTRA, schema
from fetch_pomdp.errors import StoreError
from fetch_pomdp.extras import load
from fetch_pomdp.files.header import Header

TRIES = 50  # enrolments that may collide before somebody is told


class Store:
    """A database of participants, from any thread; what a method has written is committed when it returns."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @classmethod
    def open(cls, url: str) -> Store:
        """Open the database at a URL (SQLAlchemy's), with the newest tables; one of SQLite is made if it is missing.

        Raises StoreError for what is no URL, a database that does not answer or is none, and tables of a later version.
        """
        return cls(Database.open(url))

    @classmethod
    def existing(cls, url: str) -> Store:
        """Open a database that is there. Raises StoreError as `open`, and for a file that is missing."""
        file = file_of(url)
        if file is not None and not file.is_file():
            raise StoreError("found no such file, expected a database of participants", source=str(file))
        return cls.open(url)

    def close(self) -> None:
        """Close all connections."""
        self._database.close()

    def begin(self, study: str, digest: str, people: int) -> None:
        """Note a study before the first person comes. Raises StoreError if it is there with another digest."""
        with self._database.writing() as connection:
            _study(connection, study, digest, people)

    def enrol(
        self, study: str, digest: str, people: int, agreed: Agreement, *, trials: Callable[[int], int]
    ) -> tuple[Participant, str]:
        """Take in somebody who has agreed, with the lowest number that is free.

        Return them, at their first stage, and the secret that their page keeps.

        trials: how many trials the person of a number is to have. Raises StoreError when all `people` are there, or the
        study is there with another digest: it has changed since it began.
        """
        for _ in range(TRIES):
            try:
                return self._enrolled(study, digest, people, agreed, trials)
            except ConflictError:  # another server took the number, or began the study
                continue
        raise StoreError(f"found a number taken {TRIES} times, expected a free one", field="person")

    def _enrolled(
        self, study: str, digest: str, people: int, agreed: Agreement, trials: Callable[[int], int]
    ) -> tuple[Participant, str]:
        table, secret = schema().participants, secrets.token_urlsafe(24)
        with self._database.writing() as connection:
            number = _study(connection, study, digest, people)
            taken = set(
                connection.execute(
                    table.select().with_only_columns(table.c.person).where(table.c.study == number)
                ).scalars()
            )
            person = next((free for free in range(people) if free not in taken), None)
            if person is None:
                raise StoreError(f"found all {people} people of {study!r} there, expected a free place", field="people")
            when = now()
            values = {
                "study": number, "person": person, "secret": hashed(secret), "code": new_code(), "stage": STAGES[0],
                "language": agreed.language, "trials": trials(person), "joined": when, "consented": when, "last": when,
                "consent": as_json(dict(agreed.given), "consent"), "consent_text": hashed(agreed.text),
            }  # fmt: skip
            added = connection.execute(table.insert().values(values)).inserted_primary_key[0]
            return _participant(connection, table.c.id == added), secret  # type: ignore[return-value]

    def returning(self, study: str, secret: str) -> Participant | None:
        """Return whom of a study a secret belongs to, None if nobody."""
        sa, tables = load("sqlalchemy", EXTRA), schema()
        people, studies = tables.participants, tables.studies
        here = people.c.study.in_(sa.select(studies.c.id).where(studies.c.name == study))
        with self._database.reading() as connection:
            return _participant(connection, sa.and_(people.c.secret == hashed(secret), here))

    def advance(self, participant_id: int, stage: str) -> None:
        """Note that somebody has come to a stage; who is done gets a code that says so."""
        if stage not in STAGES:
            raise StoreError(f"found {checks.shown(stage)}, expected one of {', '.join(STAGES)}", field="stage")
        sa, people = load("sqlalchemy", EXTRA), schema().participants
        over = {"finished": now(), "completion": new_code()} if stage == "done" else {}
        first = {name: sa.func.coalesce(people.c[name], value) for name, value in over.items()}  # once for all
        self._change(participant_id, stage=stage, **first)

    def trial(
        self, participant_id: int, part: Literal["practice", "trial"], order: int, header: Header
    ) -> journal.TrialJournal:
        """Begin a trial, or go on with the one that is there; see `journal.opened`."""
        return journal.opened(self._database, participant_id, part, order, header)

    def answer(self, participant_id: int, question_id: str, value: object) -> None:
        """Note an answer, in the place of an earlier one to the question. Raises StoreError for what is no JSON."""
        answers = schema().answers
        place = {"participant": participant_id, "question": question_id}
        with self._database.writing() as connection:
            where = (answers.c.participant == participant_id, answers.c.question == question_id)
            connection.execute(answers.delete().where(*where))
            connection.execute(answers.insert().values(**place, value=as_json(value, question_id)))

    def progress(self, study: str | None = None) -> tuple[Progress, ...]:
        """Return how far everybody is, in this study or in all; nobody for a study that nobody has begun."""
        with self._database.reading() as connection:
            return progress(connection, study)

    def export(self, folder: Path, study: str | None = None, *, scored: Scored) -> Exported:
        """Write a study into a new folder; see `exporting.export`."""
        with self._database.reading() as connection:
            return export(connection, folder, study, scored)

    def forget(self, code: str) -> Forgotten:
        """Delete all there is of the person with a code, from the tables and from what the tables leave behind.

        Raises StoreError if nobody has the code, or if something is left behind (`scrub`).
        """
        forgotten = self.erase(code)
        self.scrub()
        return forgotten

    def erase(self, code: str) -> Forgotten:
        """Delete all rows of the person with a code. Raises StoreError if nobody has it."""
        with self._database.writing() as connection:
            return forget(connection, code)

    def scrub(self) -> None:
        """Remove what deleted rows have left behind; see `Database.scrub`."""
        self._database.scrub()

    def _change(self, participant_id: int, **values: object) -> None:
        table = schema().participants
        with self._database.writing() as connection:
            changed = connection.execute(
                table.update().where(table.c.id == participant_id).values(**values, last=now())
            )
            if not changed.rowcount:
                raise StoreError("found none, expected somebody who takes part", field="participant")


def _study(connection: Any, name: str, digest: str, people: int) -> int:
    """Return the id of a study, new or there already, and keep others from enrolling until the transaction ends."""
    studies = schema().studies
    found = connection.execute(studies.select().where(studies.c.name == name).with_for_update()).one_or_none()
    if found is None:
        values = {"name": name, "digest": digest, "people": people}
        return int(connection.execute(studies.insert().values(values)).inserted_primary_key[0])
    if found.digest != digest:
        changed = f"found {name!r} there with other contents ({found.digest}, not {digest})"
        raise StoreError(f"{changed}, expected the same study or one of another name", field="study")
    return int(found.id)


def _participant(connection: Any, where: Any) -> Participant | None:
    tables, sa = schema(), load("sqlalchemy", EXTRA)
    found = connection.execute(tables.participants.select().where(where)).one_or_none()
    if found is None:
        return None
    answers = connection.execute(tables.answers.select().where(tables.answers.c.participant == found.id))
    trials = tables.trials
    done = sa.select(trials.c.part, sa.func.count().label("number")).where(
        trials.c.participant == found.id, trials.c.finished.is_not(None)
    )
    counts = {row.part: row.number for row in connection.execute(done.group_by(trials.c.part))}
    return Participant(
        id=found.id,
        person=found.person,
        code=found.code,
        stage=found.stage,
        language=found.language,
        consent=json.loads(found.consent),
        answers={row.question: json.loads(row.value) for row in answers},
        completion=found.completion,
        practice_done=counts.get("practice", 0),
        trials_done=counts.get("trial", 0),
    )
