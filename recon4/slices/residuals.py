"""Residuals at control and check points, compared with the limits."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import astuple, dataclass
from types import MappingProxyType

import numpy as np

from recon4.evaluation.markers import (
    MAX_HORIZONTAL_LIMIT_M,
    MAX_VERTICAL_LIMIT_M,
    MEAN_HORIZONTAL_LIMIT_M,
    MEAN_VERTICAL_LIMIT_M,
)
from recon4.geometry.se3 import Array
from recon4.model.plain import finite_or_none
from recon4.model.samples import GEOID_SEPARATION_M
from recon4.slices.control_points import ControlPoint, Role
from recon4.slices.error_ellipses import ErrorEllipse, error_ellipse

_NEARLY_M = 1.0
"""Largest deviation from it, and largest horizontal error: heights alone are of another kind."""
_TWO_HEIGHTS = (
    "This is as with a geoid: either the map or the survey has heights above sea level "
    "(orthometric), and the other above the ellipsoid."
)
RELATIVE_LIMIT_M = 0.05
"""Limit for the error of distances between points of the map (requirements, relative)."""


@dataclass(frozen=True, slots=True)
class Residual:
    """Residual of one point: map minus survey."""

    id: str
    role: Role
    east_m: float
    north_m: float
    up_m: float
    d2_m: float
    d3_m: float
    stated: ErrorEllipse | None
    """How well the map says it is known there; None = not stated."""


@dataclass(frozen=True, slots=True)
class Requirement:
    """One line of the acceptance table."""

    label: str
    value_m: float
    limit_m: float
    holds: bool


@dataclass(frozen=True, slots=True)
class ResidualStatistics:
    """Statistics of the residuals of one role."""

    role: Role
    points: int
    rmse_m: tuple[float, float, float]
    """East, north, up."""
    mean_2d_m: float
    mean_up_m: float
    """Of ``|dU|``."""
    max_2d_m: float
    max_up_m: float
    rmse_3d_m: float
    relative_m: float | None
    """Largest error of the distance between two of the points; None with one point."""
    requirements: tuple[Requirement, ...]


@dataclass(frozen=True, slots=True)
class ControlReport:
    """The residual table."""

    rows: tuple[Residual, ...]
    missing: tuple[str, ...]
    """Points not yet found in the map."""
    outdated: tuple[str, ...]
    """Points found in an earlier map only; they are not used for this one."""
    figures: tuple[ResidualStatistics, ...]
    """Statistics of check points, then of control points; a role without points is omitted."""
    judged_by: Role | None
    """Role that decides about acceptance; None = no point was measured."""
    passed: bool | None
    """Whether the deciding points are within all limits; None = no point was measured."""
    hint: str = ""
    """What the residuals have in common; empty = nothing."""


def residuals(
    points: Sequence[ControlPoint],
    measured: Mapping[str, Array],
    *,
    covariances: Mapping[str, Array] = MappingProxyType({}),
    outdated: Collection[str] = (),
    map_heights_m: tuple[float, float] | None = None,
) -> ControlReport:
    """Compute the residual table, control and check points separately.

    Args:
        points: Surveyed points.
        measured: Id -> position in the map, in the coordinates of the survey [m], (3,).
        covariances: Id -> covariance of the map there, east, north, up [m²], (3, 3).
        outdated: Ids of points found in an earlier map.
        map_heights_m: Lowest and highest height of the map in the survey's coordinates [m].
    """
    rows = tuple(
        _residual(p, measured[p.id], covariances.get(p.id)) for p in points if p.id in measured
    )
    figures = []
    for role in ("check", "control"):
        mine = [row for row in rows if row.role == role]
        if mine:
            figures.append(
                _figures(mine, [p for p in points if p.id in measured and p.role == role])
            )
    return ControlReport(
        rows=rows,
        missing=tuple(p.id for p in points if p.id not in measured and p.id not in outdated),
        outdated=tuple(p.id for p in points if p.id not in measured and p.id in outdated),
        figures=tuple(figures),
        judged_by=figures[0].role if figures else None,
        passed=all(one.holds for one in figures[0].requirements) if figures else None,
        hint=_common_height(rows) if rows else _beside_map(points, map_heights_m),
    )


def residual_csv(report: ControlReport, *, comment: str = "") -> str:
    """The residuals in meters, and after an empty line each limit with the measured value.

    Args:
        report: The table.
        comment: Text of the first line: project, map, frame.
    """
    out = io.StringIO()
    out.write(f"# recon4 control and check points {' '.join(comment.split())}".rstrip() + "\n")
    rows = csv.writer(out, lineterminator="\n")
    stated = ["sd_major_m", "sd_minor_m", "azimuth_deg", "sd_up_m"]
    rows.writerow(["id", "role", "dE_m", "dN_m", "dU_m", "d2D_m", "d3D_m", *stated])
    for row in report.rows:
        values = (row.east_m, row.north_m, row.up_m, row.d2_m, row.d3_m)
        values += astuple(row.stated) if row.stated else ()
        rows.writerow([safe_cell(row.id), row.role, *(f"{value:.4f}" for value in values)])
    for name in report.missing:
        rows.writerow([safe_cell(name), "not found in the map"])
    for name in report.outdated:
        rows.writerow([safe_cell(name), "found in an earlier map only"])
    for f in report.figures:
        rows.writerow(["RMSE", f.role, *(f"{v:.4f}" for v in f.rmse_m), "", f"{f.rmse_3d_m:.4f}"])
    if report.hint:
        out.write(f"# {report.hint}\n")
    rows.writerow([])
    rows.writerow(["limit", "role", "measured_m", "limit_m", "holds"])
    for f in report.figures:
        for one in f.requirements:
            holds = "yes" if one.holds else "NO"
            rows.writerow([one.label, f.role, f"{one.value_m:.4f}", f"{one.limit_m:.2f}", holds])
    return out.getvalue()


def safe_cell(text: str) -> str:
    """A cell that spreadsheets do not evaluate as a formula."""
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text


def _common_height(rows: Sequence[Residual]) -> str:
    """Whether all heights are off by the same, as between ellipsoid and sea level."""
    up_m = np.array([row.up_m for row in rows])
    usual_m = float(np.median(up_m))
    alike = float(np.abs(up_m - usual_m).max()) < _NEARLY_M
    low_m, high_m = GEOID_SEPARATION_M
    in_place = max(row.d2_m for row in rows) < _NEARLY_M
    if not (alike and in_place and low_m < abs(usual_m) < high_m):
        return ""
    points = f"All {len(rows)} points are" if len(rows) > 1 else "The point is"
    return (
        f"{points} {abs(usual_m):.2f} m too {'high' if usual_m > 0 else 'low'} in the map, and "
        f"horizontally in place. {_TWO_HEIGHTS}"
    )


def _beside_map(points: Sequence[ControlPoint], heights_m: tuple[float, float] | None) -> str:
    """Whether all points lie as far below or above the map as sea level and ellipsoid are apart."""
    if not points or heights_m is None:
        return ""
    z_m = [point.xyz_m[2] for point in points]
    below_m, above_m = heights_m[0] - max(z_m), min(z_m) - heights_m[1]
    low_m, high_m = GEOID_SEPARATION_M
    if not low_m < max(below_m, above_m) < high_m:
        return ""
    return (
        f"All {len(points)} points of the survey are {'below' if below_m > 0 else 'above'} the map "
        f"by {max(below_m, above_m):.0f} m and more: their heights are {min(z_m):.1f} to "
        f"{max(z_m):.1f} m, the map's {heights_m[0]:.1f} to {heights_m[1]:.1f} m. {_TWO_HEIGHTS}"
    )


def _residual(point: ControlPoint, found_m: Array, cov: Array | None) -> Residual:
    east, north, up = (float(d) for d in np.asarray(found_m, dtype=np.float64) - point.xyz_m)
    d2 = math.hypot(east, north)
    stated = None if cov is None else error_ellipse(cov)
    return Residual(point.id, point.role, east, north, up, d2, math.hypot(d2, up), stated)


def _figures(rows: list[Residual], points: list[ControlPoint]) -> ResidualStatistics:
    d = np.array([(row.east_m, row.north_m, row.up_m) for row in rows])
    flat, up = np.hypot(d[:, 0], d[:, 1]), np.abs(d[:, 2])
    relative = _relative(np.array([p.xyz_m for p in points]), d)
    rmse = np.sqrt((d**2).mean(axis=0))
    return ResidualStatistics(
        role=rows[0].role,
        points=len(rows),
        rmse_m=(float(rmse[0]), float(rmse[1]), float(rmse[2])),
        mean_2d_m=float(flat.mean()),
        mean_up_m=float(up.mean()),
        max_2d_m=float(flat.max()),
        max_up_m=float(up.max()),
        rmse_3d_m=float(np.sqrt((d**2).sum(axis=1).mean())),
        relative_m=finite_or_none(relative),
        requirements=_requirements(flat, up, relative),
    )


def _requirements(flat_m: Array, up_m: Array, relative_m: float) -> tuple[Requirement, ...]:
    """The limits of V §3.3, and the limit of distances if there are two points."""
    lines = [
        ("mean horizontal", float(flat_m.mean()), MEAN_HORIZONTAL_LIMIT_M),
        ("mean height", float(up_m.mean()), MEAN_VERTICAL_LIMIT_M),
        ("largest horizontal", float(flat_m.max()), MAX_HORIZONTAL_LIMIT_M),
        ("largest height", float(up_m.max()), MAX_VERTICAL_LIMIT_M),
    ]
    if math.isfinite(relative_m):
        lines.append(("distances between points", relative_m, RELATIVE_LIMIT_M))
    return tuple(Requirement(name, value, limit, value <= limit) for name, value, limit in lines)


def _relative(true_m: Array, d: Array) -> float:
    """Largest ``| |p_i - p_j| measured - surveyed |`` [m]; of at most 500 points."""
    true_m, d = true_m[:500], d[:500]
    if len(true_m) < 2:
        return float("nan")
    i, j = np.triu_indices(len(true_m), k=1)
    surveyed = np.linalg.norm(true_m[i] - true_m[j], axis=1)
    measured = np.linalg.norm((true_m + d)[i] - (true_m + d)[j], axis=1)
    return float(np.abs(measured - surveyed).max())
