"""A project: one folder that can be zipped, moved and opened elsewhere."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4.errors import NoSpace, StoreError
from recon4.locales.coded import CodedText
from recon4.store.atomic import make_folders, raise_if_full, sweep, write_json
from recon4.store.formats import FORMATS
from recon4.store.json_files import read_object
from recon4.store.ledger import FinishedStage, Ledger
from recon4.store.locks import open_lock_file, try_lock
from recon4.store.seal import adopt, begin_change, end_change
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.names import visible

LEDGER = "ledger.sqlite"
SUMMARY = "summary.json"
SEALED = ("project.json", LEDGER)
"""Files that change while a project is open and are sealed when it is closed."""


@dataclass(frozen=True, slots=True)
class InputFile:
    """An input file of the run."""

    name: str
    size_bytes: int
    sha256: str


@dataclass(frozen=True, slots=True)
class ProjectDescription:
    """What ``project.json`` says of a run."""

    name: str
    preset: str
    """What the settings started from."""
    inputs: tuple[InputFile, ...] = ()

    @staticmethod
    def read(root: Path) -> ProjectDescription:
        """Read it without opening the project.

        Raises:
            StoreError: If ``project.json`` is missing or damaged.
        """
        found = read_description(root)
        try:
            inputs = tuple(
                InputFile(file["name"], file["bytes"], file["sha256"])
                for file in found.get("inputs", ())
            )
            return ProjectDescription(found["name"], found.get("preset", ""), inputs)
        except (KeyError, TypeError) as error:
            raise StoreError(
                CodedText(
                    "project-file-unreadable", file=str(root / "project.json"), why=f"{error!r}"
                )
            ) from error


class Project:
    """An open project folder; while it is open no other process can open it.

    Layout and rules: ``docs/explanation/stages.md``. Reading needs no lock: `read_description`.
    """

    def __init__(self, root: Path, ledger: Ledger, lock: int) -> None:
        self.root = root
        self.ledger = ledger
        self._lock = lock

    @staticmethod
    def open(root: Path) -> Project:
        """Open a project, or create one in an empty or missing folder.

        Temporary files of a killed run are removed; unknown folders are ignored.

        Raises:
            NoSpace: If the disk is full.
            StoreError: If the folder is not a project, in use, damaged or not writable.
        """
        _make_folder(root)
        lock = _lock(root / ".lock")
        try:
            sweep(root)
            sweep(root / "artifacts")
            begin_change(root, SEALED, missing_allowed=LEDGER)
            return Project(root, Ledger(root / LEDGER), lock)
        except BaseException:
            os.close(lock)
            raise

    @property
    def artifacts(self) -> Path:
        """Folder of the finished stages."""
        return self.root / "artifacts"

    def describe(self, **fields: Any) -> None:
        """Add fields to ``project.json`` (name, rig, preset, what was imported)."""
        write_json(self.root / "project.json", read_description(self.root) | fields)

    def close(self) -> None:
        """Close the ledger, seal the changed files and release the lock."""
        try:
            whole = self._settle()
            end_change(self.root, SEALED, left_open=() if whole else (LEDGER,))
            adopt(self.root, loose_files(self.root))
        except NoSpace:
            return  # the files stay marked as open: verify reports it, and the next run seals them
        finally:
            os.close(self._lock)

    def _settle(self) -> bool:
        """Close the ledger; returns whether the file is complete without a write-ahead log."""
        try:
            return self.ledger.settle()
        except NoSpace:
            return False
        finally:
            self.ledger.close()

    def __enter__(self) -> Project:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def is_project(root: Path) -> bool:
    """Whether a folder is a recon4 project."""
    return (root / "project.json").is_file()


def discard_unbegun(root: Path) -> None:
    """Remove a project that has no finished stage; its folder stays if that may not be removed.

    Raises:
        StoreError: If its ledger is damaged.
    """
    if (root / LEDGER).exists() and read_stages(root):
        return
    shutil.rmtree(root, ignore_errors=True)


def read_description(root: Path) -> dict[str, Any]:
    """Read ``project.json`` without opening the project.

    Raises:
        StoreError: If it is missing or damaged.
    """
    path = root / "project.json"
    if not path.exists():
        code = "project-none" if root.exists() else "project-missing"
        raise StoreError(CodedText(code, folder=str(root)))
    found = read_object(path, max_bytes=LIMITS.description_bytes)
    if found.get("format") != FORMATS.project:
        raise StoreError(CodedText("project-format", file=str(path), format=FORMATS.project))
    return found


def read_stages(root: Path) -> list[FinishedStage]:
    """Read the finished stages of a project, which another process may have open.

    Raises:
        StoreError: If the folder is not a project or its ledger is damaged.
    """
    with _reading(root) as ledger:
        return ledger.stages()


class _Artifacts(dict[str, Path]):
    """Stage name -> folder of its artifact; a stage without one is an error with a remedy."""

    def __missing__(self, stage: str) -> Path:
        raise StoreError(CodedText("project-no-artifact", stage=stage))


def read_artifacts(root: Path) -> dict[str, Path]:
    """Read stage name -> folder of its artifact in the latest run; the project may be open.

    What it returns raises `StoreError` for the name of a stage that has no artifact.

    Raises:
        StoreError: If the folder is not a project or its ledger is damaged.
    """
    with _reading(root) as ledger:
        current = ledger.current().items()
        return _Artifacts((stage, root / "artifacts" / key) for stage, key in current)


def _reading(root: Path) -> Ledger:
    read_description(root)
    return Ledger(root / LEDGER, read_only=True)


def loose_files(root: Path) -> Iterator[str]:
    """Files written by a run whose hash is in no other file."""
    for pattern in ("project.json", SUMMARY, LEDGER, "artifacts/[!.]*/manifest.json"):
        yield from (path.relative_to(root).as_posix() for path in sorted(root.glob(pattern)))
    for path in sorted(root.glob("versions/[0-9]*/approval.json")):
        yield path.relative_to(root).as_posix()


def _make_folder(root: Path) -> None:
    try:
        make_folders(root)
        if not is_project(root):
            _refuse_foreign(root)
            created = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
            name = visible(root.resolve().name)
            write_json(
                root / "project.json", {"format": FORMATS.project, "name": name, "created": created}
            )
        read_description(root)
        make_folders(root / "artifacts")
    except OSError as error:
        raise_if_full(error, root)
        raise StoreError(
            CodedText("project-unusable", folder=str(root), why=f"{error.strerror}")
        ) from error


def _refuse_foreign(root: Path) -> None:
    sweep(root)
    others = sorted(entry.name for entry in root.iterdir())
    if others:
        raise StoreError(CodedText("project-not-empty", folder=str(root), what=f"{others[0]!r}"))


def _lock(path: Path) -> int:
    try:
        descriptor = open_lock_file(path, 0o644)
    except OSError as error:
        raise_if_full(error, path)
        raise StoreError(
            CodedText("lock-failed", folder=str(path.parent), why=f"{error.strerror}")
        ) from error
    try:
        locked = try_lock(descriptor)
    except OSError as error:
        os.close(descriptor)
        raise StoreError(
            CodedText("lock-failed", folder=str(path.parent), why=f"{error.strerror}")
        ) from error
    if not locked:
        os.close(descriptor)
        raise StoreError(CodedText("project-in-use", folder=str(path.parent)))
    return descriptor
