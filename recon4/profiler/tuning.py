"""Tuning of the estimation with a profiler."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.settings import LineSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class LineTuning(LineSettings):
    """Line scans of a profiler (docs/explanation/wuerzburg.md; requirements A12)."""

    knot_s: float = 0.02
    """Time between two knots of the trajectory, which the IMU joins [s]."""
    rounds: int = 12
    """Largest number of rounds of the refinement; each builds the map of all lines."""
    min_gap_s: float = 6.0
    """A point is matched only to points that are earlier or later by at least this: a turn of the
    head [s] (requirements A12 L-4)."""
    min_range_m: float = 1.5
    """Nearer points are of the carrier and are not matched [m]."""
    turn_every: int = 2
    """Of the points every n-th is unwound for the pose graph of turns."""
    turn_voxel_m: float = 0.06
    """A turn has one point in each voxel of this edge [m]."""
    link_distance_m: float = 0.25
    """Points of two turns nearer to each other than this are a closest pair [m]."""
    link_pairs: int = 250
    """Turns with fewer closest pairs are not linked."""
    link_reach_m: float = 40.0
    """Turns farther apart are not linked [m]."""
    turn_sd_m: float = 0.02
    """Smallest standard deviation of two registered turns [m] …"""
    turn_sd_rad: float = 0.003
    """… and of their rotation [rad]."""
    chain_sd_m: float = 0.05
    """Standard deviation of the first trajectory from one turn to the next [m] …"""
    chain_sd_rad: float = 0.01
    """… and of its rotation [rad]."""
    preregister_m: float = 1.5
    """``published``: largest distance of two points of consecutive turns [m]."""
    slam_rounds: int = 15
    """``published``: rounds of the registration of turns."""
    outer_rounds: int = 10
    """``published``: rounds of the semi-rigid step."""
    group_lines: int = 100
    """``published``: line scans between two corrections."""
    pair_every: int = 5
    """``published``: of the points that are matched every n-th is paired."""
    pair_voxel_m: float = 0.1
    """``published``: a turn has one point in each voxel of this edge [m]."""
    map_stride: int = 1
    """Every n-th multiframe is built into the map."""
    map_every: int = 8
    """Of its points every n-th is built into the map."""
    match_every: int = 8
    """Of the points of lines every n-th is matched."""
    laser_every: int = 4
    """Of the beams of the 2-D laser every n-th is matched; 0 = none."""
    information_scale: float = 0.1
    """Fraction of the matches that counts as independent."""
    total_sd_m: float = 0.1
    """Standard deviation of a correction of the initial position [m] …"""
    total_sd_rad: float = 0.02
    """… and of the initial rotation [rad]."""
    converged_step_m: float = 1e-3
    """Stop if no knot moves farther than this [m]."""
