"""The tables grow with the package, and what is in them stays."""

from __future__ import annotations

import json
import threading
from typing import Any

import alembic.autogenerate
import alembic.migration
import pytest
import sqlalchemy as sa

from fetch_pomdp.errors import StoreError
from fetch_pomdp.files.events import event_to_json
from fetch_pomdp.files.header import header_to_json
from fetch_pomdp.user_study.store.database import Database, _engine, _url, migrate
from fetch_pomdp.user_study.store.schema import METADATA
from fetch_pomdp.user_study.store.store import Store
from tests.user_study.store.made import PICKED, SCENE, WAITED, header


@pytest.fixture
def database(url: str) -> Any:
    """A database without tables."""
    made = Database(_engine(_url(url)), "here")
    yield made
    made.close()


def differences(database: Database) -> list[Any]:
    with database.writing() as connection:
        context = alembic.migration.MigrationContext.configure(connection, opts={"compare_type": True})
        return list(alembic.autogenerate.compare_metadata(context, METADATA))


def test_the_revisions_make_the_tables_of_the_schema(database: Database) -> None:
    with database.writing() as connection:
        migrate(connection)
    assert differences(database) == []
    with database.writing() as connection:
        names = {name: sa.inspect(connection).get_unique_constraints(name) for name in METADATA.tables}
        connection.exec_driver_sql("ALTER TABLE answers ADD COLUMN more TEXT")
    assert {one["name"] for one in names["participants"]} == {
        "participants_person", "participants_secret", "participants_code",
    }  # fmt: skip
    assert len(differences(database)) == 1, "a difference is seen"


def written_first(connection: Any) -> None:
    """Write what a server of the first tables may have: somebody in the middle of a trial, before another."""
    line, event = json.dumps(header_to_json(header(0, 0))), json.dumps(event_to_json(WAITED, SCENE))
    when = "2026-01-01T00:00:00Z"
    who = (1, 1, 0, "x", "K7Q-2MP", "trials", "en", 2, "{}", when, when, None, None, None)
    rows: list[tuple[str, tuple[object, ...]]] = [
        ("studies", (1, "pilot", "d1", 4)), ("participants", who),
        ("trials", (1, 1, "trial", 0, line, 0, False, None)), ("trials", (2, 1, "trial", 1, line, 0, False, None)),
        ("events", (1, 0, event)), ("answers", (1, "ease", "4")),
    ]  # fmt: skip
    for name, values in rows:
        table = sa.Table(name, sa.MetaData(), autoload_with=connection, resolve_fks=False)
        connection.execute(table.insert().values(values))


def test_an_upgrade_keeps_what_is_there(database: Database, url: str) -> None:
    with database.writing() as connection:
        migrate(connection, "0001")
        assert "sounds" not in sa.inspect(connection).get_table_names()
        written_first(connection)
    new = Store.open(url)
    (someone,) = new.progress()
    assert (someone.code, someone.consent_text) == ("K7Q-2MP", None)
    trial = new.trial(1, "trial", 0, header(0, 0))
    assert (trial.events, trial.clock) == ((WAITED,), 0.0)
    assert new.trial(1, "trial", 1, header(0, 1)).clock is None
    assert [one.interruptions for one in new.progress()] == [1], "of the trial that had begun"
    trial.keep_sound(0.0, b"\0\1")
    trial.write(PICKED)
    assert new.forget(someone.code).rows == {"participants": 1, "trials": 2, "events": 2, "answers": 1, "sounds": 1}
    assert differences(database) == []
    new.close()


def test_tables_of_a_later_version_are_left_alone(database: Database, url: str) -> None:
    Store.open(url).close()
    with database.writing() as connection:
        connection.exec_driver_sql("UPDATE alembic_version SET version_num = '0999'")
    with pytest.raises(StoreError, match="found tables of revision 0999, expected 0003 or an earlier one"):
        Store.open(url)


def test_a_revision_that_fails_leaves_nothing(database: Database, url: str) -> None:
    with database.writing() as connection:
        connection.exec_driver_sql("CREATE TABLE answers (mine INTEGER)")
    with pytest.raises(StoreError, match=r"cannot be used: .*answers.* already exists"):
        Store.open(url)
    with database.writing() as connection:
        assert sa.inspect(connection).get_table_names() == ["answers"]


def test_several_open_a_new_database_at_once(url: str) -> None:
    failed: list[Exception] = []
    start = threading.Barrier(6)

    def come() -> None:
        start.wait()
        try:
            Store.open(url).close()
        except StoreError as error:
            failed.append(error)

    people = [threading.Thread(target=come) for _ in range(6)]
    for one in people:
        one.start()
    for one in people:
        one.join()
    assert failed == []
