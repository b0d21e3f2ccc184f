"""Jobs that make files of a map, who started a job, and what it made."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

ACTIVE = "state IN ('queued', 'running')"


def upgrade() -> None:
    """Add the columns; at most one job that processes a project waits or runs."""
    for name, default in (("kind", "process"), ("person", ""), ("made", "")):
        column = sa.Column(name, sa.String, nullable=False, server_default=default)
        op.add_column("jobs", column)
    op.drop_index("one_active_job", "jobs")
    op.create_index(
        "one_active_job",
        "jobs",
        ["project"],
        unique=True,
        sqlite_where=sa.text(f"{ACTIVE} AND kind = 'process'"),
    )


def downgrade() -> None:
    """Remove the exports and the columns."""
    op.drop_index("one_active_job", "jobs")
    op.execute("DELETE FROM jobs WHERE kind = 'export'")
    for name in ("kind", "person", "made"):
        op.drop_column("jobs", name)
    op.create_index(
        "one_active_job", "jobs", ["project"], unique=True, sqlite_where=sa.text(ACTIVE)
    )
