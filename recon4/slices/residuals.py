"""Residuals at control and check points, and their statistics.

A residual has a figure only where it was measured: a point on a wall measures the wall's position,
not the height of the point. What was not measured is None and counts in no statistic.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.tuning_control import CONTROL_FIT
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts
from recon4.model.survey_covariance import covariance_matrix
from recon4.model.tuning import GEOID
from recon4.recording.tables.column_names import Role
from recon4.slices.control_limits import ControlLimits, control_texts
from recon4.slices.control_points import ControlPoint
from recon4.slices.control_verdict import (
    ControlVerdict,
    Requirement,
    UnusedPoints,
    control_verdict,
    requirements_of,
)
from recon4.slices.error_ellipses import ErrorEllipse, error_ellipse
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.tuning import HEIGHT_HINTS, RESIDUALS

ROLES: tuple[Role, Role] = ("check", "control")


@dataclass(frozen=True, slots=True, kw_only=True)
class Residual:
    """Residual of one point, map minus survey [m]; None = not measured, or says nothing."""

    id: str
    role: Role
    east_m: float | None
    north_m: float | None
    up_m: float | None
    d2_m: float | None
    """Horizontal length, of points measured in east and north."""
    d3_m: float | None
    """Length in space, of points measured in all directions."""
    directions: int
    """How many directions were measured, 1 to 3."""
    across_m: float | None
    """Residual in the measured directions: its length, or its value across the one surface."""
    stated: ErrorEllipse | None
    """How well the map says it is known there; None = not stated."""
    sigmas: float | None
    """``across_m`` in standard deviations of point and map together; None = not stated."""
    survey: ErrorEllipse | None
    """Of the point itself, if the survey states its covariance; None = that of all points."""
    outlier: bool
    """Whether ``sigmas`` exceeds `RESIDUALS.outlier_sigmas`."""

    @property
    def known_2d_m(self) -> float | None:
        """Horizontal length, or what is known to be the least of it [m]."""
        known = [abs(d) for d in (self.east_m, self.north_m) if d is not None]
        return self.d2_m if self.d2_m is not None else max(known, default=None)


@dataclass(frozen=True, slots=True)
class AxisStatistics:
    """Statistics of one component over the points that measured it."""

    axis: Literal["E", "N", "U"]
    points: int
    rmse_m: float | None
    mean_m: float | None
    """Signed mean, a common offset of the map."""


@dataclass(frozen=True, slots=True)
class ResidualStatistics:
    """Statistics of the residuals of one role. None = measured at no point."""

    role: Role
    points: int
    axes: tuple[AxisStatistics, AxisStatistics, AxisStatistics]
    """East, north, up."""
    mean_2d_m: float | None
    mean_up_m: float | None
    """Of ``|dU|``."""
    max_2d_m: float | None
    max_up_m: float | None
    rmse_3d_m: float | None
    relative_m: float | None
    """Largest error of the distance between two points that are measured in all directions."""
    requirements: tuple[Requirement, ...]


@dataclass(frozen=True, slots=True)
class ControlReport:
    """The residual table."""

    rows: tuple[Residual, ...]
    missing: tuple[str, ...]
    """Points not yet found in the map."""
    outdated: tuple[str, ...]
    """Points found in an earlier map, or by an earlier version that did not record what it
    measured; they are not used."""
    absent: tuple[str, ...]
    """Points picked where the map has none; they are not used."""
    figures: tuple[ResidualStatistics, ...]
    """Statistics of check points, then of control points; a role without points is omitted."""
    judged_by: Role | None
    """Role that decides about acceptance; None = no point was measured."""
    passed: bool | None
    """Whether the deciding points are within all limits; None = no verdict."""
    verdict: ControlVerdict
    limits: str
    """The limits of the job as one phrase."""
    hint: str = ""
    """What the residuals have in common; empty = nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlContext:
    """What is known beside the points and their positions."""

    covariances: Mapping[str, Array] = field(default_factory=dict)
    """Id -> covariance of the map there, east, north, up [m²], (3, 3)."""
    outdated: Collection[str] = ()
    """Ids of points found in an earlier map."""
    absent: Collection[str] = ()
    """Ids of points that were picked where the map has none."""
    map_bounds_m: Array | None = None
    """Lowest and highest corner of the map in the survey's coordinates [m], (2, 3); None = it has
    no points, or the survey is in coordinates that it does not have."""
    limits: ControlLimits = field(default_factory=ControlLimits)
    language: str = ENGLISH
    """Of the texts."""

    @property
    def say(self) -> Texts:
        """The texts in this language."""
        return control_texts(self.language)


