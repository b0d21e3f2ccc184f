"""People, their sessions and known browsers, and the audit log."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

AUDIT_TEXTS = ("time", "person", "address", "action", "object", "outcome", "hash")


def upgrade() -> None:
    """Make the tables; rows of the audit log can be neither changed nor deleted."""
    op.create_table(
        "people",
        sa.Column("key", sa.String, primary_key=True),
        *(sa.Column(name, sa.String, nullable=False) for name in ("name", "role", "password")),
        sa.Column("disabled", sa.Boolean, nullable=False),
        sa.Column("created", sa.String, nullable=False),
    )
    op.create_table(
        "sessions",
        sa.Column("id", sa.String, primary_key=True),
        sa.Column("token_hash", sa.String, unique=True, nullable=False),
        sa.Column("person", sa.String, nullable=False),
        *(sa.Column(name, sa.Float, nullable=False) for name in ("began_s", "proved_s", "seen_s")),
        *(sa.Column(name, sa.String, nullable=False) for name in ("address", "agent")),
    )
    op.create_table(
        "browsers",
        sa.Column("token_hash", sa.String, primary_key=True),
        sa.Column("person", sa.String, nullable=False),
        sa.Column("known_s", sa.Float, nullable=False),
    )
    op.create_table(
        "audit",
        sa.Column("number", sa.Integer, primary_key=True),
        *(sa.Column(name, sa.String, nullable=False) for name in AUDIT_TEXTS),
    )
    for what in ("UPDATE", "DELETE"):
        op.execute(
            f"CREATE TRIGGER audit_no_{what.lower()} BEFORE {what} ON audit "
            "BEGIN SELECT RAISE(ABORT, 'the audit log is only ever added to'); END"
        )


def downgrade() -> None:
    """Drop the tables."""
    for table in ("audit", "browsers", "sessions", "people"):
        op.drop_table(table)
