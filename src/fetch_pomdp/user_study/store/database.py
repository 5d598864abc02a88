"""A database, opened by its URL: its tables brought up to date, transactions, and its failures as one-line errors."""

from __future__ import annotations

import contextlib
import os
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager
from importlib.resources import files
from pathlib import Path
from typing import Any

import sqlalchemy as sa
from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine
from sqlalchemy.exc import ArgumentError, IntegrityError, SQLAlchemyError

from fetch_pomdp.errors import InputError, StoreError
from fetch_pomdp.extras import require

EXPECTED = "expected sqlite:///FILE or postgresql://USER:PASSWORD@HOST/DATABASE"
BUSY_TIMEOUT = 60  # s that SQLite waits for another process that writes
CONNECT = 10  # s that a PostgreSQL server may take to answer
POOL = 20  # connections to a PostgreSQL server; a new one for each of a crowd would cost more than a commit
BEGIN = "fetch_pomdp_begin"  # execution option: how a transaction begins on SQLite
WRITING = "BEGIN IMMEDIATE"  # claimed at once: a transaction that reads first may be refused it later
NEWEST = "head"
ALONE = 7_105_240_512  # PostgreSQL's advisory lock that keeps two servers from migrating at once

_migrating = threading.Lock()  # Alembic keeps what it works on in global names


class ConflictError(StoreError):
    """Another writer was first, or what was to be added to is gone."""


class Database:
    """Transactions on a database, from any thread.

    Choice: writers in this process take turns on SQLite, which knows one writer at a time and lets the others sleep for
    up to 100 ms before they look again.
    """

    def __init__(self, engine: Engine, shown: str) -> None:
        self.engine, self._shown = engine, shown
        self._is_file = engine.dialect.name == "sqlite"
        self._turn: AbstractContextManager[object] = threading.Lock() if self._is_file else contextlib.nullcontext()
        reading = {BEGIN: "BEGIN"} if self._is_file else {"isolation_level": "REPEATABLE READ"}
        outside = {BEGIN: None} if self._is_file else {"isolation_level": "AUTOCOMMIT"}
        self._reader, self._outside = engine.execution_options(**reading), engine.execution_options(**outside)

    @classmethod
    def open(cls, text: str) -> Database:
        """Open the database at a URL, with the newest tables; a file of SQLite is made if it is missing.

        Raises StoreError for an invalid URL, a database that does not answer, a file that is not a database, and tables
        of a later version.
        """
        url = _url(text)
        database = cls(_engine(url), shown(url))
        try:
            with database.writing() as connection:
                migrate(connection)
        except BaseException:
            database.close()
            raise
        return database

    @contextlib.contextmanager
    def writing(self) -> Iterator[Connection]:
        """Begin a transaction that may write; it is committed when the block ends, or undone if it raises.

        Raises ConflictError where rows contradict each other, StoreError for anything else that the database refuses.
        """
        with self._turn, self._translated(), self.engine.begin() as connection:
            yield connection

    @contextlib.contextmanager
    def reading(self) -> Iterator[Connection]:
        """Begin a transaction that sees the database as it was at its first look."""
        with self._translated(), self._reader.begin() as connection:
            yield connection

    def scrub(self) -> None:
        """Remove what deleted rows have left behind: on SQLite from its files, on PostgreSQL from the tables' pages.

        Raises StoreError if another program reads an older state of the file for longer than BUSY_TIMEOUT.
        """
        with self._turn, self._translated(), self._outside.connect() as connection:
            connection.exec_driver_sql("VACUUM")
            if self._is_file and connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)").one()[0]:
                left = "deleted, but bytes of it are left while another program reads an older state of the file"
                raise StoreError(f"{left}; close that program and try again")

    def close(self) -> None:
        """Close all connections."""
        self.engine.dispose()

    @contextlib.contextmanager
    def _translated(self) -> Iterator[None]:
        try:
            yield
        except InputError as error:
            raise error if error.source else error.located(self._shown, None) from None
        except IntegrityError as cause:
            raise ConflictError(f"contradicts what is there: {self._reason(cause)}", source=self._shown) from None
        except (SQLAlchemyError, sqlite3.Error) as cause:
            raise StoreError(
                f"cannot be used: {self._reason(cause)}, expected a database that answers", source=self._shown
            ) from None

    def _reason(self, cause: Exception) -> str:
        """Return what the driver says, on one line and without a password."""
        text = " ".join(str(getattr(cause, "orig", None) or cause).split())
        for secret in (self.engine.url.password, self.engine.url.query.get("password")):
            text = text.replace(str(secret), "***") if secret else text
        return text


