"""Comparison of map slices with a reference: the rows of V Table 3.2."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.evaluation.slices import (
    OUTLIER_M,
    RelativeError,
    Slice,
    SliceError,
    merge_slices,
    relative_error,
)
from recon4.geometry.se3 import SE3
from recon4.mapping.tiles import TileSet
from recon4.model.plain import finite_or_none
from recon4.slices.points import points_in
from recon4.slices.reference import Method, Reference
from recon4.slices.slice_plane import ERROR_THICKNESS_M, SlicePlane, horizontal, vertical


@dataclass(frozen=True, slots=True)
class ComparedSlice:
    """A `SliceError` whose figures are None without points."""

    name: str
    points: int
    outliers: int
    mean_m: float | None
    ratio_within_2cm: float | None
    ratio_within_5cm: float | None

    @staticmethod
    def of(row: SliceError) -> ComparedSlice:
        """The row of a slice."""
        return ComparedSlice(
            name=row.name,
            points=row.points,
            outliers=row.outliers,
            mean_m=finite_or_none(row.mean_m),
            ratio_within_2cm=finite_or_none(row.ratio_within_2cm),
            ratio_within_5cm=finite_or_none(row.ratio_within_5cm),
        )


@dataclass(frozen=True, slots=True)
class Comparison:
    """Errors of map slices against a reference (V Table 3.2), as plain values."""

    slices: tuple[ComparedSlice, ...]
    point_weighted: ComparedSlice
    """All slices together, weighted by points."""
    plain_mean_m: float | None
    """Unweighted mean of the slices' means [m]; None = no points."""
    outlier_m: float
    """Points farther from the reference are only counted [m]."""
    histogram: tuple[int, ...]
    """Points by distance, up to 100 classes of 1 mm."""
    reference: str
    """Name of the reference."""
    method: Method

    @staticmethod
    def of(found: RelativeError, reference: Reference) -> Comparison:
        """The comparison with a reference."""
        return Comparison(
            slices=tuple(ComparedSlice.of(row) for row in found.slices),
            point_weighted=ComparedSlice.of(found.point_weighted),
            plain_mean_m=finite_or_none(found.plain_mean_m),
            outlier_m=found.outlier_m,
            histogram=tuple(found.histogram[:100].tolist()),
            reference=reference.name,
            method=reference.method,
        )


def compare(tiles: TileSet, planes: Sequence[SlicePlane], reference: Reference) -> RelativeError:
    """Mean distance and ratios within 2 and 5 cm of every slice, from all its points.

    Points farther than 0.5 m from the reference (people, changed objects) are outliers and counted
    separately. Averages are weighted by points, as in V, and plain over the slices.

    Raises:
        ConfigError: Without slices.
    """
    if not planes:
        raise ConfigError("comparison: expected one slice or more, got none")
    found = [_one(tiles, plane, reference) for plane in planes]
    rows = tuple(one.slices[0] for one in found)
    measured = [row.mean_m for row in rows if row.points]
    return RelativeError(
        slices=rows,
        point_weighted=merge_slices(rows),
        plain_mean_m=float(np.mean(measured)) if measured else float("nan"),
        outlier_m=OUTLIER_M,
        histogram=np.sum([one.histogram for one in found], axis=0),
        alignment="given",
    )


def _one(tiles: TileSet, plane: SlicePlane, reference: Reference) -> RelativeError:
    return relative_error(
        (plane.to_map(part.uvd) for part in points_in(tiles, plane)),
        [Slice(plane.name, plane.normal, plane.offset_m, plane.thickness_m)],
        T_model_map=SE3.identity(),
        distance=reference.distance,
    )


def usual_planes(
    tiles: TileSet, *, thickness_m: float = ERROR_THICKNESS_M
) -> tuple[SlicePlane, ...]:
    """Eight slices spread evenly: four horizontal, two across x, two across y (V §3.2)."""
    low, high = tiles.bounds_m
    if not np.isfinite(low).all():
        raise ConfigError("the map has no points")
    x, y, z = ((low[a] + (np.arange(4) + 0.5) / 4.0 * (high - low)[a]) for a in range(3))
    planes = [horizontal(float(h), thickness_m=thickness_m) for h in z]
    for k in (0, 2):
        middle = (x[k] + x[k + 1]) / 2.0
        planes.append(
            vertical((middle, float(low[1])), (middle, float(high[1])), thickness_m=thickness_m)
        )
    for k in (0, 2):
        middle = (y[k] + y[k + 1]) / 2.0
        planes.append(
            vertical((float(low[0]), middle), (float(high[0]), middle), thickness_m=thickness_m)
        )
    return tuple(planes)


def to_csv(found: RelativeError) -> str:
    """The table as CSV in centimeters and percent: one row per slice, then both averages."""
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["slice", "points", "outliers", "mean_cm", "below_2cm_pct", "below_5cm_pct"])
    for row in (*found.slices, found.point_weighted):
        name = "average weighted by points" if row is found.point_weighted else row.name
        rows.writerow([name, row.points, row.outliers, *_figures(row)])
    rows.writerow(["plain average of the slices", "", "", _number(100.0 * found.plain_mean_m)])
    return out.getvalue()


def _figures(row: SliceError) -> list[str]:
    return [
        _number(100.0 * value) for value in (row.mean_m, row.ratio_within_2cm, row.ratio_within_5cm)
    ]


def _number(value: float) -> str:
    return f"{value:.2f}" if np.isfinite(value) else ""
