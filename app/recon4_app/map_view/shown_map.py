"""What the page *Map* reads first of a map: files of its artifact, else made at a first request."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from starlette.concurrency import run_in_threadpool

from recon4.first_view.cubes import CubeFile
from recon4.first_view.files import FIRST_FILES, INDEX, coarse_name, read_index
from recon4.first_view.records import Stored
from recon4.first_view.tuning import MAP_CHUNKS
from recon4.review.evidence import Evidence
from recon4_app.compute_pool.model import Terms
from recon4_app.map_view import map_work
from recon4_app.slices.store import Slices


@dataclass(frozen=True, slots=True)
class ShownMap:
    """A map as the page shows it."""

    slices: Slices
    artifacts: dict[str, str]
    evidence: Evidence | None
    terms: Terms

    @classmethod
    async def of(cls, slices: Slices, project_id: str, *, person: str, key: str = "") -> ShownMap:
        """The latest map of a project, or an earlier one.

        Raises:
            NotFound: If there is no such map.
            Altered: If an approval was changed.
        """
        source = f"map:{key}" if key else ""
        return cls(
            slices,
            await run_in_threadpool(slices.artifacts, project_id, source),
            await run_in_threadpool(slices.evidence_to_show, project_id, source),
            slices.terms(project_id, person, source),
        )

    async def index(self) -> bytes:
        """The index as JSON.

        Raises:
            StoreError: If a file of the map, or the index, is damaged.
        """
        folder = self._map / FIRST_FILES
        if not await run_in_threadpool(self._has, INDEX):
            folder = await self._first()
        return await run_in_threadpool(read_index, folder / INDEX, self._map.name)

    async def coarse(self, stored: Stored) -> CubeFile:
        """The coarse points.

        Raises:
            ConfigError: If the map has no such values.
            StoreError: If a file of the map is damaged.
        """
        name = coarse_name(stored)
        if await run_in_threadpool(self._has, name):
            return CubeFile(self._map / FIRST_FILES / name, stored)
        if not await run_in_threadpool(self._is_own, INDEX):
            path = await self._first() / name
            if path.exists():
                return CubeFile(path, stored)
        return CubeFile(await self._made(name, map_work.write_coarse, stored), stored)

    @property
    def _map(self) -> Path:
        return Path(self.artifacts["map"])

    async def _first(self) -> Path:
        """Folder of what is made of a map of an earlier version, once."""
        return await self._made("first", map_work.write_first)

    def _is_own(self, name: str) -> bool:
        """Whether the map has a file itself; one of an earlier version has none.

        Links may lead out of the project, to what the person may not read.
        """
        path = self._map / FIRST_FILES / name
        root = self._map.parents[1]
        return path.is_file() and path.resolve() == root.resolve() / path.relative_to(root)

    def _has(self, name: str) -> bool:
        """As `_is_own`; that of an approved map is compared with its hashes."""
        if not self._is_own(name):
            return False
        if self.evidence:
            self.evidence.check_frame({stage: Path(at) for stage, at in self.artifacts.items()})
            self.evidence.artifact("map", self._map).check(f"{FIRST_FILES}/{name}")
        return True

    async def _made(self, name: str, function: Callable[..., None], *args: str) -> Path:
        async def make(out: Path) -> None:
            made = replace(self.terms, outputs={name: out})
            await self.slices.run_interactive(
                made, function, self.artifacts, name, *args, evidence=self.evidence
            )

        return await self.slices.kept(f"{self._prefix}-{name}", make)

    @property
    def _prefix(self) -> str:
        """What was made of an approved map has a name of its own."""
        level = Path(self.artifacts.get("level", "")).name[:16]
        checked = self.evidence.manifests["map"][:16] if self.evidence else "draft"
        return f"{self._map.name}-{level}-{checked}-map{MAP_CHUNKS.version}"
