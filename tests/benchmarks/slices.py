"""Slices of a large map: ``python -m tests.benchmarks.slices PROJECT`` (see ``large_map``).

Prints seconds (and, for a busy machine, processor seconds) of images of 1600 x 1200 pixels, cold
(files dropped from the page cache) and warm, of the check for double walls, and the memory.
"""

from __future__ import annotations

import os
import resource
import sys
import time
from pathlib import Path

from recon4.mapping.tiles import TileSet
from recon4.slices.doubles import find_double_walls
from recon4.slices.points import SliceWindow, extent
from recon4.slices.slice_image import RasterGrid, draw, png
from recon4.slices.slice_plane import SlicePlane
from recon4.store.project import read_artifacts


def main(project: Path) -> None:
    folder = read_artifacts(project)["map"]
    tiles = TileSet.open(folder)
    low, high = tiles.bounds_m
    x, y, z = (float(c) for c in (low + high) / 2.0)
    planes = {
        "horizontal, 10 cm": SlicePlane.horizontal(float(low[2]) + 1.2),
        "horizontal, 2 cm": SlicePlane.horizontal(float(low[2]) + 1.2, thickness_m=0.02),
        "floor, 40 cm": SlicePlane.horizontal(float(low[2]) + 0.1, thickness_m=0.4),
        "vertical, 10 cm": SlicePlane.vertical((float(low[0]), y - 1.0), (float(high[0]), y + 3.0)),
        "free, 10 cm": SlicePlane.free((x, y, z), (0.3, 0.5, 0.8)),
        "all points": SlicePlane.horizontal(z, thickness_m=99.0),
    }
    time_image(tiles, planes["horizontal, 2 cm"], "height")  # compile, import
    print(f"{len(tiles)} points")
    for name, plane in planes.items():
        dropped = drop(folder)
        cold = time_image(tiles, plane, "normalized")
        colors = ("normalized", "height", "sensor", "time")
        warm = [time_image(tiles, plane, color) for color in colors]
        text = f"cold {cold[0]:.2f} s, " if dropped else ""
        slowest = max(warm)
        text += f"warm {slowest[0]:.2f} s ({slowest[1]:.2f} s of processor)"
        print(f"{name:20} {warm[0][2]:>10} points  {text}")
    began, used = time.perf_counter(), time.process_time()
    found = find_double_walls(tiles)
    seconds = time.perf_counter() - began
    text = f"{seconds:.1f} s ({time.process_time() - used:.1f} s of processor)"
    print(f"double walls: {text}, {found.patches} patches, {len(found.walls)} places")
    anonymous = [
        line for line in Path("/proc/self/status").read_text().splitlines() if "RssAnon" in line
    ]
    peak_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(f"peak resident {peak_kb / 1e6:.2f} GB, {' '.join(anonymous[0].split())} at the end")


def time_image(tiles: TileSet, plane: SlicePlane, color: str) -> tuple[float, float, int]:
    """Seconds of an image, PNG included, processor seconds, and its number of points."""
    began, used = time.perf_counter(), time.process_time()
    seen: SliceWindow = extent(tiles, plane)
    pixel_m = max((seen.right - seen.left) / 1600.0, (seen.top - seen.bottom) / 1200.0)
    made = draw(tiles, plane, RasterGrid(seen, pixel_m), color=color)
    png(made.rgba(made.span, "light"))
    return time.perf_counter() - began, time.process_time() - used, made.points


def drop(folder: Path) -> bool:
    """Drop the map's files from the page cache."""
    for path in (folder / "tiles").iterdir():
        descriptor = os.open(path, os.O_RDONLY)
        try:
            os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)
        finally:
            os.close(descriptor)
    return True


if __name__ == "__main__":
    main(Path(sys.argv[1]))
