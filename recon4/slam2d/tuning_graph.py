"""Tuning of graph and grid of 2-D maps."""

from __future__ import annotations

from msgspec import Struct


class BeamOrderTuning(Struct, frozen=True, kw_only=True):
    """Scans whose beams are stored in the wrong order."""

    turn_rad: float = 0.6
    """Rotation by the odometry that is enough to decide [rad] …"""
    scans: int = 60
    """… within this number of scans."""
    stretches: int = 5
    """Largest number of stretches that vote."""
    clear: float = 0.7
    """The rotation by the scans must agree with plus or minus the odometry to this ratio."""


BEAM_ORDER = BeamOrderTuning()


class Candidate2dTuning(Struct, frozen=True, kw_only=True):
    """Candidates for loop closures."""

    chunk: int = 256
    """Nodes whose distances are worked out at once."""
    sigmas: float = 3.0
    """Two nodes may be apart by as many standard deviations of the drift."""
    loose_sd_m: float = 0.05
    """Motions with a larger standard deviation count by it, not by their length [m]."""


CANDIDATES_2D = Candidate2dTuning()


class Covariance2dTuning(Struct, frozen=True, kw_only=True):
    """Covariance of the nodes of a solved graph."""

    gauge: float = 1e9
    """Information that fixes the first node."""
    nothing: float = 1e-12
    """Weight of structural entries, as a fraction of the largest information: the sparse factor has
    entries only where the matrix is not zero."""


COVARIANCE_2D = Covariance2dTuning()


class Edge2dTuning(Struct, frozen=True, kw_only=True):
    """Plane motions as edges."""

    fixed_sd: float = 1e-3
    """Standard deviation of height [m], roll and pitch [rad]: every edge says they are zero."""


EDGES_2D = Edge2dTuning()


class KeyframeTuning(Struct, frozen=True, kw_only=True):
    """Keyframes of 2-D odometry."""

    loose_sd_m: float = 0.3
    """Keyframes with a less certain motion between them are not registered together [m]."""


KEYFRAMES = KeyframeTuning()


class LoopRetryTuning(Struct, frozen=True, kw_only=True):
    """Rejected pairs that are tried again."""

    retry_move_m: float = 0.5
    """A rejected pair is tried again after its predicted pose has moved by more than this [m]."""


LOOP_RETRIES = LoopRetryTuning()


class Submap2dTuning(Struct, frozen=True, kw_only=True):
    """Registration of sub-maps."""

    most_points: int = 1500
    """Returns of a source that are registered."""
    moved_m: float = 0.5
    """A registration that leaves the pose found by the search by more is wrong [m]."""
    given_m: float = 0.5
    given_rad: float = 0.2
    """How far off a pose may be that a person predicted."""


SUBMAPS_2D = Submap2dTuning()


class GridStepTuning(Struct, frozen=True, kw_only=True):
    """Scans that are entered into the grid."""

    grid_step_m: float = 0.05
    """A scan is entered into the grid after this motion [m] …"""
    grid_step_rad: float = 0.05
    """… or this rotation [rad]: standing still must not outweigh what was seen once."""


GRID_STEPS = GridStepTuning()


class OccupancyTuning(Struct, frozen=True, kw_only=True):
    """The occupancy grid."""

    max_cells: int = 150_000_000
    """Cells of the largest grid; 1.2 GB with what is needed to fill it."""
    margin_m: float = 5.0
    """A grid that grows gets this much more on each side [m]."""
    largest_log_odds: float = 6.0
    """A cell is never surer than this."""
    crossing_margin_m: float = 0.3
    """A beam may pass a wall this near to its own return [m]."""
    wall: float = 0.9
    """Cells with a larger probability are walls that a beam should not cross."""


OCCUPANCY = OccupancyTuning()


class MapFileLimits(Struct, frozen=True, kw_only=True):
    """Files of a finished 2-D map."""

    overview_cells: int = 4096
    """Cells along the longer side of the image that pages show: browsers and graphics cards decode
    it at once, and some refuse 16384."""
    max_yaml_bytes: int = 4096
    """Largest ``map.yaml`` that is read."""
    max_pixels: int = 1 << 28
    """Largest image that is read."""
    block_cells: int = 1 << 22
    """Cells that are colored at a time."""
    free: int = 254
    unknown: int = 205
    occupied: int = 0
    """Gray values of map_saver."""
    occupied_threshold: float = 0.65
    free_threshold: float = 0.196
    """Thresholds for these gray values: 205 is a probability of 0.1961, which is neither."""


MAP_FILES_2D = MapFileLimits()


class ScanGapTuning(Struct, frozen=True, kw_only=True):
    """What the import of scans reports."""

    gap_s: float = 2.0
    """A longer time without a scan is counted [s]."""
    checked_scans: int = 1000
    """Scans that are compared with the finished map."""


SCAN_GAPS = ScanGapTuning()
