"""Files of a delivery that were exported before: compared with their records, and packed."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from recon4.delivery.kinds import ExportedFile
from recon4.delivery.tuning import DELIVERIES
from recon4.errors import StoreError
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText
from recon4.progress import Progress


@dataclass(frozen=True, slots=True, kw_only=True)
class MadeFile:
    """A file that was exported before."""

    path: Path
    kind: str
    """Of `recon4.delivery.kinds.KINDS`."""
    options: ExportOptions
    made: ExportedFile

    @property
    def chosen(self) -> str:
        """How it was chosen, as the options of an export say it; empty = the whole map."""
        values = ((name, getattr(self.options, name)) for name in self.options.changed)
        return ", ".join(f"{name} {value}" for name, value in values)


def named(files: Sequence[str], made: Sequence[MadeFile]) -> dict[str, MadeFile]:
    """The files by their names in a delivery, which has others: ``map-2.laz``.

    Args:
        files: Names that are taken.
        made: What gets the next free ones.
    """
    taken, out = set(files), dict[str, MadeFile]()
    for one in made:
        name, number = one.kind, 1
        while name in taken:
            number += 1
            name = re.sub(r"\.", f"-{number}.", one.kind, count=1)
        taken.add(name)
        out[name] = one
    return out


def refuse_other_maps(made: Sequence[MadeFile], map_key: str, approval: str) -> None:
    """Refuse a file of an earlier map, or one that says something else of the approval.

    Raises:
        StoreError: If there is one.
    """
    for one in made:
        name = one.path.name
        if one.made.map_key != map_key:
            raise StoreError(CodedText("deliver-made-earlier", file=name))
        if one.made.approval != approval:
            was = one.made.approval
            raise StoreError(CodedText("deliver-made-state", file=name, was=was, now=approval))


def copy_made(one: MadeFile, target: Path, *, progress: Progress) -> None:
    """Copy a file, and compare it with the record of its export.

    Raises:
        OSError: If it cannot be written.
        StoreError: If it was removed, or is another one than was exported.
    """
    progress.start("copy", one.made.bytes, "B")
    digest = hashlib.sha256()
    try:
        source = one.path.open("rb")
    except OSError as error:
        raise StoreError(CodedText("deliver-made-gone", file=one.path.name)) from error
    with source, target.open("wb") as out:
        while block := source.read(DELIVERIES.block_bytes):
            digest.update(block)
            out.write(block)
            progress.advance(len(block))
    if digest.hexdigest() != one.made.sha256:
        raise StoreError(CodedText("deliver-made-altered", file=one.path.name))
