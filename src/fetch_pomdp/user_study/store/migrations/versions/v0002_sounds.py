"""Sound, of people who have consented to it."""

from __future__ import annotations

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Create the table."""
    import sqlalchemy as sa
    from alembic import op

    trial = sa.ForeignKey("trials.id", name="sounds_trial", ondelete="CASCADE")
    op.create_table(
        "sounds",
        sa.Column("trial", sa.Integer, trial, primary_key=True),
        sa.Column("number", sa.Integer, primary_key=True, autoincrement=False),
        sa.Column("start", sa.Float, nullable=False),
        sa.Column("pcm", sa.LargeBinary, nullable=False),
    )
