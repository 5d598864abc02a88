"""The store of a study: who takes part, how far they are, and what they did and said."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import sqlalchemy as sa
from sqlalchemy import Connection

from fetch_pomdp import checks
from fetch_pomdp.errors import StoreError
from fetch_pomdp.files.header import Header
from fetch_pomdp.user_study.store.database import ConflictError, Database, file_of, key_of
from fetch_pomdp.user_study.store.exporting import Exported, export
from fetch_pomdp.user_study.store.participants import (
    STAGES,
    Agreement,
    Deleted,
    Participant,
    Progress,
    as_json,
    delete,
    hashed,
    new_code,
    now,
    progress_of,
)
from fetch_pomdp.user_study.store.schema import ANSWERS, PARTICIPANTS, STUDIES, TRIALS
from fetch_pomdp.user_study.store.trials import StoredTrial, opened

TRIES = 50  # enrolments that may collide


class Store:
    """A database of participants, from any thread; what a method has written is committed when it returns."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @classmethod
    def open(cls, url: str) -> Store:
        """Open the database at a URL (SQLAlchemy's), with the newest tables; one of SQLite is made if it is missing.

        Raises StoreError for an invalid URL, a database that does not answer, a file that is not a database, and tables
        of a later version.
        """
        return cls(Database.open(url))

    @classmethod
    def existing(cls, url: str) -> Store:
        """Open a database that exists. Raises StoreError as `open`, and for a file that is missing."""
        file = file_of(url)
        if file is not None and not file.is_file():
            raise StoreError("no such file, expected a database of participants", source=str(file))
        return cls.open(url)

    def close(self) -> None:
        """Close all connections."""
        self._database.close()

    def begin(self, study: str, digest: str, people: int) -> None:
        """Note a study before the first person comes. Raises StoreError if it was begun with another digest."""
        with self._database.writing() as connection:
            _study(connection, study, digest, people)

    def enrol(
        self, study: str, digest: str, people: int, agreed: Agreement, *, secret: str, trials: Callable[[int], int]
    ) -> Participant:
        """Enrol somebody who has agreed, with the lowest number that is free, at their first stage.

        secret: what their page keeps. trials: how many trials the person of a number is to have. Raises StoreError if
        all places are taken, or if the study was begun with another digest.
        """
        row = {
            "secret": hashed(secret), "stage": STAGES[0], "language": agreed.language,
            "consent": as_json(dict(agreed.given), "consent"), "consent_text": hashed(agreed.text),
        }  # fmt: skip
        for _ in range(TRIES):
            try:
                with self._database.writing() as connection:
                    number = _study(connection, study, digest, people)
                    person = _free_place(connection, study, number, people)
                    when = now()
                    times = {"joined": when, "consented": when, "last": when}
                    place = {"study": number, "person": person, "code": new_code(), "trials": trials(person)}
                    added = connection.execute(PARTICIPANTS.insert().values({**row, **times, **place}))
                    return _participant(connection, PARTICIPANTS.c.id == key_of(added))  # type: ignore[return-value]
            except ConflictError:  # another server took the number, or began the study
                continue
        raise StoreError(f"found a number taken {TRIES} times, expected a free one", field="person")

    def returning(self, study: str, secret: str) -> Participant | None:
        """Return the participant of a study whose page keeps a secret, None for an unknown one."""
        people, studies = PARTICIPANTS, STUDIES
        here = people.c.study.in_(sa.select(studies.c.id).where(studies.c.name == study))
        with self._database.reading() as connection:
            return _participant(connection, sa.and_(people.c.secret == hashed(secret), here))

    def advance(self, participant_id: int, stage: str) -> None:
        """Note that somebody has come to a stage; at the last one they get a completion code."""
        if stage not in STAGES:
            raise StoreError(f"found {checks.shown(stage)}, expected one of {', '.join(STAGES)}", field="stage")
        over = {"finished": now(), "completion": new_code()} if stage == "done" else {}
        first = {name: sa.func.coalesce(PARTICIPANTS.c[name], value) for name, value in over.items()}  # once for all
        self._change(participant_id, stage=stage, **first)

    def trial(self, participant_id: int, part: Literal["practice", "trial"], order: int, header: Header) -> StoredTrial:
        """Begin a trial, or go on with the one that is there; see `trials.opened`."""
        return opened(self._database, participant_id, part, order, header)

    def answer(self, participant_id: int, question_id: str, value: object) -> None:
        """Note an answer, replacing an earlier one to the question. Raises StoreError for what JSON cannot hold."""
        answers = ANSWERS
        place = {"participant": participant_id, "question": question_id}
        with self._database.writing() as connection:
            where = (answers.c.participant == participant_id, answers.c.question == question_id)
            connection.execute(answers.delete().where(*where))
            connection.execute(answers.insert().values(**place, value=as_json(value, question_id)))

    def progress(self, study: str | None = None) -> tuple[Progress, ...]:
        """Return how far everybody is, in this study or in all; nobody for an unknown study."""
        with self._database.reading() as connection:
            return progress_of(connection, study)

    def export(self, folder: Path, study: str | None = None) -> Exported:
        """Write a study into a new folder; see `exporting.export`."""
        with self._database.reading() as connection:
            return export(connection, folder, study)

    def forget(self, code: str) -> Deleted:
        """Delete all there is of the person with a code, from the tables and from what the tables leave behind.

        Raises StoreError for an unknown code, or if something is left behind (`scrub`).
        """
        forgotten = self.erase(code)
        self.scrub()
        return forgotten

    def erase(self, code: str) -> Deleted:
        """Delete all rows of the person with a code. Raises StoreError for an unknown code."""
        with self._database.writing() as connection:
            return delete(connection, code)

    def scrub(self) -> None:
        """Remove what deleted rows have left behind; see `Database.scrub`."""
        self._database.scrub()

    def _change(self, participant_id: int, **values: object) -> None:
        change = PARTICIPANTS.update().where(PARTICIPANTS.c.id == participant_id).values(**values, last=now())
        with self._database.writing() as connection:
            if not connection.execute(change).rowcount:
                raise StoreError("the participant was deleted", field="participant")


