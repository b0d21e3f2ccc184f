"""Verification of a project: compare every byte with the stored hashes."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, at, text_of
from recon4.progress import Progress, track
from recon4.store.checked import Altered
from recon4.store.hashing import files_below, hash_file
from recon4.store.json_files import read_object
from recon4.store.ledger import FinishedStage
from recon4.store.project import (
    LEDGER,
    SUMMARY,
    is_project,
    loose_files,
    read_artifacts,
    read_description,
    read_stages,
)
from recon4.store.seal import OPEN, compare_all, read_seals
from recon4.store.sqlite_files import connect_to_read
from recon4.store.stage import damage_of, read_manifest

_JOURNAL = "decisions.sqlite"
LATER_FOLDERS = ("annotations", "slices")
"""Folders of a project that are written after a run; their files are sealed."""


@dataclass(frozen=True, slots=True)
class VerifiedFiles:
    """Result of a verification."""

    checked: int
    """Number of artifacts, results and sealed files whose bytes were compared."""
    damaged: tuple[str, ...]
    """Messages about differences; empty = no damage."""
    unknown: tuple[str, ...]
    """Entries below ``artifacts/`` that belong to no stage; they are ignored."""
    notes: tuple[str, ...] = ()
    """Messages about files of which only the content could be checked, and why."""


def verify_files(root: Path, progress: Progress) -> VerifiedFiles:
    """Compare every artifact, result and sealed file of a project with its stored hash.

    Raises:
        StoreError: If the folder is not a project.
    """
    if not is_project(root):
        read_description(root)
    sealed, damaged, notes = verify_seals(root, [*loose_files(root), *_later_files(root)])
    stages, known = _ledger(root, damaged)
    for row in track(stages, progress, what="artifacts", unit="artifacts"):
        damaged += _each(f"{row.stage} {row.key[:12]}", _stage_damage(root, row))
    results = _result_hashes(root, damaged)
    for name, sha256 in track(results.items(), progress, what="results", unit="files"):
        path = root / name
        if not path.is_file():
            damaged.append(CodedText("damage-missing", name=name))
        elif hash_file(path) != sha256:
            damaged.append(CodedText("damage-bytes", name=name))
    folder = root / "artifacts"
    there = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
    unknown = tuple(name for name in there if name not in known)
    checked = len(stages) + len(results) + sealed
    return VerifiedFiles(checked, tuple(dict.fromkeys(damaged)), unknown, tuple(notes))


def verify_seals(root: Path, expected: list[str]) -> tuple[int, list[str], list[str]]:
    """Compare sealed files with their seals.

    Args:
        root: The folder that has the seals.
        expected: Files that should have one.

    Returns:
        Number of compared files, messages about differences, and notes on files without a seal.
    """
    try:
        seals = read_seals(root)
        found = list(compare_all(root))
    except Altered as error:
        return 0, [text_of(error)], []
    damaged = [message for _, message in found if message]
    notes: list[str] = []
    for name in sorted({*expected, *seals}):
        seal = seals.get(name)
        if seal is not None and seal != OPEN:
            continue
        notes.append(CodedText("seal-none" if seal is None else "seal-open", name=name))
        damaged += content_damage(root / name)
    return len(found), damaged, notes


def content_damage(path: Path) -> list[str]:
    """Check the content of a file that has no hash: integrity of SQLite, syntax of JSON."""
    try:
        if path.suffix == ".sqlite" and path.exists():
            with closing(connect_to_read(path)) as db:
                messages = [str(row[0]) for row in db.execute("PRAGMA integrity_check(5)")]
            return [] if messages == ["ok"] else _each(path.name, messages[:1])
        if path.suffix == ".json" and path.exists():
            read_object(path)
    except (sqlite3.Error, StoreError) as error:
        return _each(path.name, [text_of(error)])
    return []


def _each(of: str, messages: Iterable[str]) -> list[str]:
    """Messages with what they are of."""
    return [at(of, one) for one in messages]


def _later_files(root: Path) -> Iterator[str]:
    """Files that are written after a run: decisions, slices, notes and saved views."""
    if (root / _JOURNAL).exists():
        yield _JOURNAL
    for folder in LATER_FOLDERS:
        yield from (f"{folder}/{name}" for name in files_below(root / folder))


def _ledger(root: Path, damaged: list[str]) -> tuple[list[FinishedStage], set[str]]:
    try:
        stages = read_stages(root)
        current = {path.name for path in read_artifacts(root).values()}
    except StoreError as error:
        damaged.append(text_of(error))
        return [], set()
    return stages, {row.key for row in stages} | current


def _stage_damage(root: Path, row: FinishedStage) -> list[str]:
    folder = root / "artifacts" / str(row.key)
    if not folder.is_dir():
        return [CodedText("damage-folder")]
    damage = damage_of(folder, hashes=True)
    try:
        if read_manifest(folder)["done"] != asdict(row):
            damage.append(CodedText("damage-records", ledger=LEDGER))
    except StoreError as error:
        damage.append(text_of(error))
    return damage


def _result_hashes(root: Path, damaged: list[str]) -> dict[str, str]:
    if not (root / SUMMARY).is_file():
        return {}
    try:
        hashes: Any = read_object(root / SUMMARY).get("hashes", {}).get("results", {})
        return {str(name): str(sha256) for name, sha256 in hashes.items()}
    except (StoreError, AttributeError) as error:
        damaged += _each(SUMMARY, [text_of(error)])
        return {}
