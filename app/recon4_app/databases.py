"""SQLite files of the server: durable commits, and a schema of the newest migration."""

from __future__ import annotations

from pathlib import Path

import sqlalchemy as sa
from alembic import command
from alembic.config import Config

from recon4.store.sqlite_files import make_durable
from recon4.store.tuning import SQLITE


def open_engine(path: Path) -> sa.Engine:
    """An engine for a file; a commit survives a power cut."""
    # not made from text: a percent sign or a question mark in a path would change its meaning
    url = sa.URL.create("sqlite", database=str(path))
    engine = sa.create_engine(url, connect_args={"timeout": SQLITE.busy_s})
    sa.event.listen(engine, "connect", lambda connection, _: make_durable(connection))
    return engine


def migrate(connection: sa.Connection, package: Path) -> None:
    """Migrate the schema to the newest migration in ``package/migrations``."""
    config = Config()
    folder = str(package / "migrations").replace("%", "%%")  # alembic interpolates its options
    config.set_main_option("script_location", folder)
    config.attributes["connection"] = connection
    command.upgrade(config, "head")
