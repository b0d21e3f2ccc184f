"""The map as LAZ 1.4, point format 6 (the only place that imports laspy).

lazrs keeps a pool of threads that does not survive a fork: a worker process that writes LAZ must be
spawned.
"""

from __future__ import annotations

import io
import uuid
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import chain
from pathlib import Path
from typing import Any

import laspy
import lazrs  # type: ignore[import-untyped]
import numpy as np
import pyproj
from numpy.typing import NDArray

import recon4
from recon4.errors import GeoreferenceError, StoreError
from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, Block, OutputCrs, blocks, center, output_transform
from recon4.mapping.tile import DEVIATION
from recon4.mapping.tiles import TileSet
from recon4.model.gps_time import day_of, is_absolute, point_time_s
from recon4.progress import Progress, Silent
from recon4.store.atomic import atomic_file

SCALE_M = 0.001
"""Resolution of the coordinates [m]."""
NORMALIZED_STEP = 1.0 / 16.0
"""Normalized intensities are rounded to this: finer than the raw step, and it compresses."""
DEVIATION_STEP_M = 0.0001
"""Deviations of positions are stored as whole steps, which compress better than floats [m]."""
FIELDS = ["intensity", "ring", "sensor", "echo", "frame_id", "t_ns"]
"""What is read beside the coordinates."""
OPTIONAL = {
    "intensity_normalized": ("f4", "beam, range, incidence removed"),
    "surface_returns": ("u2", "returns the surface is fitted to"),
    "surface_sd_m": ("f4", "deviation across the surface"),
    "planarity": ("f4", "0..1"),
    DEVIATION: ("u4", "1 sigma by pose, worst axis"),
}
"""Fields a map may have: type and description of the extra dimension."""
COPIED = ("surface_returns", "surface_sd_m", "planarity")
LOW_NOISE, HIGH_NOISE = 7, 18
"""Classes of stray returns: beside a surface, as where a beam hits two things; alone in the air."""


@dataclass(slots=True)
class _WrittenBounds:
    """What the file must turn out to hold."""

    count: int = 0
    low: NDArray[np.int64] = field(default_factory=lambda: np.full(3, np.iinfo(np.int64).max))
    high: NDArray[np.int64] = field(default_factory=lambda: np.full(3, np.iinfo(np.int64).min))
    first: Any = None
    last: Any = None


class _ErrorKeepingWriter(io.BufferedWriter):
    """Keeps the error of a failed write, because lazrs does not report it."""

    write_error: OSError | None = None

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except OSError as error:
            self.write_error = error
            raise


def export_laz(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    strays: bool = False,
    progress: Progress | None = None,
) -> int:
    """Write a map as LAZ, streaming, and check the file before it gets its name.

    Intensity is the raw one; ``ring``, ``frame_id`` and those of `OPTIONAL` are extra bytes,
    the point source is the sensor's row + 1, the return number is 2 for a further echo. Times
    are adjusted standard GPS time, or seconds of the recording's clock if that is not UTC.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.laz``.
        output: CRS of the file.
        strays: Also write the stray returns, as class 7 beside a surface and 18 alone in the air.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If the map has no points, or the name is not one of a LAZ file.
        GeoreferenceError: If the CRS is not understood, or coordinates do not fit.
        StoreError: If the file cannot be written or does not read back (`NoSpace`: disk full).
    """
    check_name(path, ".laz")
    tiles = TileSet.open(map_) if isinstance(map_, Path) else map_
    transform = output_transform(tiles, output.map_to_crs)
    crs = output.crs or (tiles.crs and tiles.crs.wkt) or None
    header = _header(tiles, center(tiles, transform), crs)
    fields = [name for name in [*FIELDS, *OPTIONAL] if name in tiles.fields]
    stream = blocks(tiles, fields, transform=transform, progress=progress or Silent())
    if strays:
        only, more = tiles.only_strays(), [*fields, "normal"]
        of_strays = blocks(only, more, transform=transform, progress=progress or Silent())
        stream = chain(stream, (replace(block, strays=True) for block in of_strays))
    with atomic_file(path) as temporary, _ErrorKeepingWriter(io.FileIO(temporary, "wb")) as file:
        try:
            written = _write(file, header, stream)
            file.flush()
            _check(temporary, written, header)
        except (laspy.errors.LaspyException, lazrs.LazrsError) as error:
            if file.write_error:
                raise file.write_error from error
            raise StoreError(f"cannot write {path}: {error}") from error
    return written.count


def _header(tiles: TileSet, offset: NDArray[np.float64], crs: str | None) -> Any:
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.full(3, SCALE_M), offset
    header.generating_software = f"recon4 {recon4.__version__}"
    header.system_identifier = "MERGE"
    # The same map gives the same bytes: no random UUID and no date of the day.
    header.uuid = uuid.UUID(int=0)
    first_ns = tiles.first_ns
    header.creation_date = day_of(max(first_ns, 0))
    header.global_encoding.gps_time_type = (
        laspy.header.GpsTimeType.STANDARD
        if is_absolute(first_ns)
        else laspy.header.GpsTimeType.WEEK_TIME
    )
    extra = [("ring", "u1", "beam, 0 = lowest"), ("frame_id", "u4", "multiframe")]
    extra += [(name, *OPTIONAL[name]) for name in OPTIONAL if name in tiles.fields]
    header.add_extra_dims([_dimension(*row) for row in extra])
    header.global_encoding.wkt = True
    if crs is not None:
        header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(_wkt(crs)))
    return header


