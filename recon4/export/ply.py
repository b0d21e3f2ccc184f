"""The map as a binary PLY file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.export.account import PointAccount
from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, Block, OutputCrs, PointSource
from recon4.export.reread import account_of_rows, check_size
from recon4.export.selection import DELIVERED, PointSelection
from recon4.export.tuning import REREAD
from recon4.mapping.tiles import TileSet
from recon4.model.gps_time import is_absolute, point_time_s
from recon4.progress import Progress, Silent
from recon4.store.atomic import atomic_file

_PROPERTIES = {"<f8": "double", "<f4": "float", "<u4": "uint", "<u2": "ushort", "|u1": "uchar"}
_COLUMNS = {
    "intensity": "<u2",
    "intensity_normalized": "<f4",
    "ring": "|u1",
    "sensor": "|u1",
    "echo": "|u1",
    "frame_id": "<u4",
    "range_m": "<f4",
    "incidence_rad": "<f4",
}


def export_ply(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    selection: PointSelection = DELIVERED,
    progress: Progress | None = None,
) -> int:
    """Write a map as little-endian PLY with all its fields, streaming.

    Coordinates are doubles in the map's CRS (or the map's frame if it has none); normals stay in
    the map's frame; ``gps_time`` is as in `recon4.export.laz.export_laz`.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.ply``.
        output: CRS of the file.
        selection: Which points are written.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If there are no points, or the name is not one of a PLY file.
        StoreError: If the file cannot be written (`NoSpace`: disk full) or reads back wrong.
    """
    check_name(path, ".ply")
    watch = progress or Silent()
    source = PointSource.of(map_, output, selection, progress=watch)
    tiles = source.tiles
    fields = [name for name in _COLUMNS if name in tiles.fields]
    row = _row(fields)
    absolute = is_absolute(tiles.first_ns)
    meant = PointAccount(crs=source.crs_line)
    stream = source.blocks([*fields, "normal", "t_ns"], watch)
    with atomic_file(path) as temporary:
        head = _head(row, source.count, meant.crs)
        with temporary.open("wb") as file:
            file.write(head)
            for block in stream:
                rows = _rows(block, row, fields, absolute=absolute)
                file.write(rows.data)
                meant.add(block.xyz, block.columns["classification"])
                meant.add_stored(rows)
        check_size(temporary, len(head) + source.count * row.itemsize, path.name)
        source.seal(temporary)
        again = account_of_rows(temporary, row, watch, offset=np.zeros(3))
        meant.compare(again, path.name, within_m=REREAD.bounds_m)
    return meant.count


def _row(fields: list[str]) -> np.dtype[np.void]:
    columns = [(axis, "<f8") for axis in ("x", "y", "z")]
    columns += [(axis, "<f4") for axis in ("nx", "ny", "nz")]
    columns += [(name, _COLUMNS[name]) for name in fields]
    return np.dtype([*columns, ("classification", "|u1"), ("gps_time", "<f8")])


def _head(row: np.dtype[np.void], count: int, crs: str) -> bytes:
    lines = ["ply", "format binary_little_endian 1.0", "comment recon4 map"]
    if crs:
        lines.append(f"comment crs {crs}")
    lines.append(f"element vertex {count}")
    lines += [f"property {_PROPERTIES[row[name].str]} {name}" for name in row.names or ()]
    return ("\n".join([*lines, "end_header"]) + "\n").encode("ascii")


def _rows(
    block: Block, row: np.dtype[np.void], fields: list[str], *, absolute: bool
) -> np.ndarray[tuple[int], np.dtype[np.void]]:
    out = np.zeros(len(block.xyz), row)
    for axis in range(3):
        out["xyz"[axis]] = block.xyz[:, axis]
        out[("nx", "ny", "nz")[axis]] = block.columns["normal"][:, axis]
    for name in fields:
        out[name] = block.columns[name]
    out["classification"] = block.columns["classification"]
    out["gps_time"] = point_time_s(block.columns["t_ns"], absolute=absolute)
    return out
