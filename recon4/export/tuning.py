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

    block: int = 1 << 15
    """Points that are made ready at once: with more of them they leave the processor's cache
    between one column and the next, which takes twice as long."""


POINT_EXPORT = PointExportTuning()


@dataclass(frozen=True, slots=True, kw_only=True)
class OctreeTuning:
    """The octree of COPC."""

    step_m: float = 0.0001
    """Resolution of the coordinates: finer than anything a map holds."""
    side_bits: int = 7
    """A node samples what is below it in 2^7 cells along each edge: COPC's spacing."""
    bucket_bits: int = 17
    """Points are sorted by cubes of 2^17 steps (13 m) in files first."""
    points_in_memory: int = 2_000_000
    """A file with more points is split by the nodes below it: 100 MB and some copies."""
    points_of_leaf: int = 50_000
    """A node with fewer points has no nodes below it: one request of a viewer."""


OCTREE = OctreeTuning()


@dataclass(frozen=True, slots=True, kw_only=True)
class LazTuning:
    """A LAZ file, and steps of its numbers: coarser ones compress better."""

    scale_m: float = 0.001
    """Of the coordinates."""
    together: int = 500_000
    """Points that are compressed at once, 50 000 a thread."""
    normalized_step: float = 1.0 / 16.0
    """Of normalized intensities: finer than the raw step."""
    deviation_step_m: float = 0.0001
    """Of deviations of positions, which are whole numbers in the file."""


LAZ = LazTuning()
