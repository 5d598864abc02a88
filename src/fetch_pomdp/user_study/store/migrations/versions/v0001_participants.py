"""Studies, participants, trials, events and answers."""

from __future__ import annotations

revision = "0001"
down_revision: str | None = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Create the tables."""
    _people()
    _trials()


def _people() -> None:
    import sqlalchemy as sa
    from alembic import op

    op.create_table(
        "studies",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("digest", sa.Text, nullable=False),
        sa.Column("people", sa.Integer, nullable=False),
        sa.UniqueConstraint("name", name="studies_name"),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "participants",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("study", sa.Integer, sa.ForeignKey("studies.id", name="participants_study"), nullable=False),
        sa.Column("person", sa.Integer, nullable=False),
        sa.Column("secret", sa.Text, nullable=False),
        sa.Column("code", sa.Text, nullable=False),
        sa.Column("stage", sa.Text, nullable=False),
        sa.Column("language", sa.Text, nullable=False),
        sa.Column("trials", sa.Integer, nullable=False),
        sa.Column("consent", sa.Text, nullable=False),
        sa.Column("joined", sa.Text, nullable=False),
        sa.Column("last", sa.Text, nullable=False),
        sa.Column("consented", sa.Text),
        sa.Column("finished", sa.Text),
        sa.Column("completion", sa.Text),
        sa.UniqueConstraint("study", "person", name="participants_person"),
        sa.UniqueConstraint("secret", name="participants_secret"),
        sa.UniqueConstraint("code", name="participants_code"),
        sqlite_autoincrement=True,
    )


def _trials() -> None:
    import sqlalchemy as sa
    from alembic import op

    whose = sa.ForeignKey("participants.id", name="trials_participant", ondelete="CASCADE")
    op.create_table(
        "trials",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("participant", sa.Integer, whose, nullable=False),
        sa.Column("part", sa.Text, nullable=False),
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("header", sa.Text, nullable=False),
        sa.Column("interruptions", sa.Integer, nullable=False),
        sa.Column("given_up", sa.Boolean, nullable=False),
        sa.Column("finished", sa.Text),
        sa.UniqueConstraint("participant", "part", "number", name="trials_number"),
        sqlite_autoincrement=True,
    )
    trial = sa.ForeignKey("trials.id", name="events_trial", ondelete="CASCADE")
    op.create_table(
        "events",
        sa.Column("trial", sa.Integer, trial, primary_key=True),
        sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
        sa.Column("line", sa.Text, nullable=False),
    )
    whose = sa.ForeignKey("participants.id", name="answers_participant", ondelete="CASCADE")
    op.create_table(
        "answers",
        sa.Column("participant", sa.Integer, whose, primary_key=True),
        sa.Column("question", sa.Text, primary_key=True),
        sa.Column("value", sa.Text, nullable=False),
    )
