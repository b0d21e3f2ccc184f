"""Compares a recipe with the first points that it is for: a wrong one is refused, never mapped.

Found are columns that are not there, units by what they make of ranges, angles and the time a cloud
takes, columns that are exchanged by the rings, which are cones about z, and mirrored points by the
turn of the sensor.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError, CorruptFile
from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import Array
from recon4.locales.coded import at, text_of
from recon4.model.finding_kinds import FindingKind
from recon4.model.point_recipes import ANGLES, LENGTHS, TIMES, PointRecipe, Units
from recon4.recording.clouds.point_fields import NS_TIME
from recon4.recording.recipes.apply import Column, Columns, as_points, chosen_list
from recon4.recording.report import ImportReport
from recon4.recording.tuning import RECIPES

Raw = Mapping[str, Sequence[Column]]
"""Role -> its columns as they were sent."""


@dataclass(frozen=True, slots=True)
class RecipeSample:
    """The first messages or files of points with a recipe."""

    name: str
    """Topic or file, for messages."""
    lists: Sequence[Mapping[str, Columns]]
    """Of each, as for `as_points`."""
    period_s: float
    """Usual time from one to the next [s]; NaN = not known."""
    frame: str = ""
    """Of its points; empty = not known."""

    @property
    def largest(self) -> Mapping[str, Columns]:
        """The one with the most points."""
        return max(self.lists, key=_size, default={})


def require_fitting(recipe: PointRecipe, sample: RecipeSample, report: ImportReport) -> None:
    """Refuse a recipe that the points contradict; say what is suspicious.

    Raises:
        ConfigError: Names the role, what was expected and what the points have.
    """
    largest = sample.largest
    if not _size(largest):
        return
    where = f"fields of {sample.name}"
    try:
        points = as_points(recipe, largest)
        chosen = chosen_list(recipe.columns, largest)
    except CorruptFile as error:
        raise ConfigError(at(where, text_of(error))) from error
    raw = {
        role: [chosen.column(term.column) for term in terms] for role, terms in recipe.terms.items()
    }
    for texts in (_angles(recipe, raw), _lengths(recipe, points), _rings(recipe, points)):
        if texts:
            raise ConfigError(at(where, texts))
    if text := _times(recipe, points, raw, period_s=sample.period_s):
        raise ConfigError(at(where, text))
    if _is_mirrored(points):
        report.warn(FindingKind.POINTS_TURN_LEFT, name=sample.name)


def _size(lists: Mapping[str, Columns]) -> int:
    return max((len(c) for one in lists.values() for c in one.values()), default=0)


def _said(recipe: PointRecipe, role: str) -> str:
    return f"{role} = {dict(recipe.texts)[role]!r}"


def _lengths(recipe: PointRecipe, points: Columns) -> str:
    """What is wrong with the coordinates; empty = nothing."""
    p = _places(points)
    role = "x" if "x" in recipe.terms else "range"
    if not len(p):
        return f"{_said(recipe, role)}: no point has a finite place apart from the origin"
    usual_m = float(np.median(np.linalg.norm(p, axis=1)))
    if RECIPES.nearest_m <= usual_m <= RECIPES.farthest_m:
        return ""
    fits = _fitting(LENGTHS, usual_m / (recipe.terms[role][0].unit or 1.0), RECIPES.nearest_m)
    return (
        f"{_said(recipe, role)}: half of the points are farther than {usual_m:.3g} m, expected "
        f"{RECIPES.nearest_m:g} to {RECIPES.farthest_m:g} m{fits}"
    )


def _fitting(units: Units, usual: float, least: float) -> str:
    """The units in which points are farther away than a distance."""
    by_size = sorted(units.items(), key=lambda one: -one[1])
    found = [name for name, unit in by_size if least <= usual * unit <= RECIPES.farthest_m]
    return f"; in {' or '.join(found)} they would be" if found else ""


def _angles(recipe: PointRecipe, raw: Raw) -> str:
    """What is wrong with angles; empty = nothing."""
    for role in ("azimuth", "elevation", "zenith"):
        if role not in raw:
            continue
        unit = recipe.terms[role][0].unit or 1.0
        values = raw[role][0].astype(np.float64)
        values = values[np.isfinite(values)]
        if not len(values):
            return f"{_said(recipe, role)}: no finite number"
        low, high = np.percentile(values, [1, 99]) * unit
        widest = {"azimuth": 2.0 * np.pi, "elevation": np.pi, "zenith": np.pi}[role]
        below = {"azimuth": -2.0 * np.pi, "elevation": -np.pi / 2.0, "zenith": 0.0}[role]
        tolerance = RECIPES.angle_tolerance_rad
        outside = high - low > widest + tolerance or low < below - tolerance
        outside |= (
            high > below + 2.0 * widest if role == "azimuth" else high > below + widest + tolerance
        )
        span = float(np.ptp(values))
        turn_in_rad = unit < 1.0 and abs(span - 2.0 * np.pi) < tolerance and role == "azimuth"
        if outside or turn_in_rad:
            better = "rad" if turn_in_rad else "deg"
            fits = f"; in {better} it would be a turn" if span * ANGLES[better] < 6.4 else ""
            return (
                f"{_said(recipe, role)}: angles from {np.rad2deg(low):.4g}° to "
                f"{np.rad2deg(high):.4g}°{fits}"
            )
    return ""


def _times(recipe: PointRecipe, points: Columns, raw: Raw, *, period_s: float) -> str:
    """What is wrong with the times; empty = nothing."""
    if "time" not in recipe.terms or not period_s > 0.0:
        return ""
    said = _said(recipe, "time")
    values = points[NS_TIME if recipe.time_has_unit else "time"]
    span = float(np.ptp(np.percentile(values[np.isfinite(values)].astype(np.float64), [2, 98])))
    if not span > 0.0:
        return f"{said}: all points of a cloud have one time"
    if not recipe.time_has_unit:
        return "" if _units_of_turn(span, period_s) else f"{said}: {_no_time(span, period_s)}"
    terms = zip(raw["time"], recipe.terms["time"], strict=True)
    resolution = min(_resolution_ns(column, term.unit) for column, term in terms)
    if resolution * 1e-9 > RECIPES.coarsest * period_s:
        return f"{said}: its steps of {resolution * 1e-6:.3g} ms are too coarse"
    low, high = RECIPES.cloud_periods
    if low * period_s <= span * 1e-9 <= high * period_s:
        return ""
    units = _units_of_turn(span / recipe.terms["time"][0].unit, period_s)
    fits = f"; in {units[0]} they would" if units else ""
    return (
        f"{said}: the times of a cloud spread over {span * 1e-9:.4g} s, expected about "
        f"{period_s:.4g} s, as from cloud to cloud{fits}"
    )


def _no_time(span: float, period_s: float) -> str:
    return (
        f"from first to last point {span:g}: in no unit of {', '.join(TIMES)} about "
        f"{period_s:.4g} s, as from cloud to cloud"
    )


def _units_of_turn(span: float, period_s: float) -> list[str]:
    """Units in which the times of a cloud take as long as from cloud to cloud."""
    low, high = RECIPES.cloud_periods
    return [n for n, unit in TIMES.items() if low <= span * unit * 1e-9 / period_s <= high]


def _resolution_ns(values: Column, unit: float) -> float:
    """Step from a time to the next one that its type has [ns]."""
    if values.dtype.kind != "f":
        return unit
    return float(np.spacing(np.abs(values[np.isfinite(values)]).max(initial=0.0))) * unit


def _rings(recipe: PointRecipe, points: Columns) -> str:
    """What is wrong with rings, which are cones about z; empty = nothing."""
    if "ring" not in points:
        return ""
    rings = points["ring"]
    said = _said(recipe, "ring")
    whole = np.isfinite(rings) & (rings == np.rint(rings)) & (rings >= 0) & (rings < 256)
    if np.mean(whole) < 0.5:
        return f"{said}: expected whole numbers from 0 to 255, got {rings[:3].tolist()}"
    axes = {axis: _spread_rad(points, order) for axis, order in _ORDERS.items()}
    if axes["z"] < RECIPES.cone_rad or not np.isfinite(axes["z"]):
        return ""
    best = min(axes, key=lambda axis: axes[axis])
    if axes[best] < RECIPES.cone_rad:
        return (
            f"{said}: the rings are cones about the column of {best}, expected about z: {best} and "
            "z are exchanged"
        )
    return ""


_ORDERS = {"z": "xyz", "y": "xzy", "x": "zyx"}
"""Axis of the cones -> the columns in the order in which it is the last one."""


def _spread_rad(points: Columns, order: str) -> float:
    """Median spread of the elevations of a ring about the last axis [rad]; NaN = one ring only."""
    p = np.column_stack([points[axis] for axis in order]).astype(np.float64)
    sound = np.isfinite(p).all(axis=1) & p.any(axis=1)
    p, rings = p[sound], points["ring"][sound]
    elevation = np.arctan2(p[:, 2], np.hypot(p[:, 0], p[:, 1]))
    parts = [elevation[rings == ring] for ring in distinct(rings)]
    if len(parts) < 2:
        return float("nan")
    return float(np.median([np.median(np.abs(one - np.median(one))) for one in parts]))


def _is_mirrored(points: Columns) -> bool:
    """Whether points with rings and times turn to the left, seen from above."""
    key = NS_TIME if NS_TIME in points else "time"
    if "ring" not in points or key not in points:
        return False
    p = np.column_stack([points["x"], points["y"]]).astype(np.float64)
    sound = np.isfinite(p).all(axis=1) & p.any(axis=1) & np.isfinite(points[key])
    order = np.argsort(points[key][sound], kind="stable")
    azimuth = np.arctan2(p[sound, 1], p[sound, 0])[order]
    ring = points["ring"][sound][order]
    turns = [_turn(azimuth[ring == one]) for one in distinct(ring)]
    return len(turns) > 1 and float(np.median(turns)) > RECIPES.turn_rad


def _turn(azimuth: Array) -> float:
    """How far the points of a ring turn to the left, one after the other [rad]."""
    steps = np.diff(np.unwrap(azimuth))
    return float(steps.sum()) if len(steps) and np.mean(steps > 0.0) > 0.9 else 0.0


def _places(points: Columns) -> Array:
    p = np.column_stack([points[axis] for axis in "xyz"]).astype(np.float64)
    return p[np.isfinite(p).all(axis=1) & p.any(axis=1)]
