"""What cannot be opened is said in one line, and no password with it."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest
import sqlalchemy as sa

from fetch_pomdp.errors import StoreError
from fetch_pomdp.user_study.store import database
from fetch_pomdp.user_study.store.store import Store
from tests.user_study.store.made import PICKED, WAITED, header, joined

SECRET = "s3cr3t-w0rd"


def complaint(url: str) -> str:
    with pytest.raises(StoreError) as raised:
        Store.open(url)
    text = str(raised.value)
    assert "\n" not in text
    assert SECRET not in text
    return text


@pytest.mark.parametrize(
    ("url", "found"),
    [
        ("participants.db", "--database: invalid URL, expected sqlite:///FILE or postgresql://"),
        (f"postgresql//u:{SECRET}@host/d", "--database: invalid URL"),
        (f"postgresql://u:{SECRET}@host:port/d", "--database: invalid URL"),
        ("", "--database: invalid URL"),
        (f"mysql://u:{SECRET}@host/d", "--database: found 'mysql', expected sqlite:///FILE or postgresql://"),
        ("sqlite://", "--database: found a database in memory"),
        ("sqlite:///:memory:", "--database: found a database in memory"),
        ("sqlite:///file:x?uri=true", "--database: found options of SQLite, expected sqlite:///FILE alone"),
    ],
)
def test_what_is_no_url(url: str, found: str) -> None:
    assert complaint(url).startswith(found)


@pytest.mark.parametrize("host", ["127.0.0.1:1", "localhost:1", "no-such-host.invalid"])
def test_a_server_that_does_not_answer(host: str) -> None:
    found = complaint(f"postgresql://user:{SECRET}@{host}/d?password={SECRET}")
    assert found.startswith(f"postgresql://user@{host}/d: cannot be used: ")


def test_a_file_that_is_no_database(tmp_path: Path) -> None:
    path = tmp_path / "notes.db"
    path.write_text("Not a database, but a text that somebody wants to keep.\n" * 40)
    before = path.read_bytes()
    assert complaint(f"sqlite:///{path}") == (
        f"sqlite:///{path}: cannot be used: file is not a database, expected a database that answers"
    )
    assert path.read_bytes() == before


def test_a_place_where_no_file_can_be(tmp_path: Path) -> None:
    for path in (tmp_path / "none" / "p.db", tmp_path, Path("/proc/p.db")):
        assert "cannot be used: unable to open database file" in complaint(f"sqlite:///{path}")


def test_a_database_that_cannot_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    url = f"sqlite:///{tmp_path / 'p.db'}"
    Store.open(url).close()
    whole = database._prepare_sqlite

    def as_if_read_only(connection: sqlite3.Connection, record: object) -> None:
        whole(connection, record)
        connection.execute("PRAGMA query_only = ON")  # the tests may run as root, whom no file refuses

    monkeypatch.setattr(database, "_prepare_sqlite", as_if_read_only)
    assert "p.db: cannot be used: attempt to write a readonly database" in complaint(url)


def test_a_file_is_nobody_elses_to_read(tmp_path: Path) -> None:
    store = Store.open(f"sqlite:///{tmp_path / 'p.db'}")
    joined(store)
    modes = {path.name: path.stat().st_mode & 0o777 for path in tmp_path.iterdir()}
    store.close()
    assert modes == {"p.db": 0o600, "p.db-wal": 0o600, "p.db-shm": 0o600}


def test_a_missing_file_is_not_made_where_one_is_expected(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match=r"p.db: no such file, expected a database of participants"):
        Store.existing(f"sqlite:///{tmp_path / 'p.db'}")
    assert list(tmp_path.iterdir()) == []


def test_every_commit_of_sqlite_is_on_disk_and_deletions_are_thorough(tmp_path: Path) -> None:
    opened = database.Database.open(f"sqlite:///{tmp_path / 'p.db'}")
    with opened.reading() as connection:
        names = ("journal_mode", "synchronous", "foreign_keys", "secure_delete", "busy_timeout")
        found = {name: connection.exec_driver_sql(f"PRAGMA {name}").scalar_one() for name in names}
    opened.close()
    assert found == {
        "journal_mode": "wal", "synchronous": 2, "foreign_keys": 1, "secure_delete": 1, "busy_timeout": 60_000,
    }  # fmt: skip


@pytest.mark.postgres
@pytest.mark.parametrize("url", ["postgres"], indirect=True)
def test_what_a_server_refuses(url: str) -> None:
    right = sa.make_url(url)
    wrong = right.set(password=SECRET).render_as_string(hide_password=False)
    assert 'password authentication failed for user "tester"' in complaint(wrong)
    missing = right.set(database="missing").render_as_string(hide_password=False)
    with pytest.raises(StoreError, match='database "missing" does not exist') as raised:
        Store.open(missing)
    assert str(right.password) not in str(raised.value)
    plain = right.set(drivername="postgresql").render_as_string(hide_password=False)
    Store.open(plain).close()


@pytest.mark.postgres
@pytest.mark.parametrize("url", ["postgres"], indirect=True)
def test_a_server_that_was_started_anew_is_found_again(url: str) -> None:
    store = Store.open(url)
    trial = store.trial(joined(store).id, "trial", 0, header(0, 0))
    trial.write(WAITED)
    engine = sa.create_engine(url, poolclass=sa.NullPool)
    with engine.connect() as other:  # what a restart does to those who are connected
        others = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = current_database()"
        assert other.exec_driver_sql(f"{others} AND pid <> pg_backend_pid()").scalars().all() == [True]
    trial.write(PICKED)
    assert store.trial(1, "trial", 0, header(0, 0)).events == (WAITED, PICKED)
    store.close()
