"""Projects are the folders below the root. Nothing else is kept about them."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.model.usability import Usability
from recon4.review.approval_state import ApprovalState, approval_state, not_valid
from recon4.review.approved import approval_of
from recon4.review.state import artifact_keys
from recon4.store.earlier_names import SUMMARY, current_names
from recon4.store.json_files import read_object
from recon4.store.ledger import FinishedStage as StageRow
from recon4.store.project import Project as Folder
from recon4.store.project import is_project, read_artifacts, read_stages
from recon4.untrusted.names import visible
from recon4_app.errors import Conflict, NotFound, project_page
from recon4_app.projects.clone import clone_artifacts
from recon4_app.projects.folder_names import free_folder_name
from recon4_app.projects.folder_times import Stamp, iso, stamp_of, weigh
from recon4_app.projects.import_folders import ImportFolders
from recon4_app.projects.model import (
    RESULTS,
    STAGE_ORDER,
    VIEWABLE_STAGES,
    FolderEntry,
    ProjectCard,
    ProjectView,
    ResultFile,
    StageView,
)
from recon4_app.projects.tuning import PROJECT_LIST

RESERVED = frozenset({"recordings", "rigs"})
"""Folders of uploads and of rigs, beside those of projects."""
PROJECT_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


class ProjectStore:
    """Reads project folders. Paths are made from checked names only."""

    def __init__(self, root: Path, imports: ImportFolders) -> None:
        self._root = root.resolve()
        self.imports = imports
        """Files of this computer that requests may name."""
        self._cards: dict[str, tuple[Stamp, ProjectCard]] = {}

    def all(self) -> list[ProjectCard]:
        """All projects, the newest first. Unchanged folders are not read again."""
        with os.scandir(self._root) as entries:
            found = [card for entry in entries if (card := self._card(entry)) is not None]
        return sorted(found, key=lambda card: card.updated, reverse=True)

    def get(self, project_id: str) -> ProjectView:
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

    def refuse_taken(self, name: str) -> None:
        """Check that a name is free for a new project.

        Raises:
            Conflict: If there is a project or another folder of that name.
        """
        self.refuse_reserved(name)
        if (self._root / name).exists():
            raise Conflict(
                f"there is a project or folder {name} already: choose another name, or run the "
                "project again from its own page",
                remedy=project_page(name) if is_project(self._root / name) else None,
            )

    def refuse_reserved(self, name: str) -> None:
        """Check that a project of a name may exist; one of an earlier version may stay.

        Raises:
            Conflict: If the server itself uses the folder of that name.
        """
        if name in RESERVED and not is_project(self._root / name):
            raise Conflict(f"{name} is a folder of the server: choose another name")

    def free_folder_name(self, title: str, is_promised: Callable[[str], bool]) -> str:
        """A folder name for a new project of this title.

        Args:
            title: Its display name.
            is_promised: Whether a project that does not exist yet will have a name.
        """
        return free_folder_name(
            title,
            lambda name: name in RESERVED or (self._root / name).exists() or is_promised(name),
        )

    def result(self, project_id: str, name: str) -> Path:
        """A result file; one of an approved map only if it is unchanged since the approval.

        Raises:
            NotFound: If the project, or the file in it, does not exist.
            Altered: If it was approved and changed since, or its approval does not count.
        """
        folder = self.folder(project_id)
        if name not in RESULTS or not _is_result(folder, name):
            raise NotFound(f"project {project_id} has no file {name[:64]!r}")
        if name == "summary.json":
            return folder / name
        summary, _ = _summary(folder)
        approval = approval_of(folder, artifact_keys(summary))
        if approval is None:
            return folder / name
        stated = summary.get("approval")
        if not (isinstance(stated, dict) and stated.get("hash") == approval.hash):
            folder = approval.folder  # it counted, and was not handed out before a crash
        approval.check_issued_file(folder / name)
        return folder / name

    def map_artifact(self, project_id: str) -> Path:
        """The artifact of the stage ``map`` of the latest run.

        Raises:
            NotFound: If there is none yet.
        """
        found = self.artifact(project_id, "map")
        if found is None:
            if self.artifact(project_id, "map_2d") is not None:
                raise NotFound(f"project {project_id} has a 2-D map: it has no points in space")
            raise NotFound(f"project {project_id} has no map yet")
        return found

    def map_of_any_kind(self, project_id: str) -> Path:
        """The artifact of the stage ``map`` or ``map_2d`` of the latest run.

        Raises:
            NotFound: If there is neither yet.
        """
        return self.artifact(project_id, "map_2d") or self.map_artifact(project_id)

    def artifact(self, project_id: str, stage: str) -> Path | None:
        """The artifact of a stage of the latest run; None = there is none.

        Raises:
            NotFound: If there is no such project.
        """
        return _artifacts(self.folder(project_id)).get(stage)

    def rename(self, project_id: str, name: str) -> None:
        """Change the display name of a project; its folder keeps its name.

        Raises:
            NotFound: If there is none of that name.
            Conflict: If a job is writing to it.
        """
        try:
            with Folder.open(self.folder(project_id)) as project:
                project.describe(name=name)
        except StoreError as error:
            raise Conflict(f"not now: {error}") from error

    def clone(self, project_id: str, target: str) -> None:
        """Create a project that reuses the finished stages of another.

        Raises:
            NotFound: If there is none of that name.
            Conflict: If a project of the new name exists.
            NoRoom: If the disk is full.
        """
        folder = self.folder(project_id)
        if not PROJECT_ID.fullmatch(target):
            raise NotFound(f"not a valid project name: {target[:64]!r}")
        work = self._root / ".recon4" / "clones"
        clone_artifacts(_artifacts(folder), self._root / target, work)

    def importable(self, path: str) -> Path:
        """The real path of a recording, rig, IMU, GNSS or reference file on this computer.

        Raises:
            Refused: If it is outside of the folders recordings may lie in, hidden or private.
            NotFound: If it does not exist.
        """
        return self.imports.checked(path)

    def browse(self, folder: str) -> list[FolderEntry]:
        """List a folder; the folders of recordings for an empty path.

        Raises:
            Refused: If it is outside of the folders recordings may lie in, hidden or private.
            NotFound: If it is not a folder.
        """
        return self.imports.entries(folder)

    def _card(self, entry: os.DirEntry[str]) -> ProjectCard | None:
        if not PROJECT_ID.fullmatch(entry.name) or not entry.is_dir(follow_symlinks=False):
            return None
        folder = Path(entry.path)
        stamp = stamp_of(folder)
        if stamp[0] is None:
            return None
        kept = self._cards.get(entry.name)
        if kept is None or kept[0] != stamp:
            kept = self._cards[entry.name] = (stamp, _read_card(folder, stamp))
        return kept[1]

    def _read(self, folder: Path) -> ProjectView:
        facts, problems = _object(folder, "project.json")
        summary, more = _summary(folder)
        stages, most = _stages(folder)
        size, changed_s = weigh(folder)
        return ProjectView(
            id=folder.name,
            name=_name(facts, folder),
            finished=(folder / "summary.json").exists(),
            updated=iso(changed_s),
            bytes=size,
            preset=visible(str(facts.get("preset") or "")),
            rig=_name_of(facts.get("rig")),
            files=tuple(_results(folder)),
            stages=stages,
            viewable=any(stage.stage in VIEWABLE_STAGES for stage in stages),
            has_map=any(stage.stage == "map" for stage in stages),
            summary=summary,
            approval=_approval(folder, summary),
            problem="; ".join(filter(None, (problems, more, most))),
        )


def _read_card(folder: Path, stamp: Stamp) -> ProjectCard:
    facts, problem = _object(folder, "project.json")
    summary, more = _summary(folder)
    finished = stamp[1] is not None
    return ProjectCard(
        id=folder.name,
        name=_name(facts, folder),
        finished=finished,
        updated=iso(max(t_ns for t_ns in stamp[:3] if t_ns is not None) / 1e9),
        preset=visible(str(facts.get("preset") or "")),
        rig=_name_of(facts.get("rig")),
        has_map=finished and ("points" in summary or summary.get("map") == "2d"),
        path_length_m=_number(summary.get("path_length_m")),
        points=_whole(summary.get("points")),
        approval=_approval(folder, summary),
        usability=_usability(summary),
        problem="; ".join(filter(None, (problem, more))),
    )


def _approval(folder: Path, summary: dict[str, object]) -> ApprovalState:
    """State of the approval of the files of a project."""
    try:
        return approval_state(folder, artifact_keys(summary))
    except StoreError as error:
        return not_valid("Not approved: the approval cannot be read", error)


def _usability(summary: dict[str, object]) -> str:
    """The verdict on the map; empty where there is none, as in files of format 1."""
    verdict = summary.get("verdict")
    usability = verdict.get("usability") if isinstance(verdict, dict) else None
    return usability if usability in list(Usability) else ""


def _name(facts: dict[str, object], folder: Path) -> str:
    return visible(str(facts.get("name") or folder.name))


def _number(value: Any) -> float | None:
    return (
        float(value) if isinstance(value, int | float) and abs(value) < PROJECT_LIST.large else None
    )


def _whole(value: Any) -> int | None:
    return value if isinstance(value, int) and abs(value) < PROJECT_LIST.large else None


def _is_project(folder: Path) -> bool:
    """A folder of a valid name with a ``project.json``, not a link."""
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
        ResultFile(name=name, label=label, bytes=(folder / name).stat().st_size)
        for name, label in RESULTS.items()
        if _is_result(folder, name)
    ]


def _artifacts(folder: Path) -> dict[str, Path]:
    """Stage -> its artifact in the latest run; none when the ledger is missing or damaged."""
    try:
        return read_artifacts(folder) if (folder / "ledger.sqlite").exists() else {}
    except StoreError:
        return {}


def _stages(folder: Path) -> tuple[tuple[StageView, ...], str]:
    """Stages of the latest run in the order of the pipeline, and the problem if there are none."""
    if not (folder / "ledger.sqlite").exists():
        return (), ""
    try:
        current = {path.name for path in read_artifacts(folder).values()}
        rows = [row for row in read_stages(folder) if row.key in current]
        found = tuple(map(_stage, rows))
    except (StoreError, ValueError, TypeError) as error:
        return (), visible(str(error), most=PROJECT_LIST.max_problem)
    order = {stage: k for k, stage in enumerate(STAGE_ORDER)}
    return tuple(sorted(found, key=lambda one: order.get(one.stage, len(order)))), ""


def _stage(row: StageRow) -> StageView:
    """A row with checked types; SQLite returns what a damaged file has in a column."""
    seconds = float(row.seconds)
    if not math.isfinite(seconds):
        raise ValueError(f"ledger.sqlite: {row.stage} took {seconds} s")
    return StageView(
        stage=visible(str(row.stage)),
        seconds=seconds,
        peak_bytes=int(row.peak_bytes),
        finished=visible(str(row.finished)),
    )


def _summary(folder: Path) -> tuple[dict[str, object], str]:
    """``summary.json`` with current names, and the problem with it."""
    summary, problem = _object(folder, "summary.json")
    return current_names(summary, SUMMARY), problem


def _object(folder: Path, name: str) -> tuple[dict[str, object], str]:
    """A JSON object and the problem with its file; a page shows the readable rest."""
    path = folder / name
    if not path.exists():
        return {}, ""
    try:
        return read_object(path), ""
    except StoreError as error:
        problem = str(error).replace(f"{folder}/", "")
        return {}, visible(problem, most=PROJECT_LIST.max_problem)


def _name_of(rig: Any) -> str:
    return visible(str(rig.get("name", "")) if isinstance(rig, dict) else str(rig or ""))
