"""SQLite files of the server: durable commits, and a schema of the newest migration."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import sqlalchemy as sa
from alembic import command
from alembic.config import Config

from recon4.store.sqlite_files import make_durable


def open_engine(path: Path) -> sa.Engine:
    """An engine for a file; a commit survives a power cut."""
    engine = sa.create_engine(f"sqlite:///{path}")
    sa.event.listen(engine, "connect", _make_durable)
    return engine


def migrate(connection: sa.Connection, package: Path) -> None:
    """Migrate the schema to the newest migration in ``package/migrations``."""
    config = Config()
    config.set_main_option("script_location", str(package / "migrations"))
    config.attributes["connection"] = connection
    command.upgrade(config, "head")


def _make_durable(connection: Any, _: object) -> None:
    make_durable(connection)
    connection.execute("PRAGMA busy_timeout = 5000").close()
