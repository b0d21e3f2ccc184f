"""Guest links, and the sessions that they begin."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """A guest's session belongs to a link, and ends with it."""
    op.create_table(
        "guest_links",
        sa.Column("id", sa.String, primary_key=True),
        sa.Column("token_hash", sa.String, unique=True, nullable=False),
        *(sa.Column(name, sa.String, nullable=False) for name in ("project", "label", "person")),
        *(sa.Column(name, sa.Float, nullable=False) for name in ("created_s", "until_s")),
        sa.Column("opened", sa.Integer, nullable=False),
        *(sa.Column(name, sa.Float, nullable=True) for name in ("opened_s", "revoked_s")),
        sa.Column("revoked_by", sa.String, nullable=False),
    )
    op.add_column("sessions", sa.Column("guest_link", sa.String, nullable=True))


def downgrade() -> None:
    """Forget the guests."""
    op.execute("DELETE FROM sessions WHERE guest_link IS NOT NULL")
    op.drop_column("sessions", "guest_link")
    op.drop_table("guest_links")
