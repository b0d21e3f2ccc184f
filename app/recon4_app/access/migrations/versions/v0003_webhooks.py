"""Webhooks, and events on their way to them."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make the tables; an event is in the list of a webhook once."""
    op.create_table(
        "webhooks",
        sa.Column("id", sa.String, primary_key=True),
        *(sa.Column(name, sa.String, nullable=False) for name in ("url", "secret", "events", "by")),
        sa.Column("created_s", sa.Float, nullable=False),
    )
    op.create_table(
        "deliveries",
        sa.Column("number", sa.Integer, primary_key=True),
        *(sa.Column(name, sa.String, nullable=False) for name in ("webhook", "event", "kind")),
        *(sa.Column(name, sa.String, nullable=False) for name in ("body", "problem")),
        *(sa.Column(name, sa.Float, nullable=False) for name in ("created_s", "due_s")),
        sa.Column("attempts", sa.Integer, nullable=False),
        sa.Column("delivered_s", sa.Float, nullable=True),
        sa.UniqueConstraint("webhook", "event"),
    )


def downgrade() -> None:
    """Drop the tables."""
    for table in ("deliveries", "webhooks"):
        op.drop_table(table)