def residuals(
    points: Sequence[ControlPoint],
    measured: Mapping[str, MeasuredPosition],
    context: ControlContext = ControlContext(),
) -> ControlReport:
    """Compute the residual table, control and check points separately.

    Args:
        points: Surveyed points.
        measured: Id -> position in the coordinates of the survey.
        context: Stated covariances, limits, heights of the map.
    """
    found = [one for one in points if one.id in measured and one.id not in context.absent]
    rows = tuple(
        _residual(
            p,
            measured[p.id],
            cov=context.covariances.get(p.id),
            survey_sd_m=context.limits.survey_sd_m,
        )
        for p in found
    )
    other = other_system(rows, points, context)
    if other is not None:
        rows, found = tuple(map(_without_figures, rows)), []
    figures = tuple(_figures(role, rows, found, context=context) for role in ROLES if found)
    figures = tuple(one for one in figures if one.points)
    missing = tuple(p.id for p in points if p.id not in measured and p.id not in context.outdated)
    outdated = tuple(p.id for p in points if p.id not in measured and p.id in context.outdated)
    absent = tuple(p.id for p in points if p.id in context.absent)
    judge = figures[0] if figures else None
    return ControlReport(
        rows=rows,
        missing=missing,
        outdated=outdated,
        absent=absent,
        figures=figures,
        judged_by=judge.role if judge else None,
        passed=_all_hold(judge.requirements) if judge else None,
        verdict=other
        or control_verdict(
            judge.role if judge else None,
            judge.requirements if judge else (),
            rows=rows,
            unused=UnusedPoints(len(missing) + len(outdated), absent),
            say=context.say,
        ),
        limits=context.limits.text(context.say),
        hint="" if other is not None else _hint(rows, points, context),
    )


def _without_figures(row: Residual) -> Residual:
    """A point that was measured, but whose residual says nothing."""
    return replace(
        row,
        east_m=None,
        north_m=None,
        up_m=None,
        d2_m=None,
        d3_m=None,
        across_m=None,
        sigmas=None,
        outlier=False,
    )


def _residual(
    point: ControlPoint, found: MeasuredPosition, *, cov: Array | None, survey_sd_m: float
) -> Residual:
    d = found.offset(np.array(point.xyz_m))
    east, north, up = (float(x) if known else None for x, known in zip(d, found.axes, strict=True))
    directions = len(found.along)
    d2 = None if east is None or north is None else math.hypot(east, north)
    d3 = float(np.linalg.norm(d)) if directions == 3 else None
    across = float(found.along[0] @ d) if directions == 1 else float(np.linalg.norm(d))
    own = point.covariance_m2 and covariance_matrix(point.covariance_m2)
    survey = survey_sd_m**2 * np.eye(3) if own is None else own
    sigmas = None if cov is None else _sigmas(found.along, d, cov + survey)
    return Residual(
        id=point.id,
        role=point.role,
        east_m=east,
        north_m=north,
        up_m=up,
        d2_m=d2,
        d3_m=d3,
        directions=directions,
        across_m=across,
        stated=None if cov is None else error_ellipse(cov),
        sigmas=sigmas,
        survey=None if own is None else error_ellipse(own),
        outlier=sigmas is not None and sigmas > RESIDUALS.outlier_sigmas[directions - 1],
    )


def _sigmas(along: Array, d: Array, cov: Array) -> float:
    """Length of a residual in units of its standard deviation (Mahalanobis)."""
    offset = along @ d
    return float(np.sqrt(offset @ np.linalg.solve(along @ cov @ along.T, offset)))


def _figures(
    role: Role, rows: Sequence[Residual], points: Sequence[ControlPoint], *, context: ControlContext
) -> ResidualStatistics:
    mine = [(row, point) for row, point in zip(rows, points, strict=True) if row.role == role]
    own = [row for row, _ in mine]
    flat = _known(row.d2_m for row in own)
    up = [abs(d) for d in _known(row.up_m for row in own)]
    space = _known(row.d3_m for row in own)
    relative = _relative([(row, point) for row, point in mine if row.d3_m is not None])
    return ResidualStatistics(
        role=role,
        points=len(own),
        axes=(
            _axis("E", [row.east_m for row in own]),
            _axis("N", [row.north_m for row in own]),
            _axis("U", [row.up_m for row in own]),
        ),
        mean_2d_m=_mean(flat),
        mean_up_m=_mean(up),
        max_2d_m=max(flat, default=None),
        max_up_m=max(up, default=None),
        rmse_3d_m=_rms(space),
        relative_m=relative,
        requirements=requirements_of(own, (relative, len(space)), context.limits, say=context.say),
    )


def _all_hold(lines: Iterable[Requirement]) -> bool | None:
    """Whether all limits hold: False if one does not, None if one has no verdict."""
    holds = [line.holds for line in lines]
    if False in holds:
        return False
    return None if None in holds or not holds else True


