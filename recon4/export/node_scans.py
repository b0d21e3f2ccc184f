"""The points of a map as scans: one for each node of the pose graph.

A point belongs to the last node before its multiframe. Points are relative to the pose of their
scan, in single precision: 4 µm at 50 m.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.export.points import PointSource
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Times
from recon4.progress import Progress

SCAN_ROW = np.dtype([("cartesianX", "<f4"), ("cartesianY", "<f4"), ("cartesianZ", "<f4"),
                     ("intensity", "<f4")])  # fmt: skip
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


@dataclass(frozen=True, slots=True, eq=False)
class NodeScans:
    """The points of a map by node, in temporary files of `SCAN_ROW`."""

    origins: Array
    """Positions of all nodes in the coordinates of the file that is made, (N, 3)."""
    files: list[tuple[int, Path]]
    """Node and file of each scan that has points."""


@contextmanager
def node_scans(
    source: PointSource, path: Path, scans: ScanPoses, *, progress: Progress
) -> Iterator[NodeScans]:
    """Sort the points of a map by node, each relative to the pose of its scan.

    Intensity is the normalized one if the map has it.

    Args:
        source: The points, in the coordinates of the file that is made.
        path: That file; temporary ones lie beside it until the end of the block.
        scans: Nodes of the pose graph.
        progress: Who watches.

    Raises:
        ConfigError: If points are wanted that the map leaves out: such files have no classes.
    """
    if source.selection.left_out:
        kind = path.suffix[1:].upper()
        raise ConfigError(CodedText("export-kind-classes", kind=kind))
    origins = source.transform(scans.T_map_body.t)
    with tempfile.TemporaryDirectory(prefix=f"{path.name}.", dir=path.parent) as folder:
        files = _sort_by_scan(source, scans, origins, folder=Path(folder), progress=progress)
        progress.start("scans", source.count, "points")
        yield NodeScans(origins, files)


def _sort_by_scan(
    source: PointSource, scans: ScanPoses, origins: Array, *, folder: Path, progress: Progress
) -> list[tuple[int, Path]]:
    """Write the points of each scan into a file; node and file of those that have points."""
    R_map_body = scans.T_map_body.R
    for block in source.blocks([source.intensity, "frame_id"], progress):
        frames = block.columns["frame_id"].astype(np.int64)
        scan = np.maximum(np.searchsorted(scans.frame_ids, frames, side="right") - 1, 0)
        p_body = np.einsum("nji,nj->ni", R_map_body[scan], block.xyz - origins[scan])
        rows = np.zeros(len(scan), SCAN_ROW)
        rows["cartesianX"], rows["cartesianY"], rows["cartesianZ"] = p_body.T
        rows["intensity"] = block.columns[source.intensity]
        for number, part in _by_scan(scan):
            with (folder / str(number)).open("ab") as file:
                file.write(np.ascontiguousarray(rows[part]).data)
    return sorted((int(file.name), file) for file in folder.iterdir())


def _by_scan(scan: NDArray[np.intp]) -> Iterator[tuple[int, NDArray[np.intp]]]:
    order = np.argsort(scan, kind="stable")
    numbers, starts = np.unique(scan[order], return_index=True)
    for number, (first, end) in zip(numbers, pairwise([*starts, len(scan)]), strict=True):
        yield int(number), order[first:end]
