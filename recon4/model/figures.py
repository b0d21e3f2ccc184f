"""Figures of the stages, one record per stage: their return values, kept in the manifests.

``summary.json`` repeats them for the stages of a run. The fields are the keys in both files; a
manifest of an earlier version may lack those that have a default.
"""

from __future__ import annotations

import msgspec

Point = tuple[float, float, float]


class Figures(msgspec.Struct, frozen=True, kw_only=True):
    """Figures of a stage; this one has none."""


class FrameFigures(Figures, frozen=True, kw_only=True):
    """The imported recording."""

    multiframes: int
    points: int
    rig: str
    """Name of the rig that was used."""
    imu: bool
    """Whether it has IMU samples."""
    gnss: bool
    """Whether it has positions."""
    outcome: str = "complete"
    """``complete``, or how far it could be read."""
    warnings: tuple[str, ...] = ()


class OdometryFigures(Figures, frozen=True, kw_only=True):
    """Odometry of all multiframes."""

    multiframes: int
    lost: int
    """Multiframes where tracking was lost."""
    imu: bool = False
    """Whether the IMU was used."""
    warnings: tuple[str, ...] = ()
    gnss: bool = False
    """Whether fixes were used."""


class GraphFigures(Figures, frozen=True, kw_only=True):
    """The pose graph before verification."""

    nodes: int
    edges: int
    """Registered pairs."""
    accepted: int
    """Edges in the graph."""


class VerificationFigures(Figures, frozen=True, kw_only=True, omit_defaults=True):
    """The verified graph; without any field in the modes that stop before verification."""

    edges: dict[str, int] | None = None
    """Edges by verdict."""
    chi2_before: float | None = None
    chi2_after: float | None = None


class ReviewFigures(Figures, frozen=True, kw_only=True):
    """The graph with the decisions of people."""

    edges: dict[str, int]
    """Edges by verdict."""
    decisions: int
    """Decisions in force."""
    conflicts: int
    """Accepted edges that do not fit the graph."""
    missing: int
    """Decisions without effect."""
    chi2_before: float | None
    chi2_after: float | None
    warnings: tuple[str, ...]


class RefineRound(msgspec.Struct, frozen=True, kw_only=True):
    """A round of the semi-rigid refinement."""

    mean_m: float
    """Mean distance of the matched segments from the planes [m], before the step."""
    match_ratio: float
    """Part of the segment ends that found a plane, 0..1."""
    largest_step_m: float
    """Largest shift of a multiframe in this round [m]."""


class RefineFigures(Figures, frozen=True, kw_only=True):
    """The semi-rigid refinement."""

    rounds: tuple[RefineRound, ...]


class LevelFigures(Figures, frozen=True, kw_only=True):
    """The leveled map and its place on earth."""

    leveled_by: str = msgspec.field(name="levelled_by")
    """``ins``, ``imu``, ``floor`` or ``none``."""
    tilt_deg: float
    """Tilt of the map before leveling [°]."""
    crs: str
    """Code of the map's CRS; empty = a local frame."""
    local: str
    """Why the map is in a local frame; empty = it is not."""
    edges_rejected: int = 0
    """Edges that contradict the positions."""


class MapFigures(Figures, frozen=True, kw_only=True):
    """The map."""

    points: int
    bounds_m: tuple[Point, Point]
    """Lowest and highest corner [m]."""
