"""The command ``recon4 storage``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.terminal import in_terminal, say, worded, write, write_json
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from collections.abc import Sequence

    from recon4.archive.space import Freeable, StoredPart

space = typer.Typer()

FreeOption = Annotated[
    list[str] | None,
    typer.Option(
        "--free",
        metavar="WHAT",
        help="What is removed: earlier (of earlier runs), frames (points as recorded), map (its "
        "tiles; map.laz stays); repeatable. Processing the recording again makes it again.",
    ),
]


@space.command()
def storage(
    project: Annotated[Path, typer.Argument(help="A project.")],
    *,
    free: FreeOption = None,
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON for programs.")] = False,
) -> None:
    """Say what takes the space of a project, and free what can be made again.

    What an approval needs always stays.
    """
    from recon4.archive.space import free_space, stored_parts
    from recon4.cli.confinement import confine_command

    confine_command(write=[project])  # SQLite makes files beside what it reads
    chosen = _chosen(free or [])
    freed = free_space(project, chosen) if chosen else ()
    parts = stored_parts(project)
    if as_json:
        write_json({"parts": parts, "freed": freed})
        return
    _show(parts)
    if chosen:
        say("storage-freed", size=_size(freed), count=len(freed))


def _chosen(words: Sequence[str]) -> list[Freeable]:
    """What the words of the option mean.

    Raises:
        ConfigError: If one is not known.
    """
    from recon4.archive.space import Freeable

    for word in words:
        if word not in set(Freeable):
            known = ", ".join(Freeable)
            raise ConfigError(CodedText("storage-free", word=word, known=known))
    return [Freeable(word) for word in words]


def _show(parts: Sequence[StoredPart]) -> None:
    for part in parts:
        end = f"--free {part.freeable}" if part.freeable else in_terminal(part.why)
        write(f"{_size([part]):>10}  {part.what:<24}{end}".rstrip())
    write(f"{_size(parts):>10}  {worded('storage-in-all')}")
    freeable = [part for part in parts if part.freeable]
    if freeable:
        write(f"{_size(freeable):>10}  {worded('storage-freeable')}")


def _size(parts: Sequence[StoredPart]) -> str:
    return worded("stored-size", bytes=sum(part.bytes for part in parts))
