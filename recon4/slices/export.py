"""Export of slices as LAZ, CSV and DXF; streamed, and atomic."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.export.points import OutputCrs
from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.tile import DEVIATION, STORED
from recon4.mapping.tile_order import progressive
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.recording.formats.scratch import scratch_folder
from recon4.slices.map_crs import MapFrame
from recon4.slices.points import SliceWindow, TilePart, points_in
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning_files import SLICE_EXPORT
from recon4.store.atomic import atomic_file


@dataclass(frozen=True, slots=True)
class SliceSelection:
    """The points of a map that lie in slices."""

    tiles: TileSet
    planes: Sequence[SlicePlane]
    window: SliceWindow | None = None
    """Only this part of each slice."""

    def parts(self, fields: Sequence[str]) -> Iterator[tuple[int, TilePart, Array]]:
        """Number of the slice (from 1), points with these fields, and their map coordinates."""
        for number, plane in enumerate(self.planes, start=1):
            for part in points_in(self.tiles, plane, fields, window=self.window):
                yield number, part, plane.to_map(part.uvd)


@dataclass(frozen=True, slots=True)
class DrawnPoints:
    """The points of a DXF."""

    layers: Sequence[tuple[int, Array]]
    """Number of the slice (from 1), and coordinates (N, 3)."""
    drawn: int
    """How many these are."""
    points: int
    """How many the slices have; a point of two slices counts twice."""


def write_laz(chosen: SliceSelection, path: Path, *, frame: MapFrame) -> int:
    """Write the points of slices as LAZ 1.4 with all fields; a point of two slices is there twice.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If the slices are empty.
        StoreError: If the file cannot be written or does not read back.
    """
    from recon4.export.laz import export_laz  # its libraries are slow to import

    tiles = chosen.tiles
    with scratch_folder(0) as folder:
        out = folder / "tiles"
        out.mkdir()
        fields = [name for name in tiles.fields if name in STORED]
        with TileWriter(out, fields, tile_m=tiles.tile_m, paths=tiles.columns.paths) as writer:
            writer.notes = tiles.notes
            for _, part, _ in chosen.parts(fields):
                order = progressive(np.arange(len(part)))
                writer.append(part.tile.ijk, {k: v[order] for k, v in part.columns.items()})
        if not len(TileSet.open(out)):
            raise ConfigError(CodedText("slice-empty"))
        return export_laz(out, path, OutputCrs(frame.wkt or None, frame.to_crs))


def write_csv(chosen: SliceSelection, path: Path, *, frame: MapFrame) -> int:
    """Write one line per point: slice, u, v and distance from the plane, coordinates, fields.

    Returns:
        How many points were written.
    """
    wanted = "intensity", "intensity_normalized", "sensor", "frame_id", "t_ns", DEVIATION
    fields = [name for name in wanted if name in chosen.tiles.fields]
    count = 0
    axes = ["easting_m", "northing_m", "height_m"] if frame.to_crs else ["x_m", "y_m", "z_m"]
    with atomic_file(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(f"# recon4 slice, {frame.written_text}\n")
        file.write(",".join(["slice", "u_m", "v_m", "off_m", *axes, *fields]) + "\n")
        for number, part, p_map in chosen.parts(fields):
            p = frame.to_crs(p_map) if frame.to_crs else p_map
            table = np.column_stack([np.full(len(part), number), part.uvd, p])
            extra = [part.columns[name] for name in fields]
            text = io.StringIO()
            rows = csv.writer(text, lineterminator="\n")
            for row, *values in zip(table, *extra, strict=True):
                rows.writerow([int(row[0]), *(f"{x:.4f}" for x in row[1:]), *map(_plain, values)])
            file.write(text.getvalue())
            count += len(part)
    return count


def write_dxf(chosen: SliceSelection, path: Path, *, frame: MapFrame, flat: bool = False) -> int:
    """Write points as DXF R2010 in meters: one layer per slice, one point per cm² of the slice.

    ezdxf writes the skeleton of the file; the points are written into it after they were counted.
    A comment at the begin of the file says how many points of the slices are drawn.

    Args:
        chosen: The points; layers are named by number and position of the slices.
        path: File to write.
        frame: Coordinates are in its CRS, if it has one.
        flat: u, v and 0 instead of coordinates: a section to lay on a sheet.

    Returns:
        How many points the slices have, as of every other format; fewer are drawn.

    Raises:
        ConfigError: If more than `SLICE_EXPORT.max_dxf_points` are to be drawn; nothing is written.
        StoreError: If the file cannot be written.
    """
    layers = [layer_name(k, plane) for k, plane in enumerate(chosen.planes, start=1)]
    made = _drawn(chosen, frame, flat=flat)
    before, after, owner = _dxf_frame(layers)
    handle = _FIRST_HANDLE
    with atomic_file(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(
            f"999\nrecon4 slice: {made.drawn} of {made.points} points, one per square centimeter\n"
        )
        file.write(before)
        for number, p in made.layers:
            file.writelines(_dxf_points(p, layers[number - 1], owner=owner, handle=handle))
            handle += len(p)
        file.write(after)
    return made.points


def _drawn(chosen: SliceSelection, frame: MapFrame, *, flat: bool) -> DrawnPoints:
    """The first point of each square centimeter of each slice.

    Raises:
        ConfigError: If there are too many; none are kept while the rest is counted.
    """
    kept: list[tuple[int, Array]] = []
    cells: list[NDArray[np.int64]] = [np.empty(0, np.int64) for _ in chosen.planes]
    points = 0
    for number, part, p_map in chosen.parts([]):
        points += len(part)
        rows, cells[number - 1] = _first_of_cells(part.uvd, cells[number - 1])
        if sum(map(len, cells)) > SLICE_EXPORT.max_dxf_points:
            kept.clear()
        elif flat:
            kept.append((number, part.uvd[rows] * [1.0, 1.0, 0.0]))
        else:
            p = p_map[rows]
            kept.append((number, frame.to_crs(p) if frame.to_crs else p))
    drawn = sum(map(len, cells))
    if drawn > SLICE_EXPORT.max_dxf_points:
        raise ConfigError(
            CodedText("dxf-many", max_dxf_points=SLICE_EXPORT.max_dxf_points, drawn=drawn)
        )
    return DrawnPoints(kept, drawn, points)


def _first_of_cells(
    uvd: Array, taken: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of the first points, (N, 3) given, of square centimeters that are not taken yet.

    Returns:
        Rows, and the keys of all squares that are taken after them, ascending.
    """
    u, v = np.floor(uvd[:, :2] / SLICE_EXPORT.dxf_cell_m).astype(np.int64).T
    keys, first = np.unique((u << 32) + v, return_index=True)
    fresh = ~np.isin(keys, taken, assume_unique=True)
    return np.sort(first[fresh]), distinct(np.append(taken, keys[fresh]))


