"""Each test of the store runs on SQLite, and marked `postgres` on a real PostgreSQL (tests/with_postgres.sh)."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from pathlib import Path

import pytest

from fetch_pomdp.user_study.store.store import Store
from tests.user_study.store.made import BOTH

VARIABLE = "FETCH_POMDP_TEST_DATABASE"


@pytest.fixture(params=BOTH)
def url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """The URL of an empty database."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path / 'participants.db'}"
        return
    import sqlalchemy as sa

    server = os.environ.get(VARIABLE)
    assert server, f"{VARIABLE} is not set; run the command behind tests/with_postgres.sh"
    name = f"test_{secrets.token_hex(6)}"
    engine = sa.create_engine(server, isolation_level="AUTOCOMMIT", poolclass=sa.NullPool)
    with engine.connect() as connection:
        connection.exec_driver_sql(f"CREATE DATABASE {name}")
    yield engine.url.set(database=name).render_as_string(hide_password=False)
    with engine.connect() as connection:
        connection.exec_driver_sql(f"DROP DATABASE {name} WITH (FORCE)")


@pytest.fixture
def store(url: str) -> Iterator[Store]:
    opened = Store.open(url)
    yield opened
    opened.close()
