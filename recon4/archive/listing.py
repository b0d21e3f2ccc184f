"""The listing of a backup: which file has which bytes. It may come from other people."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import msgspec

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.formats import FORMATS
from recon4.store.hashing import hash_json
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import as_type

_LIST = re.compile(r"\d{4}-\d{2}-\d{2}T\d{2}-\d{2}-\d{2}Z(-\d+)?\.json")


@dataclass(frozen=True, slots=True)
class BackedUpFile:
    """A file in the listing of a backup."""

    bytes: int
    sha256: str
    mode: int
    """Permissions."""


Entries = dict[str, BackedUpFile]
"""By relative name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BackupListing:
    """The listing of a backup; its file also has the SHA-256 of these fields."""

    format: int
    made: str
    """UTC, as in its name."""
    with_keys: bool
    left_out: list[str]
    """Files that changed while they were copied."""
    files: Entries


def newest(backup: Path) -> Path:
    """The listing at a path: the file itself, or the newest one in a folder.

    Raises:
        StoreError: If there is none.
    """
    if backup.is_file():
        return backup
    lists = sorted(p for p in backup.glob("*.json") if _LIST.fullmatch(p.name))
    if not lists:
        raise StoreError(CodedText("backup-none", backup=str(backup)))
    return lists[-1]


def read_list(path: Path) -> BackupListing:
    """Read the listing of a backup.

    Raises:
        StoreError: If it is damaged, has another format, or a name leads outside the backup.
    """
    record = read_object(path, max_bytes=1 << 30)
    body = {name: value for name, value in record.items() if name != "sha256"}
    if record.get("format") != FORMATS.backup or record.get("sha256") != hash_json(body):
        raise StoreError(CodedText("backup-changed", file=str(path)))
    try:
        listing = as_type(body, BackupListing)
    except msgspec.ValidationError as error:
        raise StoreError(CodedText("backup-no-listing", file=str(path), why=str(error))) from error
    for name, entry in listing.files.items():
        _check_entry(path, name, entry)
    return listing


def _check_entry(path: Path, name: str, entry: BackedUpFile) -> None:
    inside = PurePosixPath(name)
    if inside.is_absolute() or ".." in inside.parts or not inside.parts:
        raise StoreError(CodedText("backup-outside", file=str(path), name=name[:100]))
    if "\0" in name or inside.as_posix() != name:
        raise StoreError(CodedText("backup-no-name", file=str(path), name=name[:100]))
    if len(inside.parts) > LIMITS.folders:
        raise StoreError(
            CodedText(
                "backup-folders",
                file=str(path),
                name=name[:100],
                folders=LIMITS.folders,
                count=len(inside.parts),
            )
        )
    if entry.bytes < 0:
        raise StoreError(
            CodedText("backup-bytes", file=str(path), name=name[:100], bytes=entry.bytes)
        )
