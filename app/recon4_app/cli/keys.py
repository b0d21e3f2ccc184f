"""The commands ``recon4 keys …``: whose signatures count, on a server or for this person.

With ``--root`` they are the keys of the server of that folder, and what changes is in its audit
log; without it those of the person at this computer, for projects that lie below no server.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import write
from recon4.errors import ConfigError, StoreError
from recon4.locales.coded import CodedText
from recon4_app.cli.users import this_user

if TYPE_CHECKING:
    from recon4.review.trusted_keys import TrustedKeys

keys = typer.Typer(help="Whose signatures count on approved maps.")

RootOption = Annotated[
    Path | None,
    typer.Option(help="The folder given to recon4 serve; default: the keys of this person."),
]


@keys.command("list")
def list_all(root: RootOption = None) -> None:
    """List the keys: fingerprint, name, since when, public key."""
    trusted = _trusted(root)
    for key in sorted(trusted.keys.values(), key=lambda key: (not key.own, key.added)):
        state = f"removed {key.removed[:10]} by {key.removed_by}" if key.removed else "counts"
        own = "own" if key.own else f"added by {key.by}"
        write(f"{key.fingerprint}  {key.name}  ({own}, {key.added[:10]})  {state}")
        write(f"    {key.public_key}")
    if not trusted.keys:
        write("no keys")
    for text in trusted.damaged:
        write(f"damaged: {text}")
    if trusted.damaged:
        raise typer.Exit(1)


@keys.command()
def add(
    name: Annotated[str, typer.Argument(help="Whose it is, as it will be shown.")],
    public_key: Annotated[
        str, typer.Argument(help="64 hexadecimal digits, from recon4 keys list of the signer.")
    ],
    root: RootOption = None,
) -> None:
    """Count what a key signed. Compare the key with the signer first: by telephone, on paper."""
    from recon4.review.trusted_keys import add_key

    with _changing(root, "trust key") as change:
        key = add_key(change.trusted, name, public_key, by=this_user())
        change.what = f"{key.fingerprint} {key.name}"
    write(f"what {key.name} signs with the key {key.fingerprint} counts")


@keys.command()
def remove(
    wanted: Annotated[str, typer.Argument(help="Name, fingerprint or public key.")],
    root: RootOption = None,
) -> None:
    """Count nothing that a key signed, whenever it was."""
    from recon4.review.trusted_keys import remove_key

    with _changing(root, "remove key") as change:
        key = remove_key(change.trusted, wanted, by=this_user())
        change.what = f"{key.fingerprint} {key.name}"
    write(f"nothing signed with the key {key.fingerprint} ({key.name}) counts any more")


@keys.command()
def renew(
    root: Annotated[Path, typer.Option(help="The folder given to recon4 serve.")] = Path(),
) -> None:
    """Make another signing key for a server; what the earlier one signed still counts."""
    from recon4.review.trusted_keys import renew_own_key

    with _changing(root, "renew signing key") as change:
        key = renew_own_key(change.trusted.folder)
        change.what = key.fingerprint
    write(f"the server signs with the key {key.fingerprint} now")
    write(f"    {key.public_key}")


class _Change:
    """A change of the keys, and its object for the audit log."""

    def __init__(self, trusted: TrustedKeys) -> None:
        self.trusted = trusted
        self.what = ""


def _trusted(root: Path | None) -> TrustedKeys:
    from recon4.review.trusted_keys import STATE, personal_folder, read_keys

    if root is None:
        return read_keys(personal_folder(), server=False)
    if not (root / STATE).is_dir():
        raise ConfigError(CodedText("keys-no-server", root=str(root), state=STATE))
    return read_keys(root / STATE, server=True)


@contextmanager
def _changing(root: Path | None, action: str) -> Iterator[_Change]:
    """Change the keys; of a server with an entry in its audit log."""
    change = _Change(_trusted(root))
    if root is None:
        with _written(change):
            yield change
        return
    from recon4.archive.verify import state_change
    from recon4.review.trusted_keys import SIGNING_KEY, TRUSTED_KEYS
    from recon4_app.cli.users import access_of, note

    with _written(change), state_change(change.trusted.folder, SIGNING_KEY, TRUSTED_KEYS):
        yield change
    with access_of(root) as access:
        note(access, action, change.what)


@contextmanager
def _written(change: _Change) -> Iterator[None]:
    """Turn errors of the disk into ours."""
    try:
        yield
    except OSError as error:
        raise StoreError(
            CodedText("cannot-write", name=str(change.trusted.folder), why=str(error.strerror))
        ) from error
