"""Sessions of phones: paired, not signed in with a password."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """A phone may less than the person who paired it: its role is of its own."""
    op.add_column("sessions", sa.Column("phone_role", sa.String, nullable=True))


def downgrade() -> None:
    """Forget the phones."""
    op.execute("DELETE FROM sessions WHERE phone_role IS NOT NULL")
    op.drop_column("sessions", "phone_role")