def _study(connection: Connection, name: str, digest: str, people: int) -> int:
    """Return the id of a study, new or there already, and keep others from enrolling until the transaction ends."""
    found = connection.execute(STUDIES.select().where(STUDIES.c.name == name).with_for_update()).one_or_none()
    if found is None:
        return key_of(connection.execute(STUDIES.insert().values(name=name, digest=digest, people=people)))
    if found.digest != digest:
        changed = f"{name!r} was begun with other contents ({found.digest}, not {digest})"
        raise StoreError(f"{changed}; give the changed study another name", field="study")
    return int(found.id)


def _free_place(connection: Connection, name: str, study: int, people: int) -> int:
    """Return the lowest number in a study that nobody has. Raises StoreError if all are taken."""
    query = sa.select(PARTICIPANTS.c.person).where(PARTICIPANTS.c.study == study)
    taken = set(connection.execute(query).scalars())
    person = next((free for free in range(people) if free not in taken), None)
    if person is None:
        raise StoreError(f"all {people} places of {name!r} are taken", field="people")
    return person


def _participant(connection: Connection, where: sa.ColumnElement[bool]) -> Participant | None:
    found = connection.execute(PARTICIPANTS.select().where(where)).one_or_none()
    if found is None:
        return None
    answers = connection.execute(ANSWERS.select().where(ANSWERS.c.participant == found.id))
    done = sa.select(TRIALS.c.part, sa.func.count().label("number")).where(
        TRIALS.c.participant == found.id, TRIALS.c.finished.is_not(None)
    )
    counts = {row.part: row.number for row in connection.execute(done.group_by(TRIALS.c.part))}
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
