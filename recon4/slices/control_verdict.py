"""Residuals compared with the limits: one line per limit, and the verdict in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from recon4.slices.control_limits import ControlLimits
from recon4.slices.control_points import Role
from recon4.slices.tuning import CONTROL_VERDICT
from recon4.slices.tuning_files import CONTROL_LIMITS

if TYPE_CHECKING:
    from recon4.slices.residuals import Residual

Component = Literal["horizontal", "east", "north", "height", "distances"]
Level = Literal["good", "warning", "bad", "note"]
_SIGNS = {True: "✓", False: "✕", None: "–"}


@dataclass(frozen=True, slots=True)
class Requirement:
    """One line of the acceptance table."""

    label: str
    component: Component
    points: int
    """Points that measured it."""
    value_m: float | None
    """None = measured at no point."""
    limit_m: float
    holds: bool | None
    """None = no verdict: fewer than `CONTROL_LIMITS.least_points` points."""
    text: str
    """The result in words, with its sign."""


@dataclass(frozen=True, slots=True)
class ControlVerdict:
    """The verdict as one line: the same on the page, on the sheet and in files."""

    level: Level
    text: str
    """Begins with its sign ✓ ⚠ ✕ –."""


def requirements_of(
    rows: Sequence[Residual], distances: tuple[float | None, int], limits: ControlLimits
) -> tuple[Requirement, ...]:
    """The limits of a job with what the points of one role measured.

    Args:
        rows: The residuals.
        distances: Largest error of a distance [m], and how many points are measured fully.
        limits: Of the job.
    """
    up = [abs(row.up_m) for row in rows if row.up_m is not None]
    lines: list[Line] = [
        *_horizontal(rows, limits),
        ("mean height", "height", _mean(up), len(up), limits.mean_height_m),
        ("largest height", "height", max(up, default=None), len(up), limits.max_height_m),
        ("distances between points", "distances", *distances, limits.distances_m),
    ]
    return tuple(_line(line) for line in lines if line[-1] is not None)


Line = tuple[str, Component, float | None, int, float | None]


def _horizontal(rows: Sequence[Residual], limits: ControlLimits) -> list[Line]:
    """Limits of points measured in east and north; without three of them, of either alone.

    One component may be the limit divided by √2: two such components together are within it.
    """
    flat = [row.d2_m for row in rows if row.d2_m is not None]
    east = [abs(row.east_m) for row in rows if row.east_m is not None]
    north = [abs(row.north_m) for row in rows if row.north_m is not None]
    if (
        len(flat) >= CONTROL_LIMITS.least_points
        or max(len(east), len(north)) < CONTROL_LIMITS.least_points
    ):
        # A point that measured one component only may prove an excess, but never a limit kept.
        most_m = math.inf if limits.max_horizontal_m is None else limits.max_horizontal_m
        over = [d for d in (row.known_2d_m for row in rows) if d is not None and d > most_m]
        largest = max([*flat, *over], default=None)
        return [
            ("mean horizontal", "horizontal", _mean(flat), len(flat), limits.mean_horizontal_m),
            ("largest horizontal", "horizontal", largest, len(flat), limits.max_horizontal_m),
        ]
    lines: list[Line] = []
    parts: tuple[tuple[Component, list[float]], ...] = (("east", east), ("north", north))
    for name, part in parts:
        mean_limit_m = _shared(limits.mean_horizontal_m)
        max_limit_m = _shared(limits.max_horizontal_m)
        lines.append((f"mean {name}", name, _mean(part), len(part), mean_limit_m))
        lines.append((f"largest {name}", name, max(part, default=None), len(part), max_limit_m))
    return lines


def _line(line: Line) -> Requirement:
    label, component, value_m, points, limit_m = line
    assert limit_m is not None
    over = value_m is not None and value_m > limit_m
    holds: bool | None = not over
    text = "✕ exceeded" if over else "✓ holds"
    if value_m is None:
        holds, text = None, "– not measured"
    elif points < CONTROL_LIMITS.least_points:
        above = ", above the limit" if over else ""
        holds, text = None, f"– {points} of {CONTROL_LIMITS.least_points} points needed{above}"
    return Requirement(label, component, points, value_m, limit_m, holds, text)


def control_verdict(
    role: Role | None,
    lines: Sequence[Requirement],
    *,
    outliers: Sequence[tuple[str, float, float]],
    tested: int,
    left: int,
) -> ControlVerdict:
    """The verdict of the deciding points.

    Args:
        role: Of these points; None = no point was measured.
        lines: Their limits.
        outliers: Id, residual [m] and σ of points far beyond their σ, of both roles.
        tested: How many points have a stated σ.
        left: Points that were not measured in this map.
    """
    more = f" {left} more not measured." if left else ""
    if role is None:
        return ControlVerdict("note", f"– No verdict: no point is measured in this map.{more}")
    holds = [line.holds for line in lines]
    level: Level = "bad" if False in holds else "good"
    words = f"Outside the limits at the {role} points" if level == "bad" else ""
    if not words and (None in holds or not holds):
        level, words = "note", f"No verdict at the {role} points"
    words = words or f"Within the limits at the {role} points"
    if level == "good" and role == "control":
        level, words = "note", f"{words}, but no independent point was checked"
    if level != "bad" and outliers:
        level = "warning"
    sign = {"good": "✓", "warning": "⚠", "bad": "✕", "note": "–"}[level]
    parts = "; ".join(_components(lines)) or "no limit is required"
    return ControlVerdict(level, f"{sign} {words}: {parts}.{_outliers(outliers, tested)}{more}")


def _components(lines: Sequence[Requirement]) -> list[str]:
    """Each component with its sign, its points and what is missing or exceeded."""
    out = []
    for name in dict.fromkeys(line.component for line in lines):
        own = [line for line in lines if line.component == name]
        holds = [line.holds for line in own]
        sign = _SIGNS[False if False in holds else (None if None in holds else True)]
        points = min(line.points for line in own)
        count = "not measured" if not points else f"{points} point{'s' if points > 1 else ''}"
        if 0 < points < CONTROL_LIMITS.least_points:
            count += f", {CONTROL_LIMITS.least_points} needed"
        over = [line for line in own if line.value_m is not None and line.value_m > line.limit_m]
        said = "".join(
            f", {line.label} {_cm(line.value_m or 0.0)} of {_cm(line.limit_m)} cm" for line in over
        )
        out.append(f"{name} {sign} ({count}{said})")
    return out


def _outliers(found: Sequence[tuple[str, float, float]], tested: int) -> str:
    """Points whose residual their σ does not explain."""
    if not tested:
        return " Outliers are not tested: the map states no σ."
    if not found:
        return ""
    named = [
        f"{name} ({_cm(abs(d))} cm, {sigmas:.0f} σ)"
        for name, d, sigmas in found[: CONTROL_VERDICT.named]
    ]
    more = (
        f" and {len(found) - CONTROL_VERDICT.named} more"
        if len(found) > CONTROL_VERDICT.named
        else ""
    )
    said = f" ⚠ Far beyond the stated σ: {', '.join(named)}{more}."
    if tested > 2 and 2 * len(found) > tested:
        return f"{said} These are most points: map and survey differ by more than the map states."
    return f"{said} Look whether the right place was measured."


def _shared(limit_m: float | None) -> float | None:
    return None if limit_m is None else limit_m / math.sqrt(2.0)


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _cm(length_m: float) -> str:
    return f"{100.0 * length_m:.1f}"
