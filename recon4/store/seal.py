"""Seals: SHA-256 of the files of a folder that no manifest and no signature covers.

``seals.json`` has the size and hash of every such file, and its own hash. A file is marked
``open`` before it changes and sealed again afterwards: after a killed process it is known that the
file was being changed, not altered. The whole file is hashed, also the unused pages of a SQLite
file.

Seals detect damage and careless edits. They are not a signature: a person who can write the folder
can rewrite them. Approvals are signed (`recon4.review.approved`).
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TypedDict

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, text_of
from recon4.store.atomic import write_json
from recon4.store.checked import Altered, check_file
from recon4.store.formats import FORMATS
from recon4.store.hashing import FileDigest, files_below, hash_json
from recon4.store.json_files import parse_object
from recon4.store.locks import open_lock_file, wait_for_lock

SEALS = "seals.json"
LOCK = ".seals.lock"
TURN = ".changes.lock"


class Seal(TypedDict, total=False):
    """What a file has to be, as JSON: size and hash, or `OPEN`."""

    bytes: int
    sha256: str
    open: bool


OPEN: Seal = {"open": True}
"""Entry instead of size and hash: the file is being changed."""


def read_seals(root: Path) -> dict[str, Seal]:
    """Read file name -> ``bytes`` and ``sha256``, or `OPEN`; empty without ``seals.json``.

    Raises:
        Altered: If ``seals.json`` was changed.
    """
    path = root / SEALS
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise Altered(CodedText("seal-unreadable", file=SEALS, why=f"{error.strerror}")) from error
    try:
        found = parse_object(data, SEALS)
        files: dict[str, Seal] = found["files"]
        if found["format"] != FORMATS.seal or found["sha256"] != hash_json(files):
            raise ValueError(CodedText("seal-hash"))
        if data != seals_text(files).encode():
            raise ValueError(CodedText("seal-written"))
    except (StoreError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise Altered(CodedText("seal-altered", file=SEALS, why=text_of(error))) from error
    return files


def check_sealed(root: Path, name: str) -> None:
    """Compare a file, or all files below a folder, with their seals before they are used.

    Files without a seal, or open ones, are not checked. Files that were compared before and have
    the same inode, size and times are not read again.

    Raises:
        Altered: If a file, or ``seals.json``, was changed.
    """
    seals = read_seals(root)
    for one in _below(seals, (name,)):
        _compare(root, one, seals[one], remembered=True)


def compare_all(root: Path) -> Iterator[tuple[str, str]]:
    """Every sealed name with a message about its damage; empty = no damage.

    Raises:
        Altered: If ``seals.json`` was changed.
    """
    for name, seal in sorted(read_seals(root).items()):
        try:
            _compare(root, name, seal)
        except Altered as error:
            yield name, text_of(error)
        else:
            yield name, ""


@contextmanager
def changing(root: Path, *names: str, compared: bool = True) -> Iterator[None]:
    """Change files, or all files below folders, and seal them when the block ends.

    One block at a time runs for a folder. If it raises, the files are sealed as they are.

    Args:
        root: The folder that has the seals.
        names: Files and folders below it, with forward slashes; they need not exist.
        compared: Check the seals first; False = the files are rewritten completely.

    Raises:
        Altered: If a file does not match its seal; nothing was changed.
        StoreError: If the folder cannot be written.
    """
    with _locked(root / TURN):
        begin_change(root, names, compared=compared)
        try:
            yield
        finally:
            end_change(root, names)


def begin_change(
    root: Path, names: tuple[str, ...], *, compared: bool = True, missing_allowed: str = ""
) -> None:
    """Mark files as open; see `changing`. The mark is on the disk when this returns.

    Args:
        root: The folder that has the seals.
        names: Files and folders below it.
        compared: Check the seals first.
        missing_allowed: A file that may be missing; it is created again.
    """
    with _locked(root / LOCK):
        seals = read_seals(root)
        mine = _below(seals, names)
        for name in mine if compared else ():
            if name == missing_allowed and not (root / name).exists():
                continue
            _compare(root, name, seals[name], advice=True)
        _write(root, seals | dict.fromkeys([*mine, *names], OPEN))


def end_change(
    root: Path,
    names: tuple[str, ...],
    *,
    left_open: tuple[str, ...] = (),
    max_bytes: int | None = None,
) -> None:
    """Seal files as they are now, and remove the seals of missing files.

    Args:
        root: The folder that has the seals.
        names: Files and folders below it.
        left_open: Files that may still change; they stay open.
        max_bytes: Larger files get no seal; None = no limit.
    """
    with _locked(root / LOCK):
        seals = read_seals(root)
        for name in _below(seals, names):
            seals.pop(name)
        for name in names:
            seals.pop(name, None)
            path = root / name
            inside = [f"{name}/{one}" for one in files_below(path)] if path.is_dir() else [name]
            for one in inside:
                if one in left_open:
                    seals[one] = OPEN
                elif _is_sealable(root / one, max_bytes):
                    seals[one] = seal_of(root / one)
        _write(root, seals)


def _is_sealable(path: Path, max_bytes: int | None) -> bool:
    if not path.is_file() or path.is_symlink():
        return False
    return max_bytes is None or path.stat().st_size <= max_bytes


def adopt(root: Path, names: Iterator[str] | list[str]) -> None:
    """Seal files that have no seal yet; existing seals are kept."""
    with _locked(root / LOCK):
        seals = read_seals(root)
        fresh = {name: seal_of(root / name) for name in names if name not in seals}
        if fresh:
            _write(root, seals | fresh)


def seal_of(path: Path) -> Seal:
    """Size and hash of a file."""
    digest = FileDigest.of(path)
    return {"bytes": digest.size, "sha256": digest.sha256}


def _compare(
    root: Path, name: str, seal: Seal, *, advice: bool = False, remembered: bool = False
) -> None:
    if seal == OPEN:
        return
    try:
        expected = FileDigest(int(seal["bytes"]), str(seal["sha256"]), b"")
        check_file(root / name, expected, remembered=remembered)
    except (KeyError, ValueError, TypeError) as error:
        raise Altered(CodedText("seal-entry", file=SEALS, name=name, why=f"{error!r}")) from error
    except Altered as error:
        message = f"{name} is not what recon4 wrote: {error}"
        more = (
            "; put it back from a backup, or take it as it is with the command recon4 verify "
            f"--accept {root}; "
            "if it is the ledger, move it away: finished stages are found by their artifacts"
        )
        raise Altered(message + more if advice else message) from error


def _below(seals: Mapping[str, Seal], names: tuple[str, ...]) -> list[str]:
    return [one for one in seals if any(one == n or one.startswith(f"{n}/") for n in names)]


def _write(root: Path, seals: Mapping[str, Seal]) -> None:
    write_json(root / SEALS, _value(seals))


def _value(seals: Mapping[str, Seal]) -> dict[str, object]:
    files = {name: dict(seals[name]) for name in sorted(seals)}
    return {"format": FORMATS.seal, "sha256": hash_json(files), "files": files}


def seals_text(seals: Mapping[str, Seal]) -> str:
    """Content of ``seals.json`` for these seals."""
    return json.dumps(_value(seals), indent=1, allow_nan=False, ensure_ascii=False) + "\n"


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    try:
        descriptor = open_lock_file(path, 0o644)
    except OSError as error:
        raise StoreError(
            CodedText("lock-failed", folder=str(path), why=f"{error.strerror}")
        ) from error
    try:
        wait_for_lock(descriptor)
        yield
    finally:
        os.close(descriptor)
