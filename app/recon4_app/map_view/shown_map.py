"""What the page *Map* reads first of a map: files made once, before somebody asks if possible."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import ValidationError
from starlette.concurrency import run_in_threadpool

from recon4.errors import StoreError
from recon4.locales.coded import at
from recon4.review.evidence import Evidence
from recon4.store.json_files import read_object
from recon4_app.compute_pool.model import Terms
from recon4_app.errors import NotFound
from recon4_app.map_view import map_work
from recon4_app.map_view.cubes import CubeFile
from recon4_app.map_view.map_work import INDEX, coarse_name
from recon4_app.map_view.model import MapIndex, Stored
from recon4_app.map_view.tuning import MAP_CHUNKS
from recon4_app.slices.store import Slices

log = logging.getLogger(__name__)

_FIRST = "first"
"""Folder of what is made before somebody asks."""


@dataclass(frozen=True, slots=True)
class ShownMap:
    """A map as the page shows it; its files are kept."""

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

    async def index(self) -> MapIndex:
        """The index.

        Raises:
            StoreError: If a file of the map, or the index, is damaged.
        """
        path = await self._kept(INDEX, map_work.write_index, INDEX)
        return await run_in_threadpool(_read_index, path)

    async def coarse(self, stored: Stored) -> CubeFile:
        """The coarse points.

        Raises:
            ConfigError: If the map has no such values.
            StoreError: If a file of the map is damaged.
        """
        name = coarse_name(stored)
        path = await self._kept(name, map_work.write_coarse, stored, name)
        return CubeFile(path, stored)

    async def prepare(self) -> None:
        """Make what the page reads first in one child, before somebody asks for it."""
        if not (await self.slices.kept_before(f"{self._prefix}-{INDEX}")).exists():
            await self._made(_FIRST, self.slices.run_ahead, map_work.write_first, _FIRST)

    async def _kept(self, name: str, function: Callable[..., None], *args: str) -> Path:
        prepared = await self.slices.kept_before(f"{self._prefix}-{_FIRST}") / name
        if prepared.exists():
            return prepared
        return await self._made(name, self.slices.run_interactive, function, *args)

    async def _made(
        self,
        name: str,
        run: Callable[..., Awaitable[None]],
        function: Callable[..., None],
        *args: str,
    ) -> Path:
        async def make(out: Path) -> None:
            made = replace(self.terms, outputs={name: out})
            await run(made, function, self.artifacts, *args, evidence=self.evidence)

        return await self.slices.kept(f"{self._prefix}-{name}", make)

    @property
    def _prefix(self) -> str:
        """What was made of an approved map has a name of its own."""
        level = Path(self.artifacts.get("level", "")).name[:16]
        checked = self.evidence.manifests["map"][:16] if self.evidence else "draft"
        return f"{Path(self.artifacts['map']).name}-{level}-{checked}-map{MAP_CHUNKS.version}"


class MapPreparation:
    """Makes what the page *Map* reads first, one project after the other."""

    def __init__(self, slices: Slices) -> None:
        self._slices = slices
        self._loop: asyncio.AbstractEventLoop | None = None
        self._projects: asyncio.Queue[str] = asyncio.Queue()
        self._waiting: set[str] = set()

    def want(self, project_id: str) -> None:
        """Somebody may soon look at this project's map, if it has one. Thread-safe."""
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._add, project_id)

    def _add(self, project_id: str) -> None:
        if project_id not in self._waiting:
            self._waiting.add(project_id)
            self._projects.put_nowait(project_id)

    async def run(self) -> None:
        """Prepare maps until cancelled; a failure is said again to who asks for the map."""
        self._loop = asyncio.get_running_loop()
        while True:
            project_id = await self._projects.get()
            try:
                await self._prepare(project_id)
            except NotFound:
                pass  # no map yet, or deleted meanwhile
            except Exception as error:
                log.warning("the map of %s is not prepared: %s", project_id, error)
            finally:
                self._waiting.discard(project_id)

    async def _prepare(self, project_id: str) -> None:
        shown = await ShownMap.of(self._slices, project_id, person="server")
        await shown.prepare()


def _read_index(path: Path) -> MapIndex:
    try:
        record = read_object(path, max_bytes=MAP_CHUNKS.max_index_bytes)
        return MapIndex.model_validate(record)
    except ValidationError as error:
        raise StoreError(at(path.name, str(error))) from error
