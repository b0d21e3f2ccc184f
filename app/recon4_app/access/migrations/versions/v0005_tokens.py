"""Access tokens for programs: sessions with a name, a role of their own and an expiry."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """A token is a session that lasts until a time."""
    op.add_column("sessions", sa.Column("access_token", sa.String, nullable=True))
    op.add_column("sessions", sa.Column("until_s", sa.Float, nullable=True))


def downgrade() -> None:
    """Revoke all tokens: without the columns they would be sessions of phones."""
    op.execute("DELETE FROM sessions WHERE access_token IS NOT NULL")
    op.drop_column("sessions", "until_s")
    op.drop_column("sessions", "access_token")
