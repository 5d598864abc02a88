"""The tables brought to their newest form, by Alembic."""

from __future__ import annotations

import threading
from importlib.resources import files
from typing import Any

from fetch_pomdp.adapters.store.schema import EXTRA
from fetch_pomdp.errors import StoreError
from fetch_pomdp.extras import load

NEWEST = "head"
ALONE = 7_105_240_512  # PostgreSQL's advisory lock that keeps two servers from doing it at once

_one_at_a_time = threading.Lock()  # Alembic keeps what it works on in global names


def migrate(connection: Any, revision: str = NEWEST) -> None:
    """Bring the tables to a revision, in the transaction of the connection.

    Raises StoreError if they are of a later version of this package.
    """
    command, config = load("alembic.command", EXTRA), load("alembic.config", EXTRA).Config()
    config.set_main_option("script_location", str(files("fetch_pomdp.adapters.store") / "migrations"))
    config.attributes["connection"] = connection
    if connection.dialect.name == "postgresql":
        connection.exec_driver_sql(f"SELECT pg_advisory_xact_lock({ALONE})")
    with _one_at_a_time:
        _refuse_later(connection, config)
        command.upgrade(config, revision)


def _refuse_later(connection: Any, config: Any) -> None:
    scripts = load("alembic.script", EXTRA).ScriptDirectory.from_config(config)
    known = {script.revision for script in scripts.walk_revisions()}
    context = load("alembic.runtime.migration", EXTRA).MigrationContext.configure(connection)
    for found in context.get_current_heads():
        if found not in known:
            expected = f"expected {scripts.get_current_head()} or an earlier one"
            raise StoreError(f"found tables of revision {found}, {expected}: a later fetch-pomdp made them")
