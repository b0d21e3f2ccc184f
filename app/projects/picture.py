"""The picture of a project: its map from above, made once in a process of its own.

``python -m app.projects.picture MAP_ARTIFACT OUT.png`` makes it.
"""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path

from app.errors import NotFound
from app.settings import worker_environment
from recon4.processes import die_with_parent
from recon4.store.atomic import atomic_file

POINTS = 3_000_000
"""So many points of a map are enough for a small picture."""


class Pictures:
    """Makes pictures when they are asked for, one at a time, and keeps them."""

    def __init__(self, kept: Path) -> None:
        self._kept = kept
        self._one = asyncio.Lock()

    async def of(self, artifact: Path) -> Path:
        """The picture of the artifact of a stage ``map``.

        Raises:
            NotFound: If it cannot be made.
        """
        path = self._kept / f"{artifact.name}.png"
        async with self._one:
            if not path.exists():
                self._kept.mkdir(parents=True, exist_ok=True)
                process = await asyncio.create_subprocess_exec(
                    *(sys.executable, "-m", "app.projects.picture", str(artifact), str(path)),
                    stdin=asyncio.subprocess.PIPE,  # its lifeline
                    stdout=asyncio.subprocess.DEVNULL,
                    stderr=asyncio.subprocess.DEVNULL,
                    env=worker_environment(),
                )
                try:
                    await process.wait()
                finally:
                    if process.returncode is None:
                        process.kill()
        if not path.exists():
            raise NotFound("there is no picture of this map")
        return path


def draw(artifact: Path, out: Path) -> None:
    """Draw a map from above: walls as black lines on nothing."""
    from recon4.mapping.tiles import TileSet
    from recon4.report.maps import ABOVE, ink_png, map_chunks, rasterize

    tiles = TileSet.open(artifact)
    raster = rasterize(lambda: map_chunks(tiles, points=POINTS), (ABOVE,))[0]
    with atomic_file(out) as part:
        part.write_bytes(ink_png(raster))


if __name__ == "__main__":
    die_with_parent(sys.stdin.fileno())
    draw(Path(sys.argv[1]), Path(sys.argv[2]))
