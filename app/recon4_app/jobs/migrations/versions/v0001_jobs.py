"""The queue of jobs."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

TEXTS = ("project", "created", "state", "started", "finished", "note")


def upgrade() -> None:
    """Make the table; at most one job of a project waits or runs."""
    op.create_table(
        "jobs",
        sa.Column("number", sa.Integer, primary_key=True),
        sa.Column("id", sa.String, unique=True, nullable=False),
        *(sa.Column(name, sa.String, nullable=False) for name in TEXTS),
        sa.Column("inputs", sa.JSON, nullable=False),
        sa.Column("attempt", sa.Integer, nullable=False),
    )
    op.create_index(
        "one_active_job",
        "jobs",
        ["project"],
        unique=True,
        sqlite_where=sa.text("state IN ('queued', 'running')"),
    )


def downgrade() -> None:
    """Drop the table."""
    op.drop_table("jobs")
