"""Tuning of registration to maps."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class CollarLineTuning(Struct, frozen=True, kw_only=True):
    """Registration of line segments to lines."""

    min_matches: int = 20
    """With fewer matches a registration has not converged."""


COLLAR_LINES = CollarLineTuning()


class DegeneracyTuning(Struct, frozen=True, kw_only=True):
    """Information that errors of the normals alone create."""

    least_turn: float = 0.2
    """Squared part of the turn in a motion from which on it counts as a turn: a shift along a
    tunnel has 0.01 of it, a turn in a round hall or stairwell 0.3 to 1."""
    curved_information: float = 0.009
    """Information on a turn per weight of the points, at their typical distance, that planes fitted
    to curved walls feign: 0.0028 to 0.0040 in a round hall, 0.0018 to 0.0060 on spiral stairs;
    offices and staircases have at least 0.0139."""


DEGENERACY = DegeneracyTuning()


class FrameFitTuning(Struct, frozen=True, kw_only=True):
    """Registration of one frame to the map of planes."""

    gates_m: tuple[float, ...] = (1.0, 0.5, 0.3, 0.2)
    """Largest distance of a point from its plane in each round [m]; the last one is for all
    further."""
    expected_sd: tuple[float, float] = (0.02, 0.05)
    """Standard deviation of the pose that the registration to the last scan expects [rad, m]: both
    scans are distorted. The local map is more exact, but while one turns it may let the body
    slide."""
    near_variance: float = 1e-6
    """The first planes are those at the expected pose, to a millimeter [m², rad²]."""
    gyroscope_sd_rad: float = float(np.deg2rad(0.1))
    """Standard deviation of the turn of a multiframe by the gyroscope, with its bias and scale."""
    weak_sd_m: float = 0.04
    """Standard deviation of the position by the points from which on they hardly observe it [m]."""
    person_m_s: float = 2.5
    person_sd_m_s: float = 0.5
    """Speed that a person with a backpack hardly exceeds, and how firmly: where nothing observes
    the motion, errors of the accelerometer would add up to tens of meters a second. What a LiDAR
    observes is known a hundred times better, so a vehicle is not held back."""


FRAME_FIT = FrameFitTuning()


class LineOdometryTuning(Struct, frozen=True, kw_only=True):
    """The odometry of the documents."""

    predictor: int = 3
    """Number of past motions the linear predictor uses (requirements A3.2)."""
    passes: int = 2
    """Undistort, register, undistort again (V §2.6)."""


LINE_ODOMETRY = LineOdometryTuning()


class MovingTuning(Struct, frozen=True, kw_only=True):
    """Moving objects."""

    view_ns: int = 1_000_000_000
    """Time between two scans that are compared [ns]."""
    sampled: int = 3000
    """Points of a scan of which the ratio of moving ones is worked out."""
    apart_ns: int = 400_000_000
    reach_ns: int = 10_500_000_000
    """Points are compared with scans at least and at most this far away in time [ns]: trajectories
    drift, and who walks along has left his place after seconds."""
    least_cell_deg: float = 2.0
    """Cells of an image of ranges [°]; wider where the rings of a LiDAR are farther apart: a cell
    between two rings has no return, and who stands before it is not seen through."""
    margin_m: float = 0.3
    margin_per_m: float = 0.05
    """How far behind a point everything lies if a scan sees through it; the same by its range."""
    nearest_m: float = 0.3
    farthest_m: float = 30.0
    """Range of points that are compared: farther away a person is smaller than the cells around."""
    min_passes: int = 2
    agreed: int = 4
    """Scans that see through a moving point; if this many more do than not, they agree, and no more
    are asked."""
    around_m: float = 0.25
    around_points: int = 3
    """Feet on the ground and hands at a wall are not seen through: points count as moving, too, if
    this many moving ones lie in the cubes of this size around their own [m]."""
    cleared: float = 0.04
    cleared_ns: int = 2_000_000_000
    """They are left out near scans [ns] with at least this ratio of them."""


MOVING = MovingTuning()


class PlaneMapTuning(Struct, frozen=True, kw_only=True):
    """Memory of the map of planes."""

    first_capacity: int = 1 << 16
    """Number of cubes for which there is room at first."""


PLANE_MAP = PlaneMapTuning()


class PlaneMatchTuning(Struct, frozen=True, kw_only=True):
    """Registration of segments to a map of planes."""

    gates_m: tuple[float, ...] = (1.0, 0.7, 0.5, 0.3, 0.2, 0.15)
    """Largest distance of a segment from its plane in each round [m]; the last one is for all
    further."""
    error_gate_m: float = 0.5
    """Segments farther from their plane do not count in the error [m]."""
    min_matches: int = 100
    """With fewer matches a registration has not converged."""


PLANE_MATCHES = PlaneMatchTuning()


class PointMapTuning(Struct, frozen=True, kw_only=True):
    """Single points where segments observe too little."""

    min_viewpoints: int = 5
    """Far away a scan is a few sparse lines, which move with the sensor and seem to be surfaces
    until they were seen from this many keyframes."""
    min_facing: float = 0.9
    """Cosine between a plane's normal and the weak directions above which its points are used. In a
    corner two walls, hit by a few rings, seem to be one plane that is tilted by 30 to 60°: with 0.5
    most of what a level VLP-16 knew of its height were such planes."""
    range_sd_m: float = 0.015
    across_sd_m: float = 0.005
    most_sds: float = 2.0
    """The points of a surface scatter by their range, along the sight, and by the poses of the map;
    planes that scatter by more than this multiple are of several surfaces, and move with the
    rings. Floors scatter by 3 to 6 mm, corners by 13 to 22."""
    min_incidence: float = 0.25
    """Cosine of the angle of incidence above which a point is used. Where one ring sweeps around an
    edge, its points span the plane of the ring itself, which moves with the sensor: a false plane,
    but one that contains the line of sight."""
    max_points: int = 1500
    """Largest number of points that are chosen for a frame."""
    scale: float = 0.2
    """Fraction of the points that counts as independent; more of them hold the odometry to errors
    of their map."""
    gate_m: float = 0.3
    """Largest distance from its plane of a point that is chosen [m]."""
    radius_m: float = 120.0
    """Planes farther away are forgotten [m], a little more than the range of the sensors."""
    forget_every: int = 50
    """Number of keyframes between two such clean-ups."""
    max_cubes: int = 300_000
    """With more cubes than this after a clean-up the radius is halved: about 100 MB."""
    near_m: float = 2.5
    near_stride: int = 4
    """Of points nearer than this [m] every fourth is used: near surfaces have more than enough."""
    min_extent_m: float = 0.03
    max_variance_ratio: float = 0.2
    """Planes of the map: a reveal is only 10 cm deep, but wider than the noise of a single ring."""


POINT_MAP = PointMapTuning()


class WeakPlaceTuning(Struct, frozen=True, kw_only=True):
    """The place along a weak direction where most points lie on planes (`weak_places.py`)."""

    step_m: float = 0.02
    """Between two places that are compared [m]: the kernel of the planes."""
    steps: int = 10
    """Number of them forward, and back: four standard deviations of the prediction."""
    clear: float = 3.0
    """Half chi-square by which another place is better: 8 to 12 where a corridor was 12 cm off at
    the depth of a door."""
    aside_m: float = 0.1
    """Points are also chosen with the body this far forward, and back [m]: at a wrong place many
    lie on nothing."""
    max_points: int = 300
    """Of more points some are compared."""


WEAK_PLACES = WeakPlaceTuning()


class ScanChainTuning(Struct, frozen=True, kw_only=True):
    """Pose of a frame relative to the last good scan."""

    source_points: int = 3000
    """Number of points of a new scan; the registration to the plane map uses all segments."""
    undistorted: int = 4
    """How often a scan of a rosette is located, each time undistorted by the motion found before:
    each halves the error of the motion …"""
    settled_m: float = 0.005
    """… until it moves by less than this [m, rotation as at 5 m]."""


SCAN_CHAIN = ScanChainTuning()


class ScanMatchTuning(Struct, frozen=True, kw_only=True):
    """Registration of two single scans."""

    min_matches: int = 50
    """With fewer matches a registration has not converged."""
    coarse_points: int = 1500
    """Number of points of a coarse fit."""
    coarse_rounds: int = 10
    """Number of its rounds."""
    wide: float = 3.0
    """The gate of the first rounds is larger by this factor."""
    fits: int = 6
    """Coarse fits that are refined where others than the best count."""
    yaws: int = 120
    """Number of headings in which ground plans are overlaid."""
    plan: int = 160
    """Cells of a ground plan along each side."""
    plan_cell_m: float = 0.5
    """Edge of the cells of a ground plan [m]."""
    plan_most: float = 4.0
    """A cell of a ground plan counts at most this many points."""
    normal_noise_rad: float = 0.05
    """Standard deviation of a normal; what it seems to observe gives way to a prior [rad]. With
    0.07 a corridor with recessed doors, which is observed along its axis, counts as a tunnel."""
    min_variance_m2: float = 1e-4
    """Smallest variance of a match [m²]."""
    steep: float = 0.6
    """The ground plan has the points whose normal has a smaller z component than this."""


SCAN_MATCHES = ScanMatchTuning()
