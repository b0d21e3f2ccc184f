"""Tuning of 2-D mapping."""

from __future__ import annotations

from dataclasses import dataclass

from msgspec import Struct

from recon4.settings import Grid2dSettings, Loop2dSettings, Slam2dSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class Slam2dTuning(Slam2dSettings):
    """Registration of the scans of a 2-D laser (docs/explanation/slam2d.md)."""

    height_window_m: float = 1.0
    """With an attitude: returns more than this above or below the laser are left out [m]."""
    cell_m: float = 0.1
    """Edge of the smallest cells of the local map [m]."""
    noise_sd_m: float = 0.02
    """Standard deviation of the distance of a return to its line [m]."""
    keyframe_m: float = 0.25
    """A scan becomes a keyframe after this motion [m] …"""
    keyframe_rad: float = 0.2
    """… or this rotation [rad]; keyframes form the local map and are the nodes of the graph."""
    window: int = 60
    """Number of keyframes in the local map."""
    min_match_ratio: float = 0.25
    """Tracking is lost if a smaller fraction of the returns lies on lines of the local map."""
    search_match_ratio: float = 0.5
    """Below this match ratio a correlative search tries to find a better pose."""
    max_speed_m_s: float = 2.0
    """Largest speed [m/s]; the correlative search looks no farther."""
    max_turn_rad_s: float = 3.0
    """Largest rate of rotation [rad/s]."""
    normal_noise_rad: float = 0.05
    """Error of the normals of the lines [rad]: a direction with no more information than such
    errors create counts as unobservable."""


class HectorTuning(Struct, frozen=True, kw_only=True):
    """Constants of hector_slam (requirements A12 L-1)."""

    cell_m: float = 0.025
    """Edge of a cell of the finest grid [m]."""
    levels: int = 3
    """Number of grids; each has cells twice as large as the one before."""
    iterations: int = 5
    """Iterations on the finest grid …"""
    coarse_iterations: int = 3
    """… and on each coarser one."""
    p_free: float = 0.4
    """Probability by which a beam that passes updates a cell."""
    p_occupied: float = 0.9
    """The same for a return."""
    update_m: float = 0.4
    """The map is updated after this motion [m] …"""
    update_rad: float = 0.9
    """… or this rotation [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Loop2dTuning(Loop2dSettings):
    """Loop closure of 2-D maps (docs/explanation/slam2d.md)."""

    min_path_m: float = 10.0
    """Places with a shorter path between them are not loops [m]."""
    reach_m: float = 3.0
    """Nodes farther apart do not show the same place [m] …"""
    drift_ratio: float = 0.015
    """… plus this ratio of the path between them, to allow for drift."""
    drift_rad_m: float = 0.002
    """Drift of the rotation [rad] per meter of that path."""
    first_search_m: float = 1.0
    """Largest uncertainty of the candidates of the first round [m]: the most certain are tried
    first, and the limit is doubled from round to round …"""
    last_search_m: float = 16.0
    """… up to this [m]."""
    source_stride: int = 3
    """Every n-th node searches for revisits."""
    source_reach: int = 4
    """Keyframes before and after a node that are registered together."""
    target_stride: int = 6
    """Distance of the middles of the sub-maps [nodes]."""
    target_reach: int = 15
    """Keyframes before and after its middle that form a sub-map."""
    revisits: int = 3
    """Largest number of earlier visits that a node is registered to."""
    min_score: float = 0.5
    """Smallest score of the correlative search, 0 to 1."""
    min_match_ratio: float = 0.55
    """A pair with a smaller match ratio is rejected."""
    min_degeneracy: float = 0.01
    """A pair with a smaller degeneracy is rejected (0 = unobservable, 1/2 = isotropic)."""
    loop_sd_m: float = 0.015
    """Smallest standard deviation of a loop closure [m]."""
    loop_sd_rad: float = 0.002
    """The same for its rotation [rad]."""
    odometry_sd_m: float = 0.004
    """Smallest standard deviation of an edge between consecutive nodes [m]."""
    odometry_sd_rad: float = 0.001
    """The same for its rotation [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid2dTuning(Grid2dSettings):
    """The occupancy grid, as nav2 reads it (docs/explanation/slam2d.md)."""

    p_free: float = 0.4
    """Probability by which a beam that passes updates a cell."""
    p_occupied: float = 0.9
    """The same for a return."""
    occupied_threshold: float = 0.65
    """Cells with a larger probability are occupied."""
    free_threshold: float = 0.25
    """Cells with a smaller probability are free."""
