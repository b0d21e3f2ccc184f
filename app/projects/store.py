"""Projects are the folders below the root. Nothing else is kept about them."""

from __future__ import annotations

import json
import os
import re
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from app.errors import NotFound, Refused
from app.projects.model import RESULTS, STAGE_ORDER, Entry, FinishedStage, Project, ResultFile
from recon4.errors import StoreError
from recon4.store.project import is_project, read_artifacts, read_stages

PROJECT_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")
MOST_ENTRIES = 2000
"""A longer folder listing is cut."""


class ProjectStore:
    """Reads project folders. Paths are made from checked names only."""

    def __init__(self, root: Path, import_roots: tuple[Path, ...]) -> None:
        self._root = root.resolve()
        self._import_roots = import_roots

    def all(self) -> list[Project]:
        """Every project, the newest first."""
        folders = [entry for entry in self._root.iterdir() if _is_project(entry)]
        return sorted((self._read(f) for f in folders), key=lambda p: p.updated, reverse=True)

    def get(self, project_id: str) -> Project:
        """One project.

        Raises:
            NotFound: If there is none of that name.
        """
        return self._read(self.folder(project_id))

    def folder(self, project_id: str) -> Path:
        """A project's folder.

        Raises:
            NotFound: If there is none of that name.
        """
        folder = self._root / project_id
        if not PROJECT_ID.fullmatch(project_id) or not _is_project(folder):
            raise NotFound(f"no project {project_id[:64]!r}")
        return folder

    def result(self, project_id: str, name: str) -> Path:
        """A result file.

        Raises:
            NotFound: If the project, or the file in it, does not exist.
        """
        folder = self.folder(project_id)
        if name not in RESULTS or not _is_result(folder, name):
            raise NotFound(f"project {project_id} has no file {name[:64]!r}")
        return folder / name

    def map_artifact(self, project_id: str) -> Path:
        """The artifact of the stage ``map`` of the latest run.

        Raises:
            NotFound: If there is none yet.
        """
        artifacts = _artifacts(self.folder(project_id))
        if "map" not in artifacts:
            raise NotFound(f"project {project_id} has no map yet")
        return artifacts["map"]

    def importable(self, path: str) -> Path:
        """A recording's path, if the server may read it.

        Raises:
            Refused: If it is outside of the folders recordings may lie in.
            NotFound: If it does not exist.
        """
        try:
            real = Path(path).resolve()
        except (OSError, ValueError) as error:
            raise NotFound(f"no such file or folder: {path[:200]!r}") from error
        if not any(real.is_relative_to(root) for root in self._import_roots):
            roots = ", ".join(str(root) for root in self._import_roots)
            raise Refused(
                f"recordings may only lie in {roots}; name more folders in RECON4_RECORDINGS"
            )
        if not real.exists():
            raise NotFound(f"no such file or folder: {path[:200]!r}")
        return real

    def browse(self, folder: str) -> list[Entry]:
        """What lies in a folder, or the folders to begin with when none is given.

        Raises:
            Refused: If it is outside of the folders recordings may lie in.
            NotFound: If it is not a folder.
        """
        if not folder:
            return [_entry(root, str(root)) for root in self._import_roots]
        real = self.importable(folder)
        if not real.is_dir():
            raise NotFound(f"{real} is not a folder")
        shown = [path for path in real.iterdir() if not path.name.startswith(".")]
        shown.sort(key=lambda path: (not path.is_dir(), path.name.lower()))
        return [_entry(path, path.name) for path in shown[:MOST_ENTRIES]]

    def _read(self, folder: Path) -> Project:
        facts = _json(folder / "project.json")
        size, changed_s = _weigh(folder)
        stages = _stages(folder)
        return Project(
            id=folder.name,
            name=str(facts.get("name") or folder.name),
            finished=(folder / "summary.json").exists(),
            updated=datetime.fromtimestamp(changed_s, UTC).isoformat(timespec="seconds"),
            bytes=size,
            preset=str(facts.get("preset") or ""),
            rig=_name_of(facts.get("rig")),
            files=tuple(_results(folder)),
            stages=stages,
            viewable=any(stage.stage in ("odometry", "map") for stage in stages),
            pictured=any(stage.stage == "map" for stage in stages),
            summary=_json(folder / "summary.json"),
        )


def _is_project(folder: Path) -> bool:
    """A folder of a fit name with a ``project.json``, not a link to somewhere else."""
    return (
        PROJECT_ID.fullmatch(folder.name) is not None
        and not folder.is_symlink()
        and is_project(folder)
    )


def _is_result(folder: Path, name: str) -> bool:
    path = folder / name
    return path.is_file() and path.resolve().is_relative_to(folder)


def _results(folder: Path) -> list[ResultFile]:
    return [
        ResultFile(name=name, words=words, bytes=(folder / name).stat().st_size)
        for name, words in RESULTS.items()
        if _is_result(folder, name)
    ]


def _artifacts(folder: Path) -> dict[str, Path]:
    """Stage -> its artifact in the latest run; none when the ledger is missing or damaged."""
    try:
        return read_artifacts(folder) if (folder / "ledger.sqlite").exists() else {}
    except StoreError:
        return {}


def _stages(folder: Path) -> tuple[FinishedStage, ...]:
    """Stages of the latest run in the order of the pipeline."""
    current = {path.name for path in _artifacts(folder).values()}
    if not current:
        return ()
    order = {stage: k for k, stage in enumerate(STAGE_ORDER)}
    rows = [row for row in read_stages(folder) if row.key in current]
    return tuple(
        FinishedStage(
            stage=row.stage, seconds=row.seconds, peak_bytes=row.peak_bytes, finished=row.finished
        )
        for row in sorted(rows, key=lambda row: order.get(row.stage, len(order)))
    )


def _json(path: Path) -> dict[str, Any]:
    """A JSON object; empty when it is missing or damaged, as a page shows what there is."""
    try:
        value = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return {}
    return value if isinstance(value, dict) else {}


def _name_of(rig: Any) -> str:
    return str(rig.get("name", "")) if isinstance(rig, dict) else str(rig or "")


def _weigh(folder: Path) -> tuple[int, float]:
    """Bytes below a folder and when its newest file changed [s]."""
    size, changed_s = 0, 0.0
    for parent, _, names in os.walk(folder):
        for name in names:
            try:
                status = os.stat(os.path.join(parent, name), follow_symlinks=False)
            except FileNotFoundError:
                continue  # a running job tidies up
            size += status.st_size
            if not name.startswith("ledger"):  # reading touches it too
                changed_s = max(changed_s, status.st_mtime)
    return size, changed_s


def _entry(path: Path, name: str) -> Entry:
    folder = path.is_dir()
    size = 0 if folder or not path.is_file() else path.stat().st_size
    return Entry(name=name, path=str(path), folder=folder, bytes=size)
