"""Settings of the stages `graph` and `verification`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphSettings:
    """Progressive pose graph (V §2.7, Algorithm 2.1, requirements A6)."""

    mode: Literal["10", "overlap", "verification", "beyond"] = "beyond"
    """What V Table 3.2 compares, and our own."""
    node_stride: int = 5
    """A node every so many multiframes."""
    closed_trajectory: bool = False
    """The walk ends where it began: pairs may wrap around (A0 no. 5)."""
    exhaustive: bool = False
    """Test all pairs as the thesis does: quadratic in the walk."""
    neighbors: int = 4
    """Pairs with the nodes before, at growing distance."""
    revisits: int = 6
    """At most so many pairs of a node with earlier visits of the same place."""
    revisit_radius_m: float = 4.0
    """Nodes farther apart are not revisits of one place [m] …"""
    drift_ratio: float = 0.005
    """… plus this ratio of the distance walked in between, for the drift not yet closed."""
    retry_rounds: int = 2
    """So many times pairs turned down are tried again from better poses; 0 = never."""
    retry_move_m: float = 0.2
    """A pair is tried again if its expected pose moved by more than this since [m, rotation as at
    5 m]."""
    source_reach: int = 2
    """Multiframes before and after a node that it brings to a pair."""
    source_segments: int = 6000
    """Segments of them that are used."""
    target_reach: int = 5
    """Multiframes before and after the other node that make the target."""
    workers: int = 2
    """Threads that register pairs; the result does not depend on it."""
    min_match_ratio: float = 0.4
    """A pair with a smaller ratio of matched segments is rejected."""
    min_degeneracy: float = 0.005
    """A pair held less than this along one direction is rejected (0 = free, 1/3 = held alike)."""
    error_relative: float = 0.01
    """t_r of the acceptance limit ``median_range * t_r + t_a`` (A0 no. 12)."""
    error_absolute_m: float = 0.05
    """t_a of that limit [m]."""
    odometry_sd_m: float = 0.001
    """Smallest standard deviation of an odometry edge [m]."""
    odometry_sd_rad: float = 0.0002
    """The same for its rotation [rad]."""
    loop_sd_m: float = 0.008
    """Smallest standard deviation of a registered edge [m]."""
    loop_sd_rad: float = 0.001
    """The same for its rotation [rad]."""

    def __post_init__(self) -> None:
        for name in ("node_stride", "workers", "source_segments"):
            value = getattr(self, name)
            require(value >= 1, f"{name} must be 1 or more", value)
        for name in ("neighbors", "revisits", "retry_rounds", "source_reach", "target_reach"):
            value = getattr(self, name)
            require(value >= 0, f"{name} must be 0 or more", value)
        require(self.retry_move_m > 0.0, "retry_move_m must be above 0", self.retry_move_m)


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationSettings:
    """Verification by alternative paths (V §2.8, requirements A7)."""

    variant: Literal["paths", "cycle"] = "paths"
    """``paths`` is the text; ``cycle`` takes triangles only and counts the edge itself as a path
    without error, as the author's code does."""
    max_path_edges: int = 3
    """Longest alternative path, 2 or 3 edges."""
    limit_m: float = 0.1
    """An edge whose median disagreement is above this is rejected [m] (A0 no. 1)."""
    robust: Literal["gnc", "cauchy", "none"] = "gnc"
    """The final solve after verification: ``gnc`` and ``cauchy`` also reject edges that do not fit
    the whole graph, ``none`` is the text."""
    inlier_probability: float = 0.999
    """Share of correct edges that the robust solve keeps if their information is true."""

    def __post_init__(self) -> None:
        require(2 <= self.max_path_edges <= 3, "max_path_edges must be 2 or 3", self.max_path_edges)
        require(self.limit_m > 0.0, "limit_m must be above 0", self.limit_m)
        require(
            0.5 <= self.inlier_probability < 1.0,
            "inlier_probability must be 0.5 to below 1",
            self.inlier_probability,
        )
