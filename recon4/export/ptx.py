"""The map as PTX, scans as text: one for each node of the pose graph, with its pose.

A scan begins with its numbers of columns and rows, its position, its axes and its transformation;
its points follow, relative to its pose. Points of a walk are no grid: a scan is one row.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.export.node_scans import SCAN_ROW, ScanPoses, node_scans
from recon4.export.points import PointSource
from recon4.export.tuning import POINT_EXPORT, PTX
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.progress import Progress


def export_ptx(source: PointSource, path: Path, scans: ScanPoses, *, progress: Progress) -> int:
    """Write a map as PTX, and read it back.

    Intensity is the normalized one if the map has it, from 0 to 1. The format names neither a CRS
    nor an approval. Memory grows with the points of one scan.

    Args:
        source: The points, in the coordinates of the file.
        path: File to write.
        scans: Nodes of the pose graph.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If points are wanted that the map leaves out.
        StoreError: If the file does not read back.
        OSError: If it cannot be written.
    """
    with node_scans(source, path, scans, progress=progress) as sorted_:
        poses = [_pose(*one) for one in zip(scans.T_map_body.R, sorted_.origins, strict=True)]
        with path.open("w", encoding="ascii") as text:
            for number, file in sorted_.files:
                rows = np.fromfile(file, SCAN_ROW)
                text.write(_head(len(rows), poses[number]))
                for first in range(0, len(rows), POINT_EXPORT.block):
                    part = _numbers(rows[first : first + POINT_EXPORT.block])
                    np.savetxt(text, part, fmt="%.5f %.5f %.5f %.6f")
                progress.advance(len(rows))
        progress.start("compare", source.count, "points")
        _check(path, [(poses[number], file) for number, file in sorted_.files], progress)
    return source.count


def _head(count: int, pose: str) -> str:
    """Columns, rows and pose."""
    return f"{count}\n1\n{pose}"


def _pose(R_file_scan: Array, origin: Array) -> str:
    """Position, axes, and the transformation of row vectors, which has the axes as rows."""
    axes = [" ".join(f"{value:.12f}" for value in axis) for axis in R_file_scan.T]
    place = " ".join(f"{value:.6f}" for value in origin)
    return "\n".join([place, *axes, *(f"{axis} 0" for axis in axes), f"{place} 1", ""])


def _numbers(rows: NDArray[Any]) -> Array:
    """The numbers of a file, rounded as it writes them, (N, 4)."""
    x, y, z, bright = (rows[name].astype(np.float64) for name in SCAN_ROW.names or ())
    ratio = np.clip(bright / PTX.brightest, 0.0, 1.0) * PTX.intensity_steps
    steps = [PTX.steps] * 3 + [PTX.intensity_steps]
    return np.asarray(
        np.rint(np.column_stack([x * PTX.steps, y * PTX.steps, z * PTX.steps, ratio])) / steps + 0.0
    )  # no negative zeros


def _check(path: Path, scans: list[tuple[str, Path]], progress: Progress) -> None:
    """Read every scan back and compare it with what was written.

    Raises:
        StoreError: If it differs.
    """
    with path.open(encoding="ascii") as text:
        for index, (pose, file) in enumerate(scans):
            rows = np.fromfile(file, SCAN_ROW)
            head = _head(len(rows), pose).splitlines(keepends=True)
            if list(islice(text, len(head))) != head:
                raise StoreError(CodedText("reread-scan-head", file=path.name, index=index))
            for first, found in _blocks(text, len(rows)):
                expected = _numbers(rows[first : first + POINT_EXPORT.block])
                if not np.array_equal(found, expected):
                    raise StoreError(CodedText("reread-scan-points", file=path.name, index=index))
                progress.advance(len(found))
        if text.read(1):
            raise StoreError(CodedText("reread-more-scans", file=path.name, count=len(scans)))


def _blocks(text: IO[str], count: int) -> Iterator[tuple[int, Array]]:
    """First row and numbers of each block of the points of a scan."""
    for first in range(0, count, POINT_EXPORT.block):
        lines = list(islice(text, min(POINT_EXPORT.block, count - first)))
        try:
            yield first, np.loadtxt(lines, ndmin=2)
        except ValueError:
            yield first, np.empty((0, 4))
