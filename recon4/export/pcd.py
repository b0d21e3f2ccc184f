"""The map as a PCD file of the Point Cloud Library, binary."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.export.account import PointAccount
from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, Block, OutputCrs, PointSource
from recon4.export.reread import account_of_rows, check_size
from recon4.export.selection import DELIVERED, PointSelection
from recon4.export.tuning import PCD, REREAD
from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from recon4.model.gps_time import is_absolute, point_time_s
from recon4.progress import Progress, Silent
from recon4.store.atomic import atomic_file

_FIELDS = (
    *((name, "<f4") for name in ("x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity")),
    *(("ring", "<u2"), ("frame_id", "<u4"), ("gps_time", "<f8")),
    ("classification", "|u1"),
)


def export_pcd(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    selection: PointSelection = DELIVERED,
    progress: Progress | None = None,
) -> int:
    """Write a map as binary PCD 0.7, streaming.

    PCL reads coordinates in single precision only: far from the origin they are relative to whole
    meters near the middle of the map (``# offset`` in the head), exact to 0.03 mm within 500 m of
    it; those of a map near its origin are as in other files. Intensity is the normalized one if
    the map has it; normals stay in the map's frame.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.pcd``.
        output: CRS of the file.
        selection: Which points are written.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If there are no points, or the name is not one of a PCD file.
        StoreError: If the file cannot be written (`NoSpace`: disk full) or reads back wrong.
    """
    check_name(path, ".pcd")
    source = _lying(PointSource.of(map_, output, selection, progress=progress))
    names = [source.intensity, "normal", "ring", "frame_id", "t_ns"]
    row, absolute = np.dtype(list(_FIELDS)), is_absolute(source.tiles.first_ns)
    meant = PointAccount(crs=source.crs_line)
    head = _head(row, source, meant.crs)
    with atomic_file(path) as temporary:
        with temporary.open("wb") as file:
            file.write(head)
            for block in source.blocks(names, progress):
                rows = np.zeros(len(block.xyz), row)
                _fill(rows, block, source)
                rows["gps_time"] = point_time_s(block.columns["t_ns"], absolute=absolute)
                file.write(rows.data)
                meant.add(block.xyz, block.columns["classification"])
                meant.add_stored(rows)
        check_size(temporary, len(head) + source.count * row.itemsize, path.name)
        source.seal(temporary)
        again = account_of_rows(temporary, row, progress or Silent(), offset=source.offset)
        meant.compare(again, path.name, within_m=_rounded_m(meant, source.offset))
    return meant.count


def _lying(source: PointSource) -> PointSource:
    """The points with the offset that a PCD file needs."""
    return replace(source, offset=needed_offset(source.offset))


def needed_offset(middle: Array) -> Array:
    """What is subtracted [m], (3,), by the middle of the points: nothing if it is near.

    Other programs do not read the offset: a map in its own frame lies where its other files do.
    """
    return middle if np.abs(middle).max() > PCD.near_m else np.zeros(3)


def _rounded_m(meant: PointAccount, offset: Array) -> float:
    """How far single precision rounds the coordinates farthest from the offset [m]."""
    far_m = np.abs([meant.low_m - offset, meant.high_m - offset]).max()
    return REREAD.bounds_m + float(far_m * np.finfo(np.float32).eps)


def _fill(rows: NDArray[np.void], block: Block, source: PointSource) -> None:
    rows["x"], rows["y"], rows["z"] = (block.xyz - source.offset).T
    rows["intensity"] = block.columns[source.intensity]
    rows["classification"] = block.columns["classification"]
    for axis, name in enumerate(("normal_x", "normal_y", "normal_z")):
        rows[name] = block.columns["normal"][:, axis]
    rows["ring"] = block.columns["ring"]
    rows["frame_id"] = block.columns["frame_id"]


def _head(row: np.dtype[np.void], source: PointSource, crs: str) -> bytes:
    names = row.names or ()
    kinds = [row[name] for name in names]
    comments = [f"# crs {crs}"] if crs else []
    lines = [
        "# .PCD v0.7 - Point Cloud Data file format",
        *comments,
        "# offset {:.0f} {:.0f} {:.0f}".format(*source.offset),
        "VERSION 0.7",
        f"FIELDS {' '.join(names)}",
        f"SIZE {' '.join(str(kind.itemsize) for kind in kinds)}",
        f"TYPE {' '.join(kind.kind.upper() for kind in kinds)}",
        f"COUNT {' '.join('1' for _ in names)}",
        f"WIDTH {source.count}",
        "HEIGHT 1",
        "VIEWPOINT 0 0 0 1 0 0 0",
        f"POINTS {source.count}",
        "DATA binary",
    ]
    return ("\n".join(lines) + "\n").encode("ascii", "replace")
