"""Figures of the stages, one record per stage: their return values, kept in the manifests.

``summary.json`` repeats them for the stages of a run. The fields are the keys in both files; a
manifest of an earlier version may lack those that have a default.
"""

from __future__ import annotations

from typing import Literal

import msgspec

from recon4.model.finding import Value

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
    conflict_pairs: tuple[str, ...] = ()
    """Names of the first of each kind, ``3-17``."""
    missing_pairs: tuple[str, ...] = ()
    changed: int = 0
    """Decisions about pairs whose measurement has changed."""
    changed_pairs: tuple[str, ...] = ()
    chi2_before: float | None
    chi2_after: float | None


class RefineRound(msgspec.Struct, frozen=True, kw_only=True):
    """A round of the semi-rigid refinement."""

    mean_m: float
    """Mean distance of the matched segments from the planes [m], before the step."""
    match_ratio: float
    """Part of the segment ends that found a plane, 0..1."""
    largest_step_m: float
    """Largest shift of a multiframe in this round [m]."""


class CarriedFigures(msgspec.Struct, frozen=True, kw_only=True):
    """How far decisions moved the nodes that a refined trajectory was carried along with."""

    moved_m: float
    """Largest of all positions [m]."""
    turned_rad: float
    """Largest of all directions [rad]."""


class RefineFigures(Figures, frozen=True, kw_only=True, omit_defaults=True):
    """The semi-rigid refinement."""

    rounds: tuple[RefineRound, ...]
    carried: CarriedFigures | None = None
    """Missing = it was refined by itself, not carried along with the nodes."""


class AntennaFigures(msgspec.Struct, frozen=True, kw_only=True):
    """What the fixes say of the antenna in the rig file."""

    arm_m: Point
    """To be added to the lever arm, in axes of the body [m]."""
    arm_sd_m: Point
    """Standard deviations of it [m]."""
    arm_sigmas: float
    """Size of it in standard deviations, all axes together."""
    clock_s: float
    """To be added to the time offset of the receiver [s]."""
    clock_sd_s: float
    """Standard deviation of it [s]."""
    fixes: int
    """Number of fixes used."""


class UncertaintyFigures(msgspec.Struct, frozen=True, kw_only=True):
    """How well the poses are known, from the covariances of the final graph."""

    largest_sd_m: float
    """Largest standard deviation of a position, along its worst axis [m]."""
    at_s: float
    """When, after the first pose [s]."""
    at_m: Point
    """Where, in the map [m]."""
    on_earth: bool
    """False: relative to the first pose. True: on the earth."""
    shape_rms_m: float | None = None
    """Expected RMS of all positions after the best rigid alignment with the truth [m]; None = an
    earlier version, as the next one."""
    shape_largest_sd_m: float | None = None
    """Largest standard deviation of a position after it, along its worst axis [m]."""
    point_from_s: float
    """A control point from here … [s]"""
    point_to_s: float
    """… to here [s] …"""
    point_sd_m: float
    """… would reduce the largest standard deviation to this [m]."""


class MirrorFigures(msgspec.Struct, frozen=True, kw_only=True):
    """A wall that shows the room before it."""

    area_m2: float
    middle_m: tuple[float, float]
    """x and y of its middle in the map [m]."""
    behind: float
    """Ratio of all points that lie behind it."""


class MovedFigures(msgspec.Struct, frozen=True, kw_only=True):
    """How far decisions move a map from where it is without them."""

    moved_m: float
    """Largest of all positions [m]."""
    turned_rad: float
    """Largest of all directions [rad]."""


class LevelFigures(Figures, frozen=True, kw_only=True):
    """The leveled map and its place on earth."""

    leveled_by: str = msgspec.field(name="levelled_by")
    """``ins``, ``imu``, ``floor`` or ``none``."""
    tilt_deg: float
    """Tilt of the map before leveling [°]."""
    crs: str
    """Code of the map's CRS; empty = a local frame."""
    local: str
    """`LocalReason` why the map is in a local frame; empty = it is not."""
    edges_rejected: int = 0
    """Edges that contradict the positions."""
    antenna: AntennaFigures | None = None
    """Audit of the antenna; None = too few fixes."""
    uncertainty: UncertaintyFigures | None = None
    """None = not stated: line scans, or fewer than two nodes."""
    mirrors: tuple[MirrorFigures, ...] = ()
    """Walls that show the room before them."""
    held: MovedFigures | None = None
    """None = the map follows the decisions, or there are none."""
    moved: MovedFigures | None = None
    """Of a map that follows them; None = it is held, or not compared with the one before."""


