"""Tuning of the evaluation."""

from __future__ import annotations

from msgspec import Struct


class AteTuning(Struct, frozen=True, kw_only=True):
    """Absolute trajectory error."""

    min_spread_m: float = 0.05
    """Below this lateral extent of the positions the rotation of the fit is undetermined."""


ATE = AteTuning()


class EvaluationTuning(Struct, frozen=True, kw_only=True):
    """``recon4 evaluate``."""

    every: int = 10
    """Of the multiframes, every tenth is placed by the estimate and by the truth."""
    frame_ns: int = 100_000_000
    """Dense trajectories are evaluated at one pose per multiframe of 10 Hz [ns]."""


EVALUATION = EvaluationTuning()


class SensorFloorTuning(Struct, frozen=True, kw_only=True):
    """What the sensor itself leaves of e_r."""

    max_range_m: float = 60.0
    """As for the map [m]."""


SENSOR_FLOOR = SensorFloorTuning()


class SegmentDriftTuning(Struct, frozen=True, kw_only=True):
    """Drift over segments."""

    min_path_m: float = 0.1
    """Shorter pieces are stationary and have no drift per meter; they are left out."""
    thesis_frames: tuple[int, ...] = tuple(range(100, 801, 100))
    """Lengths of the pieces in V §3.1 [frames]."""


SEGMENT_DRIFT = SegmentDriftTuning()


class MeshAlignmentTuning(Struct, frozen=True, kw_only=True):
    """Alignment of a map with a mesh."""

    kernel_m: float = 0.05
    """Scale of the Cauchy kernel: points of moving people must not pull the map."""
    max_samples: int = 400_000
    """Points of the map that are aligned."""
    still: float = 1e-4
    """Convergence: largest step [m and rad]."""


MESH_ALIGNMENT = MeshAlignmentTuning()


class RelationTuning(Struct, frozen=True, kw_only=True):
    """Errors against reference relations."""

    max_bytes: int = 256 << 20
    """Largest file of relations."""
    latest_s: float = 2.0**33
    """Times of this many nanoseconds still fit into 64 bits [s]."""
    slack_ns: int = 1_000_000
    """Times of relations may lie outside of the trajectory by this much: they are rounded [ns]."""


RELATIONS = RelationTuning()


class SharpnessTuning(Struct, frozen=True, kw_only=True):
    """How crisp a map is without any truth."""

    min_neighbors: int = 10
    """Points with fewer neighbors are not counted."""
    planar: float = 0.1
    """A place is a plane where the middle eigenvalue is at least 1/0.1 times the smallest
    and at least 0.1 times the largest."""
    batch: int = 500
    """Points whose neighbors are looked for at a time."""
    merge_points: int = 1_000_000
    """Points that are merged at a time."""


SHARPNESS = SharpnessTuning()


class RelativeErrorTuning(Struct, frozen=True, kw_only=True):
    """Relative error e_r."""

    histogram_step_m: float = 0.001
    """Width of a class of the error histogram [m]."""
    outlier_m: float = 0.5
    """Points farther from the model than this are outliers [m]."""
    batch: int = 500_000
    """Points that are compared at a time."""


RELATIVE_ERROR = RelativeErrorTuning()


class ThicknessTuning(Struct, frozen=True, kw_only=True):
    """Thickness of planar surfaces."""

    cell_m: float = 0.3
    """Edge of the cubes whose points are tested for a plane [m]."""
    most_points: int = 4_000_000
    """Of a larger map an even sample of about this size is used."""
    min_points: int = 15
    """A cell with fewer points is not counted."""
    planar: float = 0.1
    """As in `recon4.evaluation.sharpness`: the middle eigenvalue is at least 1/0.1 times the
    smallest and at least 0.1 times the largest."""
    min_cells: int = 10
    """A place with fewer cells is not listed."""
    places: int = 10
    """Places that are listed; the thickest first."""


THICKNESS = ThicknessTuning()


class MarkerFileLimits(Struct, frozen=True, kw_only=True):
    """Tables of survey markers."""

    max_bytes: int = 16 << 20
    """Largest table."""


MARKER_FILES = MarkerFileLimits()


class MeshFileLimits(Struct, frozen=True, kw_only=True):
    """Triangle meshes of unknown origin."""

    max_triangles: int = 20_000_000
    """Most triangles of a mesh."""
    max_text_bytes: int = 4 << 30
    """Largest file of text."""
    max_sides: int = 1000
    """Most corners of a face."""


MESH_FILES = MeshFileLimits()


class AccuracyClassTuning(Struct, frozen=True, kw_only=True):
    """Classes of the accuracy of a map at its check points."""

    tested_points: int = 30
    """Fewer check points estimate an accuracy, they do not test it (ASPRS Edition 2, 7.12)."""
    walk_limits_m: tuple[float, float, float, float] = (0.14, 0.12, 0.28, 0.24)
    """Mean horizontal and height, largest horizontal and height (V §3.3) [m]."""
    loa_m: tuple[tuple[str, float], ...] = (
        ("LOA20", 0.05),
        ("LOA30", 0.015),
        ("LOA40", 0.005),
        ("LOA50", 0.001),
    )
    """Largest error at 95 % of the levels of USIBD [m]; LOA10 is the rest."""
    significance: float = 0.001
    """Residuals this unlikely, all together, are larger than stated (Baarda 1968: 0.1 %)."""


ACCURACY_CLASSES = AccuracyClassTuning()
