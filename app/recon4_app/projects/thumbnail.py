"""Thumbnail of a project: its map from above, made once."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from pathlib import Path

from recon4.errors import Recon4Error
from recon4.locales.coded import CodedText, text_of
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.errors import ComputeFailed, NotFound
from recon4_app.projects.tuning import THUMBNAILS

THUMBNAIL = "map.png"


class Thumbnails:
    """Makes thumbnails at the first request, and keeps them."""

    def __init__(self, pool: ComputePool, kept: Path) -> None:
        self._pool = pool
        self._kept = kept
        self._making: dict[Path, asyncio.Lock] = {}

    async def of(self, artifact: Path, *, person: str) -> Path:
        """The thumbnail of the artifact of a stage ``map``.

        Raises:
            NotFound: If it cannot be made.
            TooMany: If too many thumbnails wait to be made.
        """
        path = self._kept / f"{artifact.name}.png"
        async with self._making.setdefault(path, asyncio.Lock()):
            if not path.exists():
                terms = Terms(
                    person=person, access=FileAccess(read=(artifact,)), outputs={THUMBNAIL: path}
                )
                try:
                    await self._pool.run_background(
                        Lane.THUMBNAIL, terms, draw_thumbnail, artifact, Path(THUMBNAIL)
                    )
                except (Recon4Error, ComputeFailed) as error:
                    raise NotFound(CodedText("thumbnail-missing", detail=text_of(error))) from error
        self._making.pop(path, None)
        return path


def draw_thumbnail(artifact: Path, out: Path) -> None:
    """Draw a map from above: walls as black lines on a transparent background."""
    from recon4.mapping.tiles import TileSet
    from recon4.report.maps import ABOVE, MapChunk, ink_png, map_chunks, rasterize

    tiles = TileSet.open(artifact)

    def sample(points: int) -> Iterator[MapChunk]:
        return map_chunks(tiles, min(points, THUMBNAILS.max_points))

    raster = rasterize(sample, (ABOVE,))[0]
    out.write_bytes(ink_png(raster))
