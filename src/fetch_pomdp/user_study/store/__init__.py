"""The database of a study's participants, their trials and answers: SQLite, or PostgreSQL."""

from fetch_pomdp.extras import require

EXTRA = "serve"
require("sqlalchemy", EXTRA)
require("alembic", EXTRA)
