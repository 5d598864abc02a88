"""The tables as they are now; `migrations` says how they came to be, and a test that both agree.

A participant is known by a hash of the secret that their page keeps, and by a code that they can quote. Nothing else
that could tell who they are is kept: no name, no address, no kind of browser. Times are UTC, as ISO 8601 text.
"""

from __future__ import annotations

import sqlalchemy as sa

METADATA = sa.MetaData()


def _reference(to: str, name: str, *, nullable: bool = False, primary_key: bool = False) -> sa.Column[int]:
    """Return a column that refers to a row of another table, and is deleted with it."""
    key = sa.ForeignKey(f"{to}s.id", name=name, ondelete="CASCADE")
    return sa.Column(to, key, nullable=nullable, primary_key=primary_key)


def _numbered(name: str, *columns: sa.Column[object]) -> sa.Table:
    """Return a table of what comes one after the other in a trial."""
    number = sa.Column("number", sa.Integer, primary_key=True, autoincrement=False)
    return sa.Table(name, METADATA, _reference("trial", f"{name}_trial", primary_key=True), number, *columns)


STUDIES = sa.Table(
    "studies",
    METADATA,
    sa.Column("id", sa.Integer, primary_key=True),
    sa.Column("name", sa.Text, nullable=False),
    sa.Column("digest", sa.Text, nullable=False),
    sa.Column("people", sa.Integer, nullable=False),
    sa.UniqueConstraint("name", name="studies_name"),
    sqlite_autoincrement=True,
)
PARTICIPANTS = sa.Table(
    "participants",
    METADATA,
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
    sqlite_autoincrement=True,  # the id of a deleted participant is never used again
)
TRIALS = sa.Table(
    "trials",
    METADATA,
    sa.Column("id", sa.Integer, primary_key=True),
    _reference("participant", "trials_participant"),
    sa.Column("part", sa.Text, nullable=False),
    sa.Column("number", sa.Integer, nullable=False),
    sa.Column("header", sa.Text, nullable=False),  # as the first line of a log has it
    sa.Column("interruptions", sa.Integer, nullable=False),
    sa.Column("given_up", sa.Boolean, nullable=False),
    sa.Column("finished", sa.Text),
    sa.Column("clock", sa.Float),  # s, of the trial's clock when it was last noted; none before it ran
    sa.UniqueConstraint("participant", "part", "number", name="trials_number"),
    sqlite_autoincrement=True,
)
# line: the event as its line of a log has it (docs/events.md)
EVENTS = _numbered("events", sa.Column("line", sa.Text, nullable=False))
ANSWERS = sa.Table(
    "answers",
    METADATA,
    _reference("participant", "answers_participant", primary_key=True),
    sa.Column("question", sa.Text, primary_key=True),
    sa.Column("value", sa.Text, nullable=False),  # JSON
)
# start: s, of the trial's clock; pcm: 16 bit, mono, 16 kHz
SOUNDS = _numbered(
    "sounds", sa.Column("start", sa.Float, nullable=False), sa.Column("pcm", sa.LargeBinary, nullable=False)
)
