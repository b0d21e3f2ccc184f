"""``access.sqlite``: people, sessions, known browsers, audit log and webhooks, mode 0600.

The server and the command ``recon4 users`` both write to it, so a change begins by taking the
write lock. Readers never wait.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import sqlalchemy as sa
from alembic.util import CommandError

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.atomic import is_full
from recon4.store.sqlite_files import connect_to_read
from recon4_app.access.disk_reserve import Reserve
from recon4_app.databases import migrate, open_engine
from recon4_app.errors import NoRoom

METADATA = sa.MetaData()


def _texts(*names: str, nullable: bool = False) -> list[sa.Column[str]]:
    return [sa.Column(name, sa.String, nullable=nullable) for name in names]


def _numbers(*names: str, nullable: bool = False) -> list[sa.Column[float]]:
    return [sa.Column(name, sa.Float, nullable=nullable) for name in names]


PEOPLE = sa.Table(
    "people",
    METADATA,
    sa.Column("key", sa.String, primary_key=True),
    *_texts("name", "role", "password"),
    sa.Column("disabled", sa.Boolean, nullable=False),
    sa.Column("created", sa.String, nullable=False),
)
"""``key`` is the name folded, so that Anna and anna are one; ``password`` is an argon2 hash."""

SESSIONS = sa.Table(
    "sessions",
    METADATA,
    sa.Column("id", sa.String, primary_key=True),
    sa.Column("token_hash", sa.String, unique=True, nullable=False),
    sa.Column("person", sa.String, nullable=False),
    *_numbers("began_s", "proved_s", "seen_s"),
    *_texts("address", "agent"),
    *_texts("phone_role", "guest_link", "access_token", nullable=True),
    sa.Column("until_s", sa.Float, nullable=True),
)
"""``person`` is a key of `PEOPLE`; times are in seconds since 1970; ``phone_role`` is the
role of a phone that the person paired, ``guest_link`` the link of `GUEST_LINKS` that the person
made and a guest opened; both are NULL for a login. ``access_token`` is what the person named a
token for a program, whose role is in ``phone_role``; it expires at ``until_s``."""

GUEST_LINKS = sa.Table(
    "guest_links",
    METADATA,
    sa.Column("id", sa.String, primary_key=True),
    sa.Column("token_hash", sa.String, unique=True, nullable=False),
    *_texts("project", "label", "person"),
    *_numbers("created_s", "until_s"),
    sa.Column("opened", sa.Integer, nullable=False),
    *_numbers("opened_s", "revoked_s", nullable=True),
    sa.Column("revoked_by", sa.String, nullable=False),
)
"""``person`` is the key of who made it; ``opened`` counts how often, ``opened_s`` is the last time;
``revoked_s`` is NULL while it is not revoked."""

KNOWN_BROWSERS = sa.Table(
    "browsers",
    METADATA,
    sa.Column("token_hash", sa.String, primary_key=True),
    sa.Column("person", sa.String, nullable=False),
    sa.Column("known_s", sa.Float, nullable=False),
)
"""Browsers a person once signed in with: failed logins of others do not delay them."""

AUDIT = sa.Table(
    "audit",
    METADATA,
    sa.Column("number", sa.Integer, primary_key=True),
    *_texts("time", "person", "address", "action", "object", "outcome", "hash"),
)
"""Triggers reject changes and deletions of a row."""

WEBHOOKS_TABLE = sa.Table(
    "webhooks",
    METADATA,
    sa.Column("id", sa.String, primary_key=True),
    *_texts("url", "secret", "events"),
    sa.Column("created_s", sa.Float, nullable=False),
    sa.Column("by", sa.String, nullable=False),
)
"""``events`` are the kinds it takes, with spaces between; ``by`` is the admin who added it."""

DELIVERIES = sa.Table(
    "deliveries",
    METADATA,
    sa.Column("number", sa.Integer, primary_key=True),
    *_texts("webhook", "event", "kind", "body"),
    sa.Column("created_s", sa.Float, nullable=False),
    sa.Column("attempts", sa.Integer, nullable=False),
    sa.Column("due_s", sa.Float, nullable=False),
    sa.Column("delivered_s", sa.Float, nullable=True),
    sa.Column("problem", sa.String, nullable=False),
)
"""An event for a webhook, once; ``delivered_s`` is NULL until the receiver took it."""


def open_database(path: Path) -> sa.Engine:
    """Open the database; create it or migrate it to the newest schema.

    Raises:
        StoreError: If it is of another kind or version, or cannot be read; if the disk is full.
    """
    os.close(os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600))
    path.chmod(0o600)
    engine = open_engine(path)
    try:
        with writing(engine) as connection:
            migrate(connection, Path(__file__).parent)
    except (sa.exc.DatabaseError, CommandError) as error:
        engine.dispose()
        raise StoreError(
            CodedText("access-unusable", file=str(path), why=str(getattr(error, "orig", error)))
        ) from error
    except NoRoom as error:
        engine.dispose()
        raise StoreError(str(error)) from error
    return engine


def open_to_read(path: Path) -> sa.Engine:
    """Open an existing database to read it, also on a full disk and on read-only media."""
    return sa.create_engine(
        "sqlite://", creator=lambda: connect_to_read(path), poolclass=sa.pool.NullPool
    )


def reserve_of(engine: sa.Engine) -> Reserve:
    """The disk space that is kept for a database."""
    assert engine.url.database is not None
    return Reserve(Path(engine.url.database).parent)


@contextmanager
def writing(engine: sa.Engine) -> Iterator[sa.Connection]:
    """An exclusive write transaction; committed at the end.

    Raises:
        NoRoom: If the disk is full, and the reserve used up.
    """
    reserve_of(engine).give_way()
    try:
        with engine.begin() as connection:
            connection.exec_driver_sql("BEGIN IMMEDIATE")
            yield connection
    except sa.exc.OperationalError as error:  # a quota, or others were faster
        if is_full(error):
            raise NoRoom(CodedText("disk-full")) from error
        raise
