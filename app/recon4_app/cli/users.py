"""The commands ``recon4 users …``: who may sign in to the server of a folder, and its audit log.

They write to the same database as a running server; what they change counts there within seconds.
"""

from __future__ import annotations

import getpass
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import write
from recon4.errors import StoreError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4_app.access.audit import AuditLog
    from recon4_app.access.login.login_service import Access
    from recon4_app.access.people import Role

users = typer.Typer(help="Who may sign in to `recon4 serve --lan`, and what they did.")

NameArgument = Annotated[str, typer.Argument(help="As the person signs in.")]
RoleOption = Annotated[str, typer.Option(help="viewer, operator, reviewer or admin.")]
RootOption = Annotated[Path, typer.Option(help="The folder given to recon4 serve.")]


@users.command()
def add(name: NameArgument, role: RoleOption, root: RootOption = Path()) -> None:
    """Add a person; asks for the password, or reads it from a pipe."""
    with access_of(root) as access:
        account = access.accounts.add(name, _role(role), _password())
        note(access, "add person", f"{account.name}, {account.role}")
    write(f"{account.name} may sign in as {account.role}")


@users.command("list")
def list_all(root: RootOption = Path()) -> None:
    """List everybody."""
    with access_of(root) as access:
        for one in access.accounts.all():
            state = "disabled" if one.disabled else ""
            write(f"{one.name:<32} {one.role:<10} {one.created[:10]} {state}".rstrip())


@users.command()
def role(
    name: NameArgument,
    role: Annotated[str, typer.Argument(help="viewer, operator, reviewer or admin.")],
    root: RootOption = Path(),
) -> None:
    """Give a person another role; ends the person's sessions."""
    with access_of(root) as access:
        account = access.accounts.set_role(name, _role(role))
        note(access, "set role", f"{account.name}, {account.role}")
    write(f"{account.name} is {account.role} now")


@users.command()
def disable(
    name: NameArgument,
    root: RootOption = Path(),
    again: Annotated[bool, typer.Option("--undo", help="Let the person in again.")] = False,
) -> None:
    """Lock a person out; ends the person's sessions."""
    with access_of(root) as access:
        account = access.accounts.set_disabled(name, not again)
        note(access, "enable" if again else "disable", account.name)
    write(f"{account.name} {'may' if again else 'may not'} sign in")


@users.command()
def password(name: NameArgument, root: RootOption = Path()) -> None:
    """Set a person's password; ends the person's sessions."""
    with access_of(root) as access:
        account = access.accounts.set_password(name, _password())
        note(access, "set password", account.name)
    write(f"the password of {account.name} is set")


@users.command()
def audit(
    root: RootOption = Path(),
    last: Annotated[int, typer.Option(min=1, help="Number of entries to show.")] = 50,
) -> None:
    """Show the audit log and check its chain of hashes; exit code 1 if it was tampered with."""
    log = _log_of(root)
    for one in reversed(log.newest(last)):
        what = f"{one.person} ({one.address}) {one.action}: {one.object}"
        write(f"{one.number:>6} {one.time} {one.outcome:<8} {what}")
    chain = log.verify()
    if chain.broken_at is not None:
        write(f"entry {chain.broken_at} does not follow from the one before: tampered with")
        raise typer.Exit(1)
    write(f"{chain.last_number} entries, chain whole; newest hash {chain.head_hash}")


@users.command("metrics-token")
def metrics_token(
    root: RootOption = Path(),
    renew: Annotated[bool, typer.Option("--renew", help="Replace it; the old one ends.")] = False,
) -> None:
    """Show the token with which a program reads /metrics; made the first time."""
    from recon4_app.metrics_routes import make_metrics_token

    with access_of(root) as access:
        token = make_metrics_token(root / ".recon4", renew=renew)
        note(access, "show metrics token", "renewed" if renew else "")
    write(token)


def _log_of(root: Path) -> AuditLog:
    """The audit log, to be read only: also where nothing can be written."""
    from recon4_app.access.audit import AuditLog
    from recon4_app.access.database import open_to_read
    from recon4_app.access.restoring import ACCESS_FILE, check_access
    from recon4_app.settings import ServerSettings

    state = ServerSettings(root=root).state
    if not (state / ACCESS_FILE).exists():
        raise StoreError(CodedText("users-no-log", root=str(root)))
    check_access(state)
    return AuditLog(open_to_read(state / ACCESS_FILE))


@contextmanager
def access_of(root: Path) -> Iterator[Access]:
    """Open the access database below a folder of projects, to change it."""
    from recon4.archive.verify import state_change
    from recon4_app.access.login.login_service import open_access
    from recon4_app.access.restoring import check_access
    from recon4_app.errors import AppError
    from recon4_app.network.listen import make_state
    from recon4_app.settings import ServerSettings

    settings = ServerSettings(root=root)
    make_state(settings)
    check_access(settings.state)
    with state_change(settings.state, "access.sqlite"):
        access = open_access(settings.state, login=True)
        try:
            yield access
        except AppError as error:
            raise StoreError(str(error)) from error
        finally:
            access.close()


def _role(text: str) -> Role:
    from recon4_app.access.people import ASSIGNABLE, Role

    roles = [one.value for one in ASSIGNABLE]
    if text not in roles:
        raise typer.BadParameter(CodedText("users-role", text=text, roles=", ".join(roles)))
    return Role(text)


def _password() -> str:
    """From the terminal without showing it, else the first line of the input."""
    if not sys.stdin.isatty():
        return sys.stdin.readline().rstrip("\n")
    first = getpass.getpass("Password: ")
    if first != getpass.getpass("Once more: "):
        raise typer.BadParameter(CodedText("users-passwords"))
    return first


def note(access: Access, action: str, what: str) -> None:
    """Append what a person did at this computer to the audit log."""
    access.log.add(this_user(), "this computer", action=action, what=what)


def this_user() -> str:
    """Name of the user of this process; its number if it has no name, as in containers."""
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return f"user {os.getuid()}"
