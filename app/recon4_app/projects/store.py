"""Projects are the folders below the root. Nothing else is kept about them.

A title is any line of text ("Office Brno, 2nd floor"); it stays the display name of the project.
"""

from __future__ import annotations

import math
import os
import re
import unicodedata
from collections.abc import Callable, Mapping
from pathlib import Path

from recon4 import __version__
from recon4.errors import StoreError
from recon4.locales.coded import CodedText, text_of
from recon4.review.approved import approval_of
from recon4.review.state import artifact_keys
from recon4.store.ledger import FinishedStage as StageRow
from recon4.store.project import Project as Folder
from recon4.store.project import is_project, read_artifacts, read_stages
from recon4.untrusted.names import visible
from recon4_app.errors import Conflict, NotFound, project_page
from recon4_app.projects.cards import CardIndex
from recon4_app.projects.clone import clone_artifacts
from recon4_app.projects.described import (
    approval_in,
    object_of,
    rig_name,
    shown_name,
    summary_of,
    tags_of,
)
from recon4_app.projects.folder_times import iso, weigh
from recon4_app.projects.import_folders import ImportFolders
from recon4_app.projects.model import (
    RESULTS,
    VIEWABLE_STAGES,
    FolderEntry,
    ProjectCard,
    ProjectView,
    ResultFile,
    StageView,
    stage_order,
)
from recon4_app.projects.tuning import FOLDER_NAMES, PROJECT_LIST

RESERVED = frozenset({"recordings", "rigs"})
"""Folders of uploads and of rigs, beside those of projects."""


def folder_name(title: str) -> str:
    """The title in lower-case letters without accents, digits and dashes.

    ``project`` if the title has no letter or digit of the Latin alphabet.
    """
    plain = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode()
    return (
        re.sub(r"[^a-z0-9]+", "-", plain.lower()).strip("-")[: FOLDER_NAMES.longest].rstrip("-")
        or "project"
    )


def free_folder_name(title: str, is_taken: Callable[[str], bool]) -> str:
    """The folder name of a title, numbered if a project or another folder has it.

    Args:
        title: What a person calls the project.
        is_taken: Whether a name is in use.
    """
    name = folder_name(title)
    found, n = name, 2
    while is_taken(found):
        found, n = f"{name}-{n}", n + 1
    return found


PROJECT_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


class ProjectStore:
    """Reads project folders. Paths are made from checked names only."""

    def __init__(self, root: Path, imports: ImportFolders, *, index: Path | None = None) -> None:
        """Name the folders.

        Args:
            root: Folder of the projects.
            imports: Folders that requests may name files of.
            index: File of the index of the list; None = it is not kept.
        """
        self.root = root.resolve()
        """Folder of the projects."""
        self.imports = imports
        """Files of this computer that requests may name."""
        self.cards = CardIndex(index, __version__)

    def all(self) -> list[ProjectCard]:
        """All projects, the newest first. Unchanged folders are not read again."""
        with os.scandir(self.root) as entries:
            found = [card for entry in entries if (card := self._card(entry)) is not None]
        self.cards.forget_all_but({card.id for card in found})
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
        folder = self.root / project_id
        if not PROJECT_ID.fullmatch(project_id) or not _is_project(folder):
            raise NotFound(CodedText("project-unknown", name=project_id[:64]))
        return folder

    def refuse_taken(self, name: str) -> None:
        """Check that a name is free for a new project.

        Raises:
            Conflict: If there is a project or another folder of that name.
        """
        self.refuse_reserved(name)
        if (self.root / name).exists():
            raise Conflict(
                CodedText("project-exists", name=name),
                remedy=project_page(name) if is_project(self.root / name) else None,
            )

    def refuse_reserved(self, name: str) -> None:
        """Check that a project of a name may exist; one of an earlier version may stay.

        Raises:
            Conflict: If the server itself uses the folder of that name.
        """
        if name in RESERVED and not is_project(self.root / name):
            raise Conflict(CodedText("name-of-server", name=name))

    def free_folder_name(self, title: str, is_promised: Callable[[str], bool]) -> str:
        """A folder name for a new project of this title.

        Args:
            title: Its display name.
            is_promised: Whether a project that does not exist yet will have a name.
        """
        return free_folder_name(
            title,
            lambda name: name in RESERVED or (self.root / name).exists() or is_promised(name),
        )

    def result(self, project_id: str, name: str) -> Path:
        """A result file; one of an approved map only if it is unchanged since the approval.

        Raises:
            NotFound: If the project, or the file in it, does not exist.
            Altered: If it was approved and changed since, or its approval does not count.
        """
        folder = self.folder(project_id)
        if name not in RESULTS or not _is_result(folder, name):
            raise NotFound(CodedText("project-file-unknown", project=project_id, file=name[:64]))
        if name == "summary.json":
            return folder / name
        summary, _ = summary_of(folder)
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
                raise NotFound(CodedText("project-planar-map", project=project_id))
            raise NotFound(
                CodedText("project-no-map", project=project_id), remedy=project_page(project_id)
            )
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
        self.describe(project_id, {"name": name})

    def describe(self, project_id: str, fields: Mapping[str, object]) -> None:
        """Change what people say of a project: ``name``, ``tags``, ``archived``.

        Raises:
            NotFound: If there is none of that name.
            Conflict: If a job is writing to it.
        """
        try:
            with Folder.open(self.folder(project_id)) as project:
                project.describe(**fields)
        except StoreError as error:
            raise Conflict(CodedText("project-busy", detail=text_of(error))) from error

    def clone(self, project_id: str, target: str) -> None:
        """Create a project that reuses the finished stages of another.

        Raises:
            NotFound: If there is none of that name.
            Conflict: If a project of the new name exists.
            NoRoom: If the disk is full.
        """
        folder = self.folder(project_id)
        if not PROJECT_ID.fullmatch(target):
            raise NotFound(CodedText("project-name-invalid", name=target[:64]))
        work = self.root / ".recon4" / "clones"
        clone_artifacts(_artifacts(folder), self.root / target, work)

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
        return self.cards.card(Path(entry.path))

    def _read(self, folder: Path) -> ProjectView:
        facts, problems = object_of(folder, "project.json")
        summary, more = summary_of(folder)
        stages, most = _stages(folder)
        size, changed_s = weigh(folder)
        return ProjectView(
            id=folder.name,
            name=shown_name(facts, folder),
            finished=(folder / "summary.json").exists(),
            updated=iso(changed_s),
            bytes=size,
            preset=visible(str(facts.get("preset") or "")),
            rig=rig_name(facts.get("rig")),
            files=tuple(_results(folder)),
            stages=stages,
            tags=tags_of(facts),
            archived=facts.get("archived") is True,
            viewable=any(stage.stage in VIEWABLE_STAGES for stage in stages),
            has_map=any(stage.stage == "map" for stage in stages),
            summary=summary,
            approval=approval_in(folder, summary),
            problem="; ".join(filter(None, (problems, more, most))),
        )


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
    order = {stage: k for k, stage in enumerate(stage_order())}
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
