"""The commands ``recon4 backup`` and ``recon4 restore``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from recon4.cli.terminal import say, write_json

backups = typer.Typer()

KeysOption = Annotated[
    bool,
    typer.Option(
        "--with-keys",
        help="Also the signing key, trusted keys, TLS keys, and people with their passwords.",
    ),
]


@backups.command()
def backup(
    root: Annotated[Path, typer.Argument(help="Folder of a server, or one project.")],
    *,
    out: Annotated[Path, typer.Option(help="Folder of backups, best on another disk.")],
    with_keys: KeysOption = False,
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON for programs.")] = False,
) -> None:
    """Copy what is new since the last backup, also while a server runs; compare what was written.

    Exit code 1: files were damaged before they were copied. The backup holds them as found.
    """
    from recon4.archive.backup import back_up, to_json
    from recon4.cli.terminal import watcher

    with watcher() as progress:
        made = back_up(root, out, with_keys=with_keys, progress=progress)
    if as_json:
        write_json(to_json(made))
    else:
        for name in made.left_out:
            say("backup-left-out", name=name)
        for name in made.damaged:
            say("backup-damaged", name=name)
        say(
            "backup-made",
            path=str(made.path),
            files=made.files,
            bytes=made.bytes,
            new_bytes=made.new_bytes,
        )
        if not with_keys:
            say("backup-no-keys")
    if made.damaged:
        raise typer.Exit(1)


@backups.command()
def restore(
    backup: Annotated[Path, typer.Argument(help="A backup, or a folder of them: the newest.")],
    root: Annotated[Path, typer.Argument(help="Folder that is missing or empty.")],
    *,
    with_keys: KeysOption = False,
) -> None:
    """Put a backup into an empty folder; a byte that differs is refused, and nothing is left."""
    from recon4.archive.backup import restore as put
    from recon4.cli.terminal import watcher

    with watcher() as progress:
        files = put(backup, root, with_keys=with_keys, progress=progress)
    say("restored-files", files=files, root=str(root))
    if not with_keys:
        say("restored-no-keys")
