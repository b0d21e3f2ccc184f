"""Jobs whose end was not announced yet."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """A job comes into the table in the transaction that stores its end."""
    op.create_table("ended", sa.Column("job", sa.String, primary_key=True))


def downgrade() -> None:
    """Drop the table."""
    op.drop_table("ended")
