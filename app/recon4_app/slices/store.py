"""Maps, references and control points of slice requests, and the newest request per page."""

from __future__ import annotations

import asyncio
import re
import secrets
import shutil
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar

from starlette.concurrency import run_in_threadpool

from recon4.comparison.common_frame import earlier_map_rows
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.review.approval_state import ApprovalState, approval_state
from recon4.review.approved import Approval, NotInJournal, approval_of, approval_of_map
from recon4.review.evidence import Evidence
from recon4.review.trusted_keys import UnknownSigner
from recon4.store.project import read_artifacts
from recon4.store.seal import begin_change, changing, check_sealed, end_change
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.errors import Conflict, NotFound
from recon4_app.projects.store import PROJECT_ID, ProjectStore
from recon4_app.review.hash_checks import ApprovalChecks
from recon4_app.settings import ServerSettings
from recon4_app.slices import slice_work
from recon4_app.slices.control_store import ControlStore
from recon4_app.slices.exports import Exports
from recon4_app.slices.listed_reference import ListedReference
from recon4_app.slices.model import OtherMap
from recon4_app.slices.tuning import SLICE_STORE

T = TypeVar("T")
_KEY = re.compile(r"[0-9a-f]{16,64}")
_REFERENCE = re.compile(r"[0-9a-f]{12}")


class Superseded(Conflict):
    """A newer request of the same page replaced this one."""


@dataclass(frozen=True, slots=True)
class ReferenceFolder:
    """Where a reference of a project is, or is going to be."""

    project_id: str
    folder: Path


@dataclass(frozen=True, slots=True)
class Asking:
    """Position of a request among those of its page."""

    page: str
    """Id of the page; empty = a single request."""
    sequence: int
    """The greatest is the latest; of equal ones the last to arrive."""


@dataclass(frozen=True, slots=True)
class _Latest:
    """The newest request of a page, and the work on it."""

    sequence: int
    work: asyncio.Future[Any]