def _dimension(name: str, kind: str, description: str) -> Any:
    """An extra dimension; deviations are whole steps with a scale, which readers apply."""
    if name != DEVIATION:
        return laspy.ExtraBytesParams(name, kind, description)
    scale, offset = np.array([DEVIATION_STEP_M]), np.zeros(1)
    return laspy.ExtraBytesParams(name, kind, description, offsets=offset, scales=scale)


def _wkt(crs: str) -> str:
    """The WKT that LAS 1.4 requires (version 1), or the newer one for a CRS it cannot express."""
    try:
        known = pyproj.CRS.from_user_input(crs)
    except pyproj.exceptions.CRSError as error:
        raise GeoreferenceError(f"not a CRS: {crs[:80]!r}: {error}") from error
    try:
        return str(known.to_wkt("WKT1_GDAL"))
    except pyproj.exceptions.CRSError:
        return str(known.to_wkt())


def _write(file: _ErrorKeepingWriter, header: Any, stream: Iterable[Block]) -> _WrittenBounds:
    written = _WrittenBounds()
    absolute = header.global_encoding.gps_time_type == laspy.header.GpsTimeType.STANDARD
    with laspy.open(
        file,
        mode="w",
        header=header,
        laz_backend=laspy.LazBackend.LazrsParallel,
        closefd=False,
    ) as out:
        for block in stream:
            points = _points(block, header, absolute=absolute)
            out.write_points(points)
            steps = np.stack([points.X, points.Y, points.Z]).astype(np.int64)
            written.count += len(points)
            written.low = np.minimum(written.low, steps.min(axis=1))
            written.high = np.maximum(written.high, steps.max(axis=1))
            written.last = points.array[-1].copy()
            written.first = points.array[0].copy() if written.first is None else written.first
    return written


def _points(block: Block, header: Any, *, absolute: bool) -> Any:
    steps = np.rint((block.xyz - header.offsets) / SCALE_M)
    if not (np.abs(steps) < 2**31 - 1).all():
        raise GeoreferenceError("the map is wider than 4000 km or has coordinates without meaning")
    points = laspy.ScaleAwarePointRecord.zeros(len(steps), header=header)
    columns = block.columns
    points.X[:], points.Y[:], points.Z[:] = steps.T.astype(np.int32)
    points.intensity[:] = columns["intensity"]
    points.return_number = columns["echo"] + 1
    # The smallest it can be: a map does not store how many returns a shot had.
    points.number_of_returns = columns["echo"] + 1
    points.point_source_id[:] = columns["sensor"].astype(np.uint16) + 1
    points.gps_time[:] = point_time_s(columns["t_ns"], absolute=absolute)
    points["ring"][:] = columns["ring"]
    points["frame_id"][:] = columns["frame_id"]
    if block.strays:
        # Too few others around it for a normal: nothing else was measured there.
        alone = ~columns["normal"].any(axis=1)
        points.classification[:] = np.where(alone, HIGH_NOISE, LOW_NOISE)
    for name in COPIED:
        if name in columns:
            points[name][:] = columns[name]
    if "intensity_normalized" in columns:
        fine = columns["intensity_normalized"]
        points["intensity_normalized"][:] = np.rint(fine / NORMALIZED_STEP) * NORMALIZED_STEP
    if DEVIATION in columns:
        points[DEVIATION] = columns[DEVIATION].astype(np.float64)
    return points


def _check(path: Path, written: _WrittenBounds, header: Any) -> None:
    """Read back count, bounds, CRS, and the first and last point.

    Raises:
        StoreError: If the file differs from what was written.
    """
    with laspy.open(path) as file:
        found = file.header
        if found.point_count != written.count:
            raise StoreError(
                f"{path.name} reads back wrong: {found.point_count} points, "
                f"expected {written.count}"
            )
        low = np.rint((found.mins - header.offsets) / SCALE_M)
        high = np.rint((found.maxs - header.offsets) / SCALE_M)
        first = file.read_points(1).array[0]
        file.seek(written.count - 1)
        last = file.read_points(1).array[0]
        pairs = {
            "bounds": ((*written.low, *written.high), (*low, *high)),
            "CRS": (_crs_text(header), _crs_text(found)),
            "first point": (written.first.tobytes(), first.tobytes()),
            "last point": (written.last.tobytes(), last.tobytes()),
        }
    for what, (expected, got) in pairs.items():
        if expected != got:
            raise StoreError(
                f"{path.name} reads back wrong: {what}: expected {expected}, got {got}"
            )


def _crs_text(header: Any) -> str:
    found = header.vlrs.get("WktCoordinateSystemVlr")
    return str(found[0].string).rstrip("\0") if found else ""
