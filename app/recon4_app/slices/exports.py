"""Exports of slices and maps: made once, kept for a day, downloadable in ranges.

The name of an export is the hash of its inputs. The same request after an interrupted connection
finds the finished file, and ``Range`` with ``If-Range`` continues the download.
"""

from __future__ import annotations

import asyncio
import hashlib
import json
import secrets
import shutil
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Protocol

from recon4.locales.coded import CodedText
from recon4_app.compute_pool.model import Lane, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.errors import NoRoom
from recon4_app.slices import export_work
from recon4_app.slices.model import ExportContext, SliceExportRequest
from recon4_app.slices.tuning import EXPORTS

_POINTS = ("laz", "csv", "dxf")


class FileRequest(Protocol):
    """A file that can be made."""

    @property
    def ending(self) -> str:
        """Ending of its name, without the dot."""
        ...

    @property
    def key(self) -> str:
        """Hash of everything that determines its bytes."""
        ...

    @property
    def large(self) -> bool:
        """Whether it may take minutes."""
        ...

    def work(self, name: str) -> tuple[Callable[..., str], dict[str, object]]:
        """What a child process calls to write it under a name, with the arguments."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportRequest:
    """Everything that determines the bytes of an export of slices."""

    ending: str
    ask: SliceExportRequest
    artifacts: Mapping[str, str]
    """Stage -> folder of its artifact."""
    reference: str
    """Folder of the reference; empty = none."""
    context: ExportContext

    @property
    def key(self) -> str:
        """Hash of the request, including the alignment of the reference."""
        facts = Path(self.reference) / "reference.json" if self.reference else None
        determines = {
            "ending": self.ending,
            "ask": self.ask.model_dump(mode="json"),
            "artifacts": dict(self.artifacts),
            "reference": [str(facts), facts.stat().st_mtime_ns] if facts else None,
            "context": asdict(self.context),
        }
        return hashlib.sha256(json.dumps(determines, sort_keys=True).encode()).hexdigest()

    @property
    def large(self) -> bool:
        """Whether it may take minutes: many points, written one by one, or many slices."""
        ask = self.ask
        points = self.ending in _POINTS and ask.window is None
        return ask.count > 1 or points or ask.plane.thickness_m > EXPORTS.large_thickness_m

    def work(self, name: str) -> tuple[Callable[..., str], dict[str, object]]:
        """What the child process calls, with its arguments."""
        facts = {"artifacts": dict(self.artifacts), "ask": self.ask, "out": name}
        return export_work.export, {
            **facts,
            "reference": self.reference,
            "context": self.context,
        }


class Exports:
    """Makes exports and keeps them, so that interrupted downloads can continue."""

    def __init__(self, pool: ComputePool, folder: Path, *, reserve_bytes: int) -> None:
        self._pool, self._folder = pool, folder
        self._reserve_bytes = reserve_bytes
        self._making: dict[Path, asyncio.Lock] = {}

    async def make(self, request: FileRequest, terms: Terms) -> Path:
        """The file of an export; it is made if it does not exist.

        Raises:
            NoRoom: If the disk is nearly full.
            TooMany: If this person has too many exports waiting.
            ComputeFailed, Recon4Error: If it cannot be made.
        """
        place = self._folder / f"{request.key}.{request.ending}"
        async with self._making.setdefault(place, asyncio.Lock()):
            if not place.exists():
                await asyncio.to_thread(self._refuse_if_full)
                name = f"export.{request.ending}"
                pool = self._pool
                function, arguments = request.work(name)
                # A pooled child process has fonts and map loaded: a sheet takes 1 s instead of 5 s.
                run = pool.run_background if request.large else pool.run_interactive
                await run(
                    Lane.EXPORT,
                    replace(
                        terms, outputs={name: place}, large=request.large, limit_s=EXPORTS.limit_s
                    ),
                    function,
                    **arguments,
                )
        self._making.pop(place, None)
        return place

    def free_place(self, ending: str) -> Path:
        """A new name among the exports, for a file that is made each time.

        Raises:
            NoRoom: If the disk is nearly full.
        """
        self._refuse_if_full()
        return self._folder / f"{secrets.token_hex(32)}.{ending}"

    def sweep(self, now_s: float) -> int:
        """Remove exports older than a day, and the oldest if all together are too large.

        Returns:
            How many were removed.
        """
        if not self._folder.is_dir():
            return 0
        files = sorted(
            ((path.stat().st_mtime, path.stat().st_size, path) for path in self._folder.iterdir()),
            reverse=True,
        )
        total, removed = 0, 0
        for changed_s, size, path in files:
            total += size
            if now_s - changed_s > EXPORTS.kept_s or total > EXPORTS.max_kept_bytes:
                path.unlink(missing_ok=True)
                removed += 1
        return removed

    def _refuse_if_full(self) -> None:
        self._folder.mkdir(parents=True, exist_ok=True)
        free = shutil.disk_usage(self._folder).free
        if free < self._reserve_bytes:
            raise NoRoom(
                CodedText("slice-export-no-room", needed_bytes=self._reserve_bytes, free_bytes=free)
            )
