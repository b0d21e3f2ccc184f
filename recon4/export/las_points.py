"""The map as points of LAS 1.4, point format 6: the header and the records of LAZ and COPC."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Mapping
from typing import Any

import laspy
import numpy as np
import pyproj
from numpy.typing import NDArray

import recon4
from recon4.errors import GeoreferenceError
from recon4.export.account import PointAccount
from recon4.export.points import Block, PointSource
from recon4.export.tuning import LAZ
from recon4.kernels.las import whole_steps
from recon4.locales.coded import CodedText
from recon4.mapping.tile import DEVIATION
from recon4.model.gps_time import day_of, is_absolute, point_time_s
from recon4.progress import Progress

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


def las_blocks(source: PointSource, progress: Progress | None) -> Iterator[Block]:
    """All points of a map with what their records need."""
    fields = [name for name in [*FIELDS, *OPTIONAL] if name in source.tiles.fields]
    return source.blocks(fields, progress)


def las_header(source: PointSource, *, scale_m: float) -> Any:
    """The header of a file of the map, with its extra dimensions and its CRS, without points.

    Args:
        source: The map, in the coordinates of the file.
        scale_m: Step of the coordinates [m].

    Raises:
        GeoreferenceError: If the CRS is not understood.
    """
    tiles = source.tiles
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.full(3, scale_m), source.offset
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
    for listed in header.vlrs.get("ExtraBytesVlr")[0].extra_bytes_structs:
        # Laspy would state those of the first point of each call that writes some.
        listed.options &= ~(listed.MIN_BIT_MASK | listed.MAX_BIT_MASK)
    header.global_encoding.wkt = True
    if source.crs:
        header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(_wkt(source.crs)))
    return header


def _dimension(name: str, kind: str, description: str) -> Any:
    """An extra dimension; deviations are whole steps with a scale, which readers apply."""
    if name != DEVIATION:
        return laspy.ExtraBytesParams(name, kind, description)
    scale, offset = np.array([LAZ.deviation_step_m]), np.zeros(1)
    return laspy.ExtraBytesParams(name, kind, description, offsets=offset, scales=scale)


def _wkt(crs: str) -> str:
    """The WKT that LAS 1.4 requires (version 1), or the newer one for a CRS it cannot express."""
    try:
        known = pyproj.CRS.from_user_input(crs)
    except pyproj.exceptions.CRSError as error:
        raise GeoreferenceError(CodedText("export-no-crs", crs=crs[:80], why=str(error))) from error
    try:
        return str(known.to_wkt("WKT1_GDAL"))
    except pyproj.exceptions.CRSError:
        return str(known.to_wkt())


def las_records(count: int, header: Any) -> NDArray[np.void]:
    """Room for records of a file, zeros, (N,)."""
    return np.zeros(count, header.point_format.dtype())


def las_points(
    block: Block, header: Any, records: NDArray[np.void], *, account: PointAccount
) -> Any:
    """Points of the map as records of a file.

    Args:
        block: The points, at least one.
        header: Of `las_header`.
        records: Receives the records, (N,): of `las_records`, or of other points.
        account: Accounts for them, but for their stored bytes.

    Raises:
        GeoreferenceError: If they are too far from the header's offset for its steps.
    """
    absolute = header.global_encoding.gps_time_type == laspy.header.GpsTimeType.STANDARD
    xyz, steps = np.ascontiguousarray(block.xyz), np.empty((3, len(records)), np.int32)
    corners = np.empty((2, 3))
    if not whole_steps(xyz, header.offsets, header.scales, steps, corners):
        wide_km = round(4e6 * header.scales[0])
        raise GeoreferenceError(CodedText("export-wide", wide_km=str(wide_km)))
    points = laspy.ScaleAwarePointRecord(
        records, header.point_format, header.scales, header.offsets
    )
    columns = block.columns
    account.add_summary(len(xyz), corners, columns["classification"])
    points.X[:], points.Y[:], points.Z[:] = steps
    points.intensity[:] = columns["intensity"]
    # The number of returns is the smallest it can be: a map does not store how many a shot had.
    number = (columns["echo"] + 1) & 0xF
    records["bit_fields"] = number | (number << 4)
    points.point_source_id[:] = columns["sensor"].astype(np.uint16) + 1
    points.gps_time[:] = point_time_s(columns["t_ns"], absolute=absolute)
    points["ring"][:] = columns["ring"]
    points["frame_id"][:] = columns["frame_id"]
    points.classification[:] = columns["classification"]
    for name in COPIED:
        if name in columns:
            points[name][:] = columns[name]
    if "intensity_normalized" in columns:
        fine = columns["intensity_normalized"]
        points["intensity_normalized"][:] = (
            np.rint(fine / LAZ.normalized_step) * LAZ.normalized_step
        )
    if DEVIATION in columns:
        points[DEVIATION] = columns[DEVIATION].astype(np.float64)
    return points


def add_records(account: PointAccount, records: NDArray[np.void], header: Any) -> None:
    """Account for records that were read, (N,)."""
    if not len(records):
        return
    ends = np.array([(records[axis].min(), records[axis].max()) for axis in "XYZ"]).T
    points = laspy.ScaleAwarePointRecord(
        records, header.point_format, header.scales, header.offsets
    )
    # The place of a step grows with it, so the outermost steps are at the bounds.
    corners = ends * header.scales + header.offsets
    account.add_summary(len(records), corners, np.asarray(points.classification))


def values_header(values: Mapping[str, str], crs: str, offset_m: NDArray[np.float64]) -> Any:
    """The header of a file of points with values of their own, without points.

    Args:
        values: Name of each extra dimension -> its type, as ``f4``.
        crs: WKT or code of the CRS; empty = a local frame.
        offset_m: Of the coordinates, (3,).

    Raises:
        GeoreferenceError: If the CRS is not understood.
    """
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.full(3, LAZ.scale_m), offset_m
    header.generating_software = f"recon4 {recon4.__version__}"
    header.uuid, header.creation_date = uuid.UUID(int=0), day_of(0)
    header.add_extra_dims([laspy.ExtraBytesParams(name, kind) for name, kind in values.items()])
    header.global_encoding.wkt = True
    if crs:
        header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(_wkt(crs)))
    return header


def value_records(header: Any, xyz: NDArray[np.float64], values: Mapping[str, NDArray[Any]]) -> Any:
    """Points with values as records of a file of `values_header`.

    Args:
        header: Of the file.
        xyz: Coordinates of the file [m], (N, 3).
        values: Of each extra dimension, (N,).
    """
    points = laspy.ScaleAwarePointRecord(
        las_records(len(xyz), header), header.point_format, header.scales, header.offsets
    )
    steps = np.rint((xyz - header.offsets) / header.scales)
    points.X[:], points.Y[:], points.Z[:] = steps.T.astype(np.int32)
    points.array["bit_fields"] = 1 | (1 << 4)
    for name, of in values.items():
        points.array[name] = of
    return points


def crs_text(header: Any) -> str:
    """The WKT that a header names; empty = none."""
    found = header.vlrs.get("WktCoordinateSystemVlr")
    return str(found[0].string).rstrip("\0") if found else ""
