"""Residuals compared with the limits: one line per limit, and the verdict in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from recon4.locales.texts import Texts
from recon4.recording.tables.column_names import Role
from recon4.slices.control_limits import ControlLimits
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
class UnusedPoints:
    """Surveyed points that are in no figure."""

    unmeasured: int
    absent: tuple[str, ...]
    """Picked where the map has no points."""

    def text(self, say: Texts) -> str:
        """Both in words; empty = all points are used."""
        left = {"left": self.unmeasured}
        absent = {"names": ", ".join(self.absent[: CONTROL_VERDICT.named])}
        absent["more"] = "" if len(self.absent) <= CONTROL_VERDICT.named else " …"
        return (say.part("control-verdict", "absent", absent) if self.absent else "") + (
            say.part("control-verdict", "left", left) if self.unmeasured else ""
        )


@dataclass(frozen=True, slots=True)
class ControlVerdict:
    """The verdict as one line: the same on the page, on the sheet and in files."""

    level: Level
    text: str
    """Begins with its sign ✓ ⚠ ✕ –."""


def requirements_of(
    rows: Sequence[Residual],
    distances: tuple[float | None, int],
    limits: ControlLimits,
    *,
    say: Texts,
) -> tuple[Requirement, ...]:
    """The limits of a job with what the points of one role measured.

    Args:
        rows: The residuals.
        distances: Largest error of a distance [m], and how many points are measured fully.
        limits: Of the job.
        say: `control_texts` of a language.
    """
    up = [abs(row.up_m) for row in rows if row.up_m is not None]
    lines: list[Line] = [
        *_horizontal(rows, limits),
        ("mean-height", "height", _mean(up), len(up), limits.mean_height_m),
        ("largest-height", "height", max(up, default=None), len(up), limits.max_height_m),
        ("distances", "distances", *distances, limits.distances_m),
    ]
    return tuple(_line(line, say) for line in lines if line[-1] is not None)


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
            ("mean-horizontal", "horizontal", _mean(flat), len(flat), limits.mean_horizontal_m),
            ("largest-horizontal", "horizontal", largest, len(flat), limits.max_horizontal_m),
        ]
    lines: list[Line] = []
    parts: tuple[tuple[Component, list[float]], ...] = (("east", east), ("north", north))
    for name, part in parts:
        mean_limit_m = _shared(limits.mean_horizontal_m)
        max_limit_m = _shared(limits.max_horizontal_m)
        lines.append((f"mean-{name}", name, _mean(part), len(part), mean_limit_m))
        lines.append((f"largest-{name}", name, max(part, default=None), len(part), max_limit_m))
    return lines


def _line(line: Line, say: Texts) -> Requirement:
    name, component, value_m, points, limit_m = line
    assert limit_m is not None
    over = value_m is not None and value_m > limit_m
    holds: bool | None = not over
    result = "exceeded" if over else "holds"
    if value_m is None:
        holds, result = None, "unmeasured"
    elif points < CONTROL_LIMITS.least_points:
        holds, result = None, "few-above" if over else "few"
    values = {"points": points, "needed": CONTROL_LIMITS.least_points}
    text = say.part("limit-result", result, values)
    label = say.part("limit-label", name, {})
    return Requirement(label, component, points, value_m, limit_m, holds, text)


def control_verdict(
    role: Role | None,
    lines: Sequence[Requirement],
    *,
    rows: Sequence[Residual],
    unused: UnusedPoints,
    say: Texts,
) -> ControlVerdict:
    """The verdict of the deciding points.

    Args:
        role: Of these points; None = no point was measured.
        lines: Their limits.
        rows: Residuals of all points, of both roles.
        unused: The others; a point that is not in the map is no good measurement.
        say: `control_texts` of a language.
    """
    left = unused.text(say)
    if role is None:
        return ControlVerdict("note", say.part("control-verdict", "none", {}) + left)
    holds = [line.holds for line in lines]
    level: Level = "good"
    name = "within"
    if False in holds:
        level, name = "bad", "outside"
    elif None in holds or not holds:
        level, name = "note", "unsure"
    at = say.part("control-verdict", f"role-{role}", {})
    words = say.part("control-verdict", name, {"role": at})
    if level == "good" and role == "control":
        level, words = "note", say.part("control-verdict", "unchecked", {"words": words})
    if level != "bad" and (unused.absent or any(row.outlier for row in rows)):
        level = "warning"
    values = {
        "sign": {"good": "✓", "warning": "⚠", "bad": "✕", "note": "–"}[level],
        "words": words,
        "parts": "; ".join(_components(lines, say)) or say.part("control-verdict", "no-limit", {}),
        "outliers": _outliers(rows, say),
        "left": left,
    }
    return ControlVerdict(level, say.part("control-verdict", "whole", values))


def _components(lines: Sequence[Requirement], say: Texts) -> list[str]:
    """Each component with its sign, its points and what is missing or exceeded."""
    out = []
    for name in dict.fromkeys(line.component for line in lines):
        own = [line for line in lines if line.component == name]
        holds = [line.holds for line in own]
        points = min(line.points for line in own)
        count = say.part(
            "control-verdict", "points" if points else "unmeasured", {"points": points}
        )
        if 0 < points < CONTROL_LIMITS.least_points:
            needed = {"needed": CONTROL_LIMITS.least_points}
            count += say.part("control-verdict", "needed", needed)
        values = {
            "name": say.part("limit-component", name, {}),
            "sign": _SIGNS[False if False in holds else (None if None in holds else True)],
            "count": count,
            "over": "".join(_over(line, say) for line in own),
        }
        out.append(say.part("control-verdict", "component", values))
    return out


def _over(line: Requirement, say: Texts) -> str:
    """What exceeds a limit; empty = nothing."""
    if line.value_m is None or line.value_m <= line.limit_m:
        return ""
    value, limit = 100.0 * line.value_m, 100.0 * line.limit_m
    return say.part(
        "control-verdict", "over", {"label": line.label, "value": value, "limit": limit}
    )


def _outliers(rows: Sequence[Residual], say: Texts) -> str:
    """Points whose residual their σ does not explain."""
    tested = sum(row.sigmas is not None for row in rows)
    found = [(row.id, row.across_m or 0.0, row.sigmas or 0.0) for row in rows if row.outlier]
    if not tested:
        return say.part("control-outliers", "untested", {})
    if not found:
        return ""
    named = [
        say.part("control-outliers", "one", {"name": name, "off": 100.0 * abs(d), "sigmas": sigmas})
        for name, d, sigmas in found[: CONTROL_VERDICT.named]
    ]
    left = len(found) - CONTROL_VERDICT.named
    most = tested > 2 and 2 * len(found) > tested
    values = {
        "named": ", ".join(named),
        "more": say.part("control-outliers", "more", {"count": left}) if left > 0 else "",
        "advice": say.part("control-outliers", "most" if most else "look", {}),
    }
    return say.part("control-outliers", "far", values)


def _shared(limit_m: float | None) -> float | None:
    return None if limit_m is None else limit_m / math.sqrt(2.0)


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None
