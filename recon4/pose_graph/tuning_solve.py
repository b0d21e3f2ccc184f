"""Tuning of the solve, and of what is stated of its result."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class GraphCheckTuning(Struct, frozen=True, kw_only=True):
    """Validity of a graph."""

    rotation_tolerance: float = 1e-6
    """A matrix this near to a rotation is one."""


GRAPH_CHECKS = GraphCheckTuning()


class ErrorModelTuning(Struct, frozen=True, kw_only=True):
    """What a graph shows of its own errors."""

    enough_edges: int = 8
    """Registered edges that show how wrong a walk is; fewer show a part of it, none nothing."""
    least: float = 0.15
    most: float = 30.0
    """Bounds of the ratio of the errors of a walk to the usual ones."""


ERROR_MODEL = ErrorModelTuning()


class GraphFileTuning(Struct, frozen=True, kw_only=True):
    """Files of a graph."""

    block: int = 1024
    """Edges that are written at a time."""
    digits: int = 5
    """Significant digits of its figures; ``graph.npz`` has all."""


GRAPH_FILES = GraphFileTuning()


class PairTuning(Struct, frozen=True, kw_only=True):
    """Registration of pairs."""

    chunk: int = 8
    """Nodes per task of a thread."""


PAIRS = PairTuning()


class PieceTuning(Struct, frozen=True, kw_only=True):
    """Pieces of a walk."""

    walk_m_s: float = 1.5
    """Speed at which the body may have moved on without being seen [m/s]."""
    unknown_m: float = 1.0
    tilt_rad: float = 0.1
    """Standard deviations between two pieces, beside what grows with time; their heading is not
    known at all."""


PIECES = PieceTuning()


class RigErrorTuning(Struct, frozen=True, kw_only=True):
    """What an error of the rig does to the poses."""

    pull: float = 0.35
    """A pose follows a wrong LiDAR by this ratio of its error (1.4° in eleven worlds: NEES of the
    turns 0.3 to 2.5 with it, 0.8 to 20 without it)."""
    arm_m: float = 0.6
    """Surfaces that a wrongly turned LiDAR sees pull the body aside by its turn times this [m]."""
    either: float = float(np.sqrt(0.5 / 3.0))
    """A turn between the only LiDAR and the IMU is an error of one of them, as likely of either:
    half of its square, on three axes."""
    exchanged_rad: float = 0.35
    """A larger turn against the only LiDAR is one of exchanged axes of an IMU, not of a mount
    [rad]."""
    walk_m_s: float = 1.3
    turn_rad_s: float = 1.0
    """Speeds by which an error of a LiDAR's clock becomes one of the pose."""


RIG_ERROR = RigErrorTuning()


class RobustTuning(Struct, frozen=True, kw_only=True):
    """The robust solve (GNC-TLS)."""

    step: float = 2.0
    """Growth of GNC's control parameter per round; gtsam uses 1.4."""
    inner_iterations: int = 3
    """Iterations per round; gtsam iterates to convergence."""
    max_rounds: int = 60
    """Upper bound on the rounds."""
    max_settling: int = 10
    """Upper bound on the rounds with weights that are 0 or 1."""
    max_noise: float = 10.0
    """Largest factor by which the variance of edges may exceed the stated one."""
    loop_nodes: int = 10
    """Edges across fewer nodes are not loops."""
    group_nodes: int = 3
    """Loops whose ends lie at most this many nodes apart form a group."""
    max_groups: int = 4
    """Number of groups of loops from which a start is tried."""
    few_outliers: float = 0.05
    """If the first start rejects at most this fraction of the loops, no other start is tried."""


ROBUST = RobustTuning()


class SearchTuning(Struct, frozen=True, kw_only=True):
    """The progressive search."""

    lost_sd_factor: float = 200.0
    """Factor on the standard deviation of an odometry edge across a lost multiframe."""
    before_recognition: int = 2
    """Rounds before places are recognized: neighbors, and the nearest revisits."""


SEARCH = SearchTuning()


class SolveTuning(Struct, frozen=True, kw_only=True):
    """The optimization."""

    cauchy_sd: float = 4.0
    """Mahalanobis length at which the Cauchy kernel halves the weight of an edge; 6 exact standard
    deviations have a length of 2.4."""
    cauchy_position_sd: float = 3.0
    """The same for an absolute position (1.7)."""
    gauge: float = 1e6
    """Ratio of the information of a fixed node to that of the best edge."""
    max_iterations: int = 100
    """Upper bound on the iterations."""
    relative_decrease: float = 1e-7
    """A smaller relative decrease of the error has converged."""
    last_step_m: float = 0.0
    """An iteration that moves no pose by more is the last one [m, rotation as at 5 m]; 0 = the
    decrease alone tells. On walks of 2500 and 10 000 nodes each iteration moves the poses by at
    most a sixth of what the one before did (docs/studies/benchmarks.md)."""


SOLVE = SolveTuning()
COARSE = SolveTuning(last_step_m=0.3)
"""Between the rounds of a search: centimeters are left, pairs need decimeters."""
NEAR = SolveTuning(last_step_m=0.001)
"""The end of a search and the start of a robust solve: hundredths of a millimeter
are left (docs/studies/benchmarks.md)."""
GRADUAL = SolveTuning(max_iterations=ROBUST.inner_iterations)
"""Rounds of the graduated robust solve."""


class UncertaintyTuning(Struct, frozen=True, kw_only=True):
    """Covariances of the poses."""

    max_knots: int = 300
    """More nodes than this are joined: the work grows with the third power of their number."""
    unknown_step: tuple[float, float] = (0.3, 5.0)
    """Largest standard deviation of an odometry edge: turn [rad], shift [m]."""
    tilt_rad: float = 0.005
    """Standard deviation of the tilt of a leveled map [rad]."""
    point_m: float = 0.01
    """Standard deviation of a control point [m]."""
    nearly: float = 1.2
    """Places where a control point leaves at most this multiple of the smallest deviation."""


UNCERTAINTY = UncertaintyTuning()


class LoneTuning(Struct, frozen=True, kw_only=True):
    """Multiframes that do not observe the motion, among others that do."""

    around_ns: int = 1_000_000_000
    """Others as long before and after one are asked [ns] …"""
    ratio: float = 0.75
    """… and at least this ratio of them, on each side, observes the motion."""
    speeds_up_m_s2: float = 2.5
    changes_s: float = 0.1
    """Standard deviation of the acceleration of a carrier [m/s²] and the time over which it changes
    [s]: stretches of 0.2 to 1 s of simulated walks are 0.9 to 1.2 of what follows (RMS)."""
    known_m: float = 0.005
    """Error of positions that are observed [m]."""


LONE = LoneTuning()
