"""The points of a map as scans: one for each node of the pose graph.

A point belongs to the last node before its multiframe. Points are relative to the pose of their
scan, in single precision: 4 µm at 50 m.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.export.points import PointSource
from recon4.geometry.se3 import SE3, Array
from recon4.model.trajectory import Times
from recon4.progress import Progress

SCAN_ROW = np.dtype([("cartesianX", "<f8"), ("cartesianY", "<f8"), ("cartesianZ", "<f8"),
                     ("intensity", "<f8")])  # fmt: skip
"""A point of a scan: place relative to its pose [m], and intensity."""


@dataclass(frozen=True, slots=True, eq=False)
class ScanPoses:
    """Where and when the nodes of the pose graph are."""

    frame_ids: NDArray[np.int64]
    """Multiframe of each node, ascending, (N,)."""
    t_ns: Times
    """Its time [ns], (N,)."""
    T_map_body: SE3
    """Its pose, (N,)."""
    note: str = ""
    """Description of each scan: the approval, for one."""


def sort_by_scan(
    source: PointSource, scans: ScanPoses, origins: Array, *, folder: Path, progress: Progress
) -> list[tuple[int, Path]]:
    """Write the points of each scan, relative to its pose, into a file of `SCAN_ROW`.

    Intensity is the normalized one if the map has it.

    Args:
        source: The points, in the coordinates of the file that is made of them.
        scans: Nodes of the pose graph.
        origins: Their positions in these coordinates, (N, 3).
        folder: Receives the files.
        progress: Who watches.

    Returns:
        Node and file of each scan that has points.
    """
    R_map_body = scans.T_map_body.R
    for block in source.blocks([source.intensity, "frame_id"], progress):
        frames = block.columns["frame_id"].astype(np.int64)
        scan = np.maximum(np.searchsorted(scans.frame_ids, frames, side="right") - 1, 0)
        p_body = np.einsum("nji,nj->ni", R_map_body[scan], block.xyz - origins[scan])
        rows = np.zeros(len(scan), SCAN_ROW)
        rows["cartesianX"], rows["cartesianY"], rows["cartesianZ"] = p_body.T.astype(np.float32)
        rows["intensity"] = block.columns[source.intensity].astype(np.float32)
        for number, part in _by_scan(scan):
            with (folder / str(number)).open("ab") as file:
                file.write(np.ascontiguousarray(rows[part]).data)
    return sorted((int(file.name), file) for file in folder.iterdir())


def _by_scan(scan: NDArray[np.intp]) -> Iterator[tuple[int, NDArray[np.intp]]]:
    order = np.argsort(scan, kind="stable")
    numbers, starts = np.unique(scan[order], return_index=True)
    for number, (first, end) in zip(numbers, pairwise([*starts, len(scan)]), strict=True):
        yield int(number), order[first:end]
