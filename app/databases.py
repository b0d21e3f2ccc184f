"""SQLite files of the server: durable commits, and a schema of the newest migration."""

from __future__ import annotations

from pathlib import Path

import sqlalchemy as sa
from alembic import command
from alembic.config import Config

from recon4.store.sqlite_files import BUSY_S, make_durable


def open_engine(path: Path) -> sa.Engine:
    """An engine for a file; a commit survives a power cut."""
    engine = sa.create_engine(f"sqlite:///{path}", connect_args={"timeout": BUSY_S})
    sa.event.listen(engine, "connect", lambda connection, _: make_durable(connection))
    return engine


def migrate(connection: sa.Connection, package: Path) -> None:
    """Migrate the schema to the newest migration in ``package/migrations``."""
    config = Config()
    config.set_main_option("script_location", str(package / "migrations"))
    config.attributes["connection"] = connection
    command.upgrade(config, "head")
