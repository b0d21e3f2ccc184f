"""How large an export will be, without reading the whole map."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.delivery.kinds import (
    DELIVERY,
    KINDS,
    ExportEstimate,
    ExportKind,
    checked_kind,
    kind_named,
)
from recon4.export.expected import expected_points
from recon4.export.map_files import map_to_export
from recon4.export.options import ExportOptions
from recon4.mapping.tiles import TileSet
from recon4.report.pdf import require_pdf
from recon4.slices.map_crs import frame_of


def estimate_export(
    artifacts: Mapping[str, Path], kind_name: str, options: ExportOptions
) -> ExportEstimate:
    """Estimate an export from a sample of the map.

    Args:
        artifacts: Of the run; it has a map.
        kind_name: Of `recon4.delivery.kinds.KINDS`.
        options: What is wanted.

    Raises:
        ConfigError: If there is no such kind, class or storey, or it takes no such option.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
        StoreError: If an artifact cannot be read.
    """
    kind = kind_named(kind_name, options)
    if not kind.point_bytes:
        if options.crs:
            frame_of(dict(artifacts), options.crs)  # refuses one that is not possible here
        size = _raster_bytes(artifacts, kind, options)
        return ExportEstimate(points=0, bytes=size, is_most=True)
    map_ = map_to_export(artifacts, None, options)
    points = expected_points(map_.tiles, map_.output, map_.selection)
    every = replace(map_.selection, thin_m=0.0)
    of_points = expected_points(map_.tiles, map_.output, every) if options.thin_m else points
    return ExportEstimate(
        points=points,
        bytes=round(points * _point_bytes(kind, points, of_points)),
        is_most=False,
        sorted_bytes=round(points * kind.sorted_bytes),
    )


def estimate_delivery(
    artifacts: Mapping[str, Path],
    kind_names: Sequence[str],
    options: ExportOptions,
    *,
    packed_bytes: int,
) -> ExportEstimate:
    """Estimate a delivery: its files lie beside the ZIP while it is packed.

    Args:
        artifacts: Of the run; it has a map.
        kind_names: Of `recon4.delivery.kinds.KINDS`, made now.
        options: Their CRS.
        packed_bytes: Size of the files that were exported before.

    Raises:
        ConfigError: If the extra ``pdf`` is not installed, or as `estimate_export`.
        GeoreferenceError, StoreError: As `estimate_export`.
    """
    require_pdf()
    checked_kind(DELIVERY, options)
    parts = []
    for name in kind_names:
        taken = ExportOptions(crs=options.crs if "crs" in KINDS[name].takes else "")
        parts.append(estimate_export(artifacts, name, taken))
    size = packed_bytes + sum(one.bytes for one in parts)
    beside = size + max((one.sorted_bytes for one in parts), default=0)
    is_most = any(one.is_most and one.bytes for one in parts)
    return ExportEstimate(points=0, bytes=size, is_most=is_most, sorted_bytes=beside)


def _point_bytes(kind: ExportKind, points: int, of_points: int) -> float:
    """Bytes of a point of a map of which thinning leaves some: the fewer, the less alike."""
    if not (kind.thinned_bytes and points):
        return kind.point_bytes
    part = min(1.0, math.log(max(1.0, of_points / points), 32.0))
    return kind.point_bytes + part * (kind.thinned_bytes - kind.point_bytes)


def _raster_bytes(artifacts: Mapping[str, Path], kind: ExportKind, options: ExportOptions) -> int:
    """Bytes of an image without compression; 0 of what is none."""
    if not kind.name.endswith(".tif"):
        return 0
    low, high = TileSet.open(artifacts["map"]).bounds_m
    photo = kind.name.startswith("orthophoto")
    edge_m, cell_bytes = (options.pixel_m, 2) if photo else (options.cell_m, 4)
    return round(cell_bytes * float(np.prod(np.ceil((high - low)[:2] / edge_m))))