def _axis(axis: Literal["E", "N", "U"], residuals_m: Iterable[float | None]) -> AxisStatistics:
    known = _known(residuals_m)
    return AxisStatistics(axis, len(known), _rms(known), _mean(known))


def _known(values: Iterable[float | None]) -> list[float]:
    return [value for value in values if value is not None]


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _rms(values: Sequence[float]) -> float | None:
    return float(np.sqrt(np.mean(np.square(values)))) if values else None


def _relative(full: Sequence[tuple[Residual, ControlPoint]]) -> float | None:
    """Largest ``| |p_i - p_j| measured - surveyed |`` [m]; of at most 500 points."""
    if len(full) < 2:
        return None
    surveyed = np.array([point.xyz_m for _, point in full[:500]])
    d = np.array([(row.east_m, row.north_m, row.up_m) for row, _ in full[:500]], dtype=np.float64)
    i, j = np.triu_indices(len(surveyed), k=1)
    true_m = np.linalg.norm(surveyed[i] - surveyed[j], axis=1)
    found_m = np.linalg.norm((surveyed + d)[i] - (surveyed + d)[j], axis=1)
    return float(np.abs(found_m - true_m).max())


def other_system(
    rows: Sequence[Residual], points: Sequence[ControlPoint], context: ControlContext
) -> ControlVerdict | None:
    """Says of a survey with coordinates of its own how the map gets them; None = it has none.

    The usual case of a grid of the site: nothing is wrong with it. Measured points say it by being
    farther from the map than from each other; before one is measured, the extent of the map does.
    """
    if len(points) < 2:
        return None
    placing = {one.id for one in points if one.role == "control"}
    values = {
        "measured": sum(row.id in placing for row in rows),
        "control": len(placing),
        "needed": CONTROL_FIT.least_points,
    }
    part = "none"
    if rows:
        off_m = min(_known(row.known_2d_m for row in rows), default=0.0)
        apart_m = float(np.hypot(*np.ptp([point.xyz_m[:2] for point in points], axis=0)))
        if off_m <= max(apart_m, HEIGHT_HINTS.nearly_m):
            return None
        part = "some" if values["measured"] < values["needed"] else "enough"
    elif lies_in(points, context.map_bounds_m):
        return None
    if len(placing) < CONTROL_FIT.least_points:
        part = "roles"
    return ControlVerdict("note", context.say.part("other-system", part, values))


def lies_in(points: Sequence[ControlPoint], bounds_m: Array | None) -> bool:
    """Whether the extents of survey and map overlap horizontally; also if the map has none."""
    if bounds_m is None or not points:
        return True
    xy_m = np.array([point.xyz_m[:2] for point in points])
    low, high = bounds_m[:, :2]
    return bool((xy_m.max(axis=0) >= low).all() and (xy_m.min(axis=0) <= high).all())


def _hint(rows: Sequence[Residual], points: Sequence[ControlPoint], context: ControlContext) -> str:
    if not rows:
        return beside_map(points, context.map_bounds_m, context.say)
    horizontal = _known(row.known_2d_m for row in rows)
    return common_height(_known(row.up_m for row in rows), horizontal, context.say)


def common_height(up_m: Sequence[float], horizontal_m: Sequence[float], say: Texts) -> str:
    """Whether all measured heights are off by the same, and the points in place horizontally."""
    if not up_m:
        return ""
    usual_m = float(np.median(up_m))
    alike = float(np.abs(np.array(up_m) - usual_m).max()) < HEIGHT_HINTS.nearly_m
    low_m, high_m = GEOID.least_m, GEOID.most_m
    in_place = max(horizontal_m, default=0.0) < HEIGHT_HINTS.nearly_m
    if not (alike and in_place and low_m < abs(usual_m) < high_m):
        return ""
    part = f"{'all' if len(up_m) > 1 else 'one'}-{'high' if usual_m > 0 else 'low'}"
    return say.part("height-hint", part, {"points": len(up_m), "off": abs(usual_m)})


def beside_map(points: Sequence[ControlPoint], bounds_m: Array | None, say: Texts) -> str:
    """Whether all points lie as far below or above the map as sea level and ellipsoid are apart."""
    if not points or bounds_m is None:
        return ""
    heights_m = bounds_m[:, 2].tolist()
    z_m = [point.xyz_m[2] for point in points]
    below_m, above_m = heights_m[0] - max(z_m), min(z_m) - heights_m[1]
    low_m, high_m = GEOID.least_m, GEOID.most_m
    if not low_m < max(below_m, above_m) < high_m:
        return ""
    values = {
        "points": len(points),
        "off": max(below_m, above_m),
        "low": min(z_m),
        "high": max(z_m),
        "map_low": heights_m[0],
        "map_high": heights_m[1],
    }
    return say.part("height-hint", "below" if below_m > 0 else "above", values)
