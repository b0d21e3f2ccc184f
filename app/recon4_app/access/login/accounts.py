"""Accounts of the people who may sign in."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from recon4.locales.coded import CodedText
from recon4_app.access.database import KNOWN_BROWSERS, PEOPLE, SESSIONS, writing
from recon4_app.access.login import passwords
from recon4_app.access.people import ASSIGNABLE, Role
from recon4_app.errors import Conflict, NotFound, Refused

NAME = re.compile(r"[^\W_](?:[\w .'@+-]{0,62}[\w.])?")
"""Letters and digits of any script, and what occurs in names and addresses."""
RESERVED = ("local", "nobody")
"""Names of people without an account."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Account:
    """A person who may sign in, without the password."""

    name: str
    role: Role
    disabled: bool
    created: str
    """UTC, ISO 8601."""


class Accounts:
    """Reads and changes accounts. A change of a role or a password ends the person's sessions."""

    def __init__(self, engine: sa.Engine) -> None:
        self._engine = engine

    def all(self) -> list[Account]:
        """All accounts, sorted by name."""
        with self._engine.connect() as connection:
            rows = connection.execute(PEOPLE.select().order_by(PEOPLE.c.key)).mappings()
            return [_account(row) for row in rows]

    def get(self, name: str) -> Account:
        """The account of one person.

        Raises:
            NotFound: If no account has that name.
        """
        with self._engine.connect() as connection:
            row = connection.execute(_of(name)).mappings().one_or_none()
        if row is None:
            raise NotFound(CodedText("account-unknown", name=name[:64]))
        return _account(row)

    def active_password_hash(self, name: str) -> str | None:
        """The hash of a person's password; None if there is no such account or it is disabled."""
        active = (PEOPLE.c.key == lookup_key(name)) & ~PEOPLE.c.disabled
        query = sa.select(PEOPLE.c.password).where(active)
        with self._engine.connect() as connection:
            return connection.execute(query).scalar_one_or_none()

    def has_admin(self) -> bool:
        """Whether an enabled admin account exists."""
        with self._engine.connect() as connection:
            return connection.execute(_admins()).scalar_one() > 0

    def add(self, name: str, role: Role, password: str) -> Account:
        """Add a person.

        Raises:
            Refused: If the name or the role is not valid.
            Conflict: If an account has that name.
            WeakPassword: If the password is too easy to find.
        """
        name = unicodedata.normalize("NFKC", name)
        if not NAME.fullmatch(name):
            raise Refused(CodedText("account-name-invalid"))
        if lookup_key(name) in RESERVED:
            raise Refused(CodedText("account-name-reserved", name=name))
        _assignable(role)
        passwords.require_strong(password, name)
        created = datetime.now(UTC).isoformat(timespec="seconds")
        row = dict(name=name, role=role, disabled=False, created=created)
        hashed = passwords.hashed(password)
        try:
            with writing(self._engine) as connection:
                values = {**row, "key": lookup_key(name), "password": hashed}
                connection.execute(PEOPLE.insert().values(**values))
        except IntegrityError as error:
            raise Conflict(CodedText("account-exists", name=name)) from error
        return self.get(name)

    def set_role(self, name: str, role: Role) -> Account:
        """Change the role of a person.

        Raises:
            NotFound: If no account has that name.
            Conflict: If this was the last admin.
        """
        return self._change(name, role=_assignable(role))

    def set_disabled(self, name: str, disabled: bool) -> Account:
        """Disable or enable an account; accounts are never deleted because the log names them.

        Raises:
            NotFound: If no account has that name.
            Conflict: If this was the last admin.
        """
        return self._change(name, disabled=disabled)

    def set_password(self, name: str, password: str) -> Account:
        """Set a password.

        Raises:
            NotFound: If no account has that name.
            WeakPassword: If the password is too easy to find.
        """
        passwords.require_strong(password, self.get(name).name)
        return self._change(name, password=passwords.hashed(password))

    def _change(self, name: str, **values: Any) -> Account:
        before, key = self.get(name), lookup_key(name)
        with writing(self._engine) as connection:
            connection.execute(PEOPLE.update().where(PEOPLE.c.key == key).values(**values))
            if before.role is Role.ADMIN and connection.execute(_admins()).scalar_one() == 0:
                raise Conflict(CodedText("last-admin", name=before.name))
            for table in (SESSIONS, KNOWN_BROWSERS):
                connection.execute(table.delete().where(table.c.person == key))
        return self.get(name)


def lookup_key(name: str) -> str:
    """The lookup key of a name: the same for all spellings of the same letters."""
    return unicodedata.normalize("NFKC", name).casefold()


def _of(name: str) -> sa.Select[Any]:
    return PEOPLE.select().where(PEOPLE.c.key == lookup_key(name))


def _admins() -> sa.Select[int]:
    may_sign_in = (PEOPLE.c.role == Role.ADMIN) & ~PEOPLE.c.disabled
    return sa.select(sa.func.count()).select_from(PEOPLE).where(may_sign_in)


def _assignable(role: Role) -> Role:
    if role not in ASSIGNABLE:
        raise Refused(CodedText("role-not-assignable", role=str(role)))
    return role


def _account(row: sa.RowMapping) -> Account:
    return Account(
        name=row["name"],
        role=Role(row["role"]),
        disabled=bool(row["disabled"]),
        created=row["created"],
    )
