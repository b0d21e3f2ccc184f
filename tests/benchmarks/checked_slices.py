"""Cost of checking approved bytes for a slice of a large map.

    python -m tests.benchmarks.checked_slices FOLDER [POINTS]

FOLDER receives a map (some 20 bytes a point) unless it is there.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from recon4.mapping.tiles import TileSet
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.slices.points import extent
from recon4.slices.slice_image import RasterGrid, draw
from recon4.slices.slice_plane import SlicePlane
from recon4.store.checked import CheckedArtifact
from recon4.store.project import Project, read_artifacts
from recon4.store.stage import Input, Stage, StageRunner
from tests.benchmarks.large_map import _map


def _seconds(tiles: TileSet) -> float:
    plane = SlicePlane.horizontal(1.5, thickness_m=0.1)
    window = extent(tiles, plane)
    began = time.perf_counter()
    draw(tiles, plane, RasterGrid(window, 0.02))
    return time.perf_counter() - began


def main(folder: Path, points: int) -> None:
    """Make the map and draw it unchecked, checked for the first time, and checked again."""
    if not folder.exists():
        with Project.open(folder) as project:
            runner = StageRunner(project, Settings(), Silent())
            runner.run(Stage("map", 1, ReadsNothing, _map), points=Input(f"large {points}", points))
    artifact = read_artifacts(folder)["map"]
    plain, checked = TileSet.open(artifact), TileSet.open(artifact, CheckedArtifact.open(artifact))
    _seconds(plain)  # compiles, and brings the file into memory
    figures = [_seconds(plain), _seconds(checked), _seconds(checked)]
    words = ("plain", "checked, first in the process", "checked, again")
    for what, seconds in zip(words, figures, strict=True):
        sys.stdout.write(f"{what}: {1000 * seconds:.0f} ms\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 20_000_000)
