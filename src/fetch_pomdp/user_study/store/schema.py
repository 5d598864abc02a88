"""The tables as they are now; `migrations` says how they came to be, and a test that both agree.

A participant is known by a hash of the secret that their page keeps, and by a code that they can quote. Nothing else
that could tell who they are is kept: no name, no address, no kind of browser. Times are UTC, as ISO 8601 text.
"""

from __future__ import annotations

import functools
import threading
from dataclasses import dataclass
from typing import Any

from fetch_pomdp.extras import load

EXTRA = "serve"


@dataclass(frozen=True, slots=True)
class Schema:
    """The tables; a third-party type cannot be named without importing it."""

    metadata: Any
    studies: Any
    participants: Any
    trials: Any
    events: Any  # line: the event as its line of a log has it (docs/events.md)
    answers: Any  # value: JSON
    sounds: Any  # start: s, of the trial's clock; pcm: 16 bit, mono, 16 kHz


_one_at_a_time = threading.Lock()


def schema() -> Schema:
    """Return the tables, the same ones to every thread. Raises MissingExtraError without SQLAlchemy."""
    with _one_at_a_time:
        return _schema()


@functools.cache
def _schema() -> Schema:
    sa = load("sqlalchemy", EXTRA)
    metadata = sa.MetaData()
    return Schema(
        metadata,
        _studies(sa, metadata),
        _participants(sa, metadata),
        _trials(sa, metadata),
        _numbered(sa, metadata, "events", sa.Column("line", sa.Text, nullable=False)),
        sa.Table(
            "answers",
            metadata,
            _reference(sa, "participant", "answers_participant", primary_key=True),
            sa.Column("question", sa.Text, primary_key=True),
            sa.Column("value", sa.Text, nullable=False),
        ),
        _numbered(
            sa,
            metadata,
            "sounds",
            sa.Column("start", sa.Float, nullable=False),
            sa.Column("pcm", sa.LargeBinary, nullable=False),
        ),
    )


def _studies(sa: Any, metadata: Any) -> Any:
    return sa.Table(
        "studies",
        metadata,
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("digest", sa.Text, nullable=False),
        sa.Column("people", sa.Integer, nullable=False),
        sa.UniqueConstraint("name", name="studies_name"),
        sqlite_autoincrement=True,
    )


def _participants(sa: Any, metadata: Any) -> Any:
    return sa.Table(
        "participants",
        metadata,
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("study", sa.ForeignKey("studies.id", name="participants_study"), nullable=False),
        sa.Column("person", sa.Integer, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("secret", "code", "stage", "language")),
        sa.Column("trials", sa.Integer, nullable=False),  # how many they are to have
        *(sa.Column(name, sa.Text, nullable=False) for name in ("consent", "joined", "last")),
        *(sa.Column(name, sa.Text) for name in ("consented", "finished", "completion")),
        sa.Column("consent_text", sa.Text),  # hash of the text that was agreed to
        sa.UniqueConstraint("study", "person", name="participants_person"),
        sa.UniqueConstraint("secret", name="participants_secret"),
        sa.UniqueConstraint("code", name="participants_code"),
        sqlite_autoincrement=True,  # a number of one who is gone is never another's
    )


def _trials(sa: Any, metadata: Any) -> Any:
    return sa.Table(
        "trials",
        metadata,
        sa.Column("id", sa.Integer, primary_key=True),
        _reference(sa, "participant", "trials_participant", nullable=False),
        sa.Column("part", sa.Text, nullable=False),
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("header", sa.Text, nullable=False),  # as the first line of a log has it
        sa.Column("interruptions", sa.Integer, nullable=False),
        sa.Column("given_up", sa.Boolean, nullable=False),
        sa.Column("finished", sa.Text),
        sa.Column("clock", sa.Float),  # s, what the trial's clock showed when it was last noted; none before it ran
        sa.UniqueConstraint("participant", "part", "number", name="trials_number"),
        sqlite_autoincrement=True,
    )


def _numbered(sa: Any, metadata: Any, name: str, *columns: Any) -> Any:
    """Return a table of what comes one after the other in a trial."""
    number = sa.Column("number", sa.Integer, primary_key=True, autoincrement=False)
    return sa.Table(name, metadata, _reference(sa, "trial", f"{name}_trial", primary_key=True), number, *columns)


def _reference(sa: Any, to: str, name: str, **options: Any) -> Any:
    """Return a column that leads to a row of another table, and goes with it."""
    return sa.Column(to, sa.ForeignKey(f"{to}s.id", name=name, ondelete="CASCADE"), **options)
