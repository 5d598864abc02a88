"""What a trial's clock showed, and a hash of the text that was agreed to."""

from __future__ import annotations

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Add the columns; a trial in which something has happened had begun."""
    import sqlalchemy as sa
    from alembic import op

    op.add_column("participants", sa.Column("consent_text", sa.Text))
    op.add_column("trials", sa.Column("clock", sa.Float))
    op.execute("UPDATE trials SET clock = 0 WHERE id IN (SELECT trial FROM events)")
