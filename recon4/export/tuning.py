"""Tuning of exports."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class FindingExportTuning:
    """Findings as GeoJSON."""

    max_line_points: int = 500
    """A longer stretch is thinned out."""


FINDING_EXPORT = FindingExportTuning()


@dataclass(frozen=True, slots=True, kw_only=True)
class PointExportTuning:
    """Points as files."""

    block: int = 1_000_000
    """Points in memory at once."""


POINT_EXPORT = PointExportTuning()