class Slices:
    """Slices of all projects; caches images from above and map checks."""

    def __init__(
        self,
        pool: ComputePool,
        projects: ProjectStore,
        checks: ApprovalChecks,
        *,
        settings: ServerSettings,
    ) -> None:
        self._pool, self._checks = pool, checks
        self._projects = projects
        self.survey = ControlStore(projects)
        self._kept = settings.state / "slices"
        self.exports = Exports(
            pool, self._kept / "exports", reserve_bytes=settings.free_disk_reserve_bytes
        )
        self._newest: OrderedDict[tuple[str, str], _Latest] = OrderedDict()
        self._making: dict[Path, asyncio.Lock] = {}

    # -- which map

    def artifacts(self, project_id: str, source: str = "") -> dict[str, str]:
        """Artifact folders of the requested map.

        Raises:
            NotFound: If there is no such map.
        """
        kind, _, name = source.partition(":")
        if kind == "project" and PROJECT_ID.fullmatch(name):
            return self._latest(name)
        if kind == "map" and _KEY.fullmatch(name):
            found = self._latest(project_id)
            earlier = self._projects.folder(project_id) / "artifacts" / name
            if not (earlier / "tiles.json").is_file():
                raise NotFound(CodedText("map-gone", project=project_id, map=name[:16]))
            return found | {"map": str(earlier)}
        if source:
            raise NotFound(CodedText("map-unknown", map=source[:80]))
        return self._latest(project_id)

    def sources(self, project_id: str) -> list[OtherMap]:
        """Other maps to compare with the latest: earlier ones, and those of other projects."""
        root = self._projects.folder(project_id)
        self._latest(project_id)  # raises if there is no map
        earlier = [
            _other(f"map:{row.key}", "map", row.finished[:16].replace("T", " "))
            for row in earlier_map_rows(root)
        ]
        others = [
            _other(f"project:{card.id}", "project", card.name)
            for card in self._projects.all()
            if card.points and card.id != project_id
        ]
        return earlier[:20] + others[:200]

    def evidence(
        self, project_id: str, source: str = "", *, draft: bool = False
    ) -> Evidence | None:
        """Approval of the requested map and the expected hashes; None = not approved, or a draft.

        Raises:
            Altered: If an approval was changed, or does not count.
        """
        if draft:
            return None
        _, found = self._approval(project_id, source)
        return found.evidence if found else None

    def evidence_to_show(self, project_id: str, source: str = "") -> Evidence | None:
        """As `evidence`; a map whose approval does not count is shown as one without.

        Raises:
            Altered: If an approval was changed.
        """
        try:
            return self.evidence(project_id, source)
        except (UnknownSigner, NotInJournal):
            return None

    def approval(self, project_id: str, source: str, language: str) -> ApprovalState:
        """State of the approval of the requested map, with the outcome of the comparison."""
        try:
            root, found = self._approval(project_id, source)
        except StoreError:
            root, found = self._root(project_id, source), None
        if found is not None:
            return self._checks.state(root, found.artifacts).in_language(language)
        keys = {} if source.startswith("map:") else _keys(root)
        return approval_state(root, keys).in_language(language)

    def _root(self, project_id: str, source: str) -> Path:
        kind, _, name = source.partition(":")
        return self._projects.folder(name if kind == "project" else project_id)

    def _approval(self, project_id: str, source: str) -> tuple[Path, Approval | None]:
        root = self._root(project_id, source)
        kind, _, name = source.partition(":")
        if kind == "map":
            return root, approval_of_map(root, name)
        return root, approval_of(root, _keys(root))

    def approved_artifacts(
        self, project_id: str, source: str, evidence: Evidence | None
    ) -> dict[str, str]:
        """Artifact folders of the requested map; an approved earlier map has its own frame.

        Raises:
            NotFound: If there is no such map.
        """
        found = self.artifacts(project_id, source)
        if evidence is None or not source.startswith("map:"):
            return found
        level = Path(found["map"]).parent / evidence.artifacts.get("level", "")
        without = {stage: folder for stage, folder in found.items() if stage != "level"}
        return without | ({"level": str(level)} if "level" in evidence.artifacts else {})

    def references(self, project_id: str, language: str = ENGLISH) -> list[ListedReference]:
        """References of a project."""
        return slice_work.references_in(self._folder(project_id) / "references", language)

    def reference(self, project_id: str, reference_id: str) -> str:
        """Folder of a reference; empty for an empty id.

        Raises:
            NotFound: If there is no such reference.
        """
        if not reference_id:
            return ""
        folder = self._folder(project_id) / "references" / reference_id
        if not _REFERENCE.fullmatch(reference_id) or not (folder / "reference.json").is_file():
            raise NotFound(
                CodedText("reference-unknown", reference=reference_id[:20], project=project_id)
            )
        root = self._projects.folder(project_id)
        check_sealed(root, _name_of(folder))
        return str(folder)

    def new_reference(self, project_id: str) -> Path:
        """Folder for a new reference.

        Raises:
            Conflict: If there are too many.
        """
        if len(self.references(project_id)) >= SLICE_STORE.max_references:
            raise Conflict(CodedText("references-too-many", limit=SLICE_STORE.max_references))
        folder = self._folder(project_id) / "references"
        folder.mkdir(parents=True, exist_ok=True)
        return folder / secrets.token_hex(6)

    async def write_reference(
        self,
        reference: ReferenceFolder,
        terms: Terms,
        function: Callable[..., T],
        *args: object,
        **kwargs: object,
    ) -> T:
        """Run a function that writes a reference in a child process, and seal the files."""
        root = self._projects.folder(reference.project_id)
        names = (_name_of(reference.folder),)
        await run_in_threadpool(begin_change, root, names)
        try:
            return await self.run_background(terms, function, *args, **kwargs)
        finally:
            await run_in_threadpool(end_change, root, names)

    def remove_reference(self, project_id: str, reference_id: str) -> None:
        """Remove a reference; the imported source file stays."""
        folder = Path(self.reference(project_id, reference_id))
        gone = folder.with_name(f".tmp-{secrets.token_hex(6)}-{folder.name}")
        with changing(self._projects.folder(project_id), _name_of(folder), compared=False):
            folder.rename(gone)
        shutil.rmtree(gone)

    # -- work

    def terms(self, project_id: str, person: str, source: str = "") -> Terms:
        """Terms of work that may read the requested map and the references of its project."""
        kind, _, name = source.partition(":")
        of_map = self._projects.folder(name if kind == "project" else project_id)
        references = self._folder(project_id) / "references"
        return Terms(person=person, access=FileAccess(read=(of_map / "artifacts", references)))

    async def run_interactive(
        self, terms: Terms, function: Callable[..., T], *args: object, **kwargs: object
    ) -> T:
        """Run interactive work in the compute pool."""
        return await self._pool.run_interactive(Lane.SLICE, terms, function, *args, **kwargs)

    async def run_latest(
        self,
        asking: Asking,
        terms: Terms,
        function: Callable[..., T],
        *args: object,
        **kwargs: object,
    ) -> T:
        """Run interactive work; of several requests of a page only the latest is completed.

        Raises:
            Superseded: If the page sent a newer request.
        """
        if not asking.page:
            return await self.run_interactive(terms, function, *args, **kwargs)
        page = (terms.person, asking.page)
        before = self._newest.get(page)
        if before is not None and before.sequence > asking.sequence:
            raise Superseded(CodedText("slice-superseded"))
        if before is not None:
            before.work.cancel()
        work = asyncio.ensure_future(self.run_interactive(terms, function, *args, **kwargs))
        self._newest[page] = _Latest(asking.sequence, work)
        self._newest.move_to_end(page)
        while len(self._newest) > SLICE_STORE.max_pages:
            self._newest.popitem(last=False)
        try:
            return await work
        except asyncio.CancelledError:
            if self._newest.get(page) != _Latest(asking.sequence, work):
                raise Superseded(CodedText("slice-superseded")) from None
            raise

    async def run_background(
        self, terms: Terms, function: Callable[..., T], *args: object, **kwargs: object
    ) -> T:
        """Run work that may take minutes, or reads a user's file, in a separate child process."""
        return await self._pool.run_background(Lane.SURVEY, terms, function, *args, **kwargs)

    async def kept(self, name: str, make: Callable[[Path], Any]) -> Path:
        """A cached file, made once per map."""
        path = self._kept / name
        async with self._making.setdefault(path, asyncio.Lock()):
            if not path.exists():
                await make(path)
        self._making.pop(path, None)
        return path

    def _folder(self, project_id: str) -> Path:
        return self._projects.folder(project_id) / "slices"

    def _latest(self, project_id: str) -> dict[str, str]:
        self._projects.map_artifact(project_id)  # raises if there is no map
        found = read_artifacts(self._projects.folder(project_id))
        return {stage: str(folder) for stage, folder in found.items()}


def _keys(root: Path) -> dict[str, str]:
    """Stage -> key of its artifact in the latest run."""
    return {stage: folder.name for stage, folder in read_artifacts(root).items()}


def _name_of(reference: Path) -> str:
    """Path of a reference's folder below its project."""
    return f"slices/references/{reference.name}"


def _other(source: str, kind: Literal["map", "project"], name: str) -> OtherMap:
    return OtherMap(source, kind, name, f"{'Map of' if kind == 'map' else 'Project'} {name}")