def shown(url: sa.URL) -> str:
    """Return a URL for messages: where the database is, without a password."""
    parts = {name: getattr(url, name) for name in ("username", "host", "port", "database")}
    return sa.URL.create(url.get_backend_name(), **parts).render_as_string()


def _url(text: str) -> sa.URL:
    """Read a URL; an invalid one is not repeated in the message, for there may be a password in it."""
    try:
        url = sa.make_url(text)
    except (ArgumentError, ValueError):
        raise StoreError(f"invalid URL, {EXPECTED}", field="--database") from None
    if url.get_backend_name() == "postgresql":
        return url.set(drivername="postgresql+psycopg")
    if url.get_backend_name() != "sqlite":
        raise StoreError(f"found {url.get_backend_name()!r}, {EXPECTED}", field="--database")
    if not url.database or url.database == ":memory:":
        raise StoreError("found a database in memory, expected sqlite:///FILE", field="--database")
    if url.query:
        raise StoreError("found options of SQLite, expected sqlite:///FILE alone", field="--database")
    return url.set(drivername="sqlite")


def file_of(text: str) -> Path | None:
    """Return the file of a database of SQLite, None for a server. Raises StoreError for an invalid URL."""
    url = _url(text)
    return Path(url.database or "") if url.get_backend_name() == "sqlite" else None


def _engine(url: sa.URL) -> Engine:
    if url.get_backend_name() == "postgresql":
        require("psycopg", "postgres")
        arguments = {} if "connect_timeout" in url.query else {"connect_timeout": CONNECT}
        return sa.create_engine(url, pool_pre_ping=True, pool_size=POOL, max_overflow=0, connect_args=arguments)
    with contextlib.suppress(OSError):  # connecting says what is wrong
        os.close(os.open(url.database or "", os.O_CREAT | os.O_RDWR, 0o600))  # readable for its owner alone
    engine = sa.create_engine(url, connect_args={"timeout": BUSY_TIMEOUT})
    sa.event.listen(engine, "connect", _prepare_sqlite)
    sa.event.listen(engine, "begin", _begin_sqlite)
    return engine


def key_of(added: sa.CursorResult[Any]) -> int:
    """Return the id of the row that an insertion made."""
    key: Any = added.inserted_primary_key
    return int(key[0])


def _prepare_sqlite(connection: sqlite3.Connection, _: object) -> None:
    connection.isolation_level = None  # Python begins no transaction of its own: `_begin_sqlite` does
    for setting in ("journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON", "secure_delete = ON"):
        connection.execute(f"PRAGMA {setting}")


def _begin_sqlite(connection: Connection) -> None:
    begin = connection.get_execution_options().get(BEGIN, WRITING)
    if begin is not None:
        connection.exec_driver_sql(begin)


def migrate(connection: Connection, revision: str = NEWEST) -> None:
    """Bring the tables to a revision, in the transaction of the connection.

    Raises StoreError if they are of a later version of this package.
    """
    config = Config()
    config.set_main_option("script_location", str(files("fetch_pomdp.user_study.store") / "migrations"))
    config.attributes["connection"] = connection
    if connection.dialect.name == "postgresql":
        connection.exec_driver_sql(f"SELECT pg_advisory_xact_lock({ALONE})")
    with _migrating:
        _refuse_later(connection, config)
        command.upgrade(config, revision)


def _refuse_later(connection: Connection, config: Config) -> None:
    scripts = ScriptDirectory.from_config(config)
    known = {script.revision for script in scripts.walk_revisions()}
    context = MigrationContext.configure(connection)
    for found in context.get_current_heads():
        if found not in known:
            expected = f"expected {scripts.get_current_head()} or an earlier one"
            raise StoreError(f"found tables of revision {found}, {expected}: a later fetch-pomdp made them")