class PlaceThickness(msgspec.Struct, frozen=True):
    """Thickness of the planar surfaces of a tile."""

    middle_m: Point
    """Of the tile's points [m]."""
    p50_m: float
    planar_coverage: float


class PlaneThickness(msgspec.Struct, frozen=True, kw_only=True):
    """Standard deviation of points across planar surfaces [m]; None = there are none."""

    p50_m: float | None
    p95_m: float | None
    planar_coverage: float | None
    """Ratio of the places that are planar, 0..1."""
    thickest: tuple[PlaceThickness, ...] = ()
    """The tiles with the thickest surfaces."""


class CorrectedClass(msgspec.Struct, frozen=True, kw_only=True):
    """A correction of classes by a person, and what became of it in a map."""

    id: str
    to: str
    """Title of the new class."""
    who: str
    why: str
    time: str
    """When it was decided, UTC, ISO 8601."""
    points_then: int
    """Points that it changed in the map that the person looked at."""
    points: int
    """Points that it changed in this one."""
    applied: bool
    """Whether its points lie together as they did; if not, it changes none."""
    moved_m: float | None
    """How far they have moved since [m]; None = this walk no longer has them."""
    apart_m: float | None
    """How far they have moved against each other [m]."""
    place_m: Point
    """Middle of its volume, as decided [m]."""
    lost: int = 0
    """Clusters of it that do not apply, because their points no longer lie together."""


class MapFigures(Figures, frozen=True, kw_only=True):
    """The map."""

    points: int
    bounds_m: tuple[Point, Point]
    """Lowest and highest corner [m]."""
    strays: int = 0
    """Stray returns, which ``points`` does not count."""
    surface: Literal["fitted", "raw"] = "raw"
    """Where the points lie: on fitted surfaces, or where they were measured."""
    thickness: PlaneThickness | None = None
    """Of the surfaces, as delivered; None = of an earlier version."""
    thickness_as_measured: PlaneThickness | None = None
    """The same of the points as measured; None = the points lie there."""
    corrections: tuple[CorrectedClass, ...] = ()
    """Of classes by people, in the order in which they apply."""
    bent_ratio: float | None = None
    """Of a map that decisions carried along: ratio of points that left their surface; None = it was
    made by itself."""


class ClassFigures(Figures, frozen=True, kw_only=True):
    """The classes of measured points."""

    points: int
    classes: dict[str, int]
    """How many by title of the class (`recon4.model.classes`)."""


class AuditFigures(Figures, frozen=True, kw_only=True):
    """What the witnesses found."""

    findings: dict[str, int]
    """How many by level."""


class Scan2dFigures(Figures, frozen=True, kw_only=True):
    """The imported scans of a 2-D laser."""

    scans: int
    beams: int
    """Of each scan."""
    odometry: bool
    """Whether the recording has poses of its own."""
    outcome: str = "complete"
    """``complete``, or how far it could be read."""
    tilt_deg: float = 0.0
    """Angle between the plane of the laser and the level one, by rig file or tf [°]."""
    mirrored: bool = False
    """Whether the scans turned against the odometry, and were mirrored."""
    stated: dict[str, Value] = {}
    """What states the mount of the laser, and how it is, as values of findings; empty = nothing."""
    mount: str = ""
    """Of earlier versions: the same as text."""
    doubts: tuple[str, ...] = ()
    """Of earlier versions: sentences about the mount of the laser, in place of findings."""


class Odometry2dFigures(Figures, frozen=True, kw_only=True):
    """Odometry of a 2-D laser."""

    scans: int
    lost: int
    """Scans where tracking was lost."""
    keyframes: int
    searched: int
    """Scans whose pose a correlative search found."""
    resets: int
    """How many times the local map started again."""


class Map2dFigures(Figures, frozen=True, kw_only=True):
    """The occupancy grid."""

    cell_m: float
    """Edge of a cell [m]."""
    enlarged: int = 1
    """How many times larger it is than requested, because the map would be too large."""
    overview_cell_m: float = 0.0
    """Edge of a cell of ``overview.png`` [m]; 0 = of an earlier version, without one."""
    size: tuple[int, int]
    """Cells along x and y."""
    free_m2: float
    """Free area [m²]."""
    crossing_ratio: float
    """Fraction of the beams that cross walls of the map before their return."""
    largest_sd_m: float
    """Largest standard deviation of a position relative to the start [m]."""