def layer_name(number: int, plane: SlicePlane) -> str:
    """Layer name of a slice, in characters every CAD program accepts."""
    place = {
        "horizontal": f"Z_{plane.origin_m[2]:.3f}",
        "vertical": f"V_{plane.offset_m:.3f}",
        "free": f"F_{plane.offset_m:.3f}",
    }[plane.kind]
    return f"SLICE_{number:03d}_{place}".replace(".", "_")


_FIRST_HANDLE = 0x10000
_NEXT_HANDLE = 0x1000_0000


def _dxf_points(p: Array, layer: str, *, owner: str, handle: int) -> Iterator[str]:
    """Entities of points (N, 3); ``handle`` is that of the first."""
    for k, (x, y, z) in enumerate(p.tolist()):
        yield (
            f"  0\nPOINT\n  5\n{handle + k:X}\n330\n{owner}\n100\nAcDbEntity\n  8\n{layer}\n"
            f"100\nAcDbPoint\n 10\n{x:.4f}\n 20\n{y:.4f}\n 30\n{z:.4f}\n"
        )


def _dxf_frame(layers: list[str]) -> tuple[str, str, str]:
    """Text before and after the entities of an empty drawing, and the handle of their owner."""
    import ezdxf.filemanagement
    import ezdxf.units

    drawing = ezdxf.filemanagement.new("R2010", units=ezdxf.units.M)
    for k, layer in enumerate(layers):
        drawing.layers.add(layer, color=1 + k % 6)
    drawing.header["$PDMODE"], drawing.header["$PDSIZE"] = 0, 0.0
    owner = drawing.modelspace().layout_key
    marker = drawing.modelspace().add_point((0, 0))
    drawing.entitydb.handles.reset(f"{_NEXT_HANDLE:X}")  # leaves room for our points
    text = io.StringIO()
    drawing.write(text)
    whole = text.getvalue()
    at = whole.index(f"  0\nPOINT\n  5\n{marker.dxf.handle}\n")
    end = whole.index("  0\nENDSEC\n", at)
    return whole[:at], whole[end:], owner


def _plain(value: Any) -> str:
    return f"{value:.4f}" if isinstance(value, np.floating) else str(int(value))
