"""Alembic runs this file for every command: it hands over the connection that `revisions.py` has opened."""

from __future__ import annotations


def run() -> None:
    """Run the revisions that are wanted in the transaction of the caller."""
    from alembic import context

    context.configure(connection=context.config.attributes["connection"])
    with context.begin_transaction():
        context.run_migrations()


run()
