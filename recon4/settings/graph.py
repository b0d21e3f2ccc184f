"""Settings of the stages `graph` and `verification`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphSettings:
    """Progressive pose graph (V §2.7, Algorithm 2.1, requirements A6)."""

    mode: Literal["10", "overlap", "verification", "beyond"] = "beyond"
    """The modes that V Table 3.2 compares, and ``beyond``, with semi-rigid refinement."""
    node_stride: int = 5
    """Number of multiframes per node."""
    closed_trajectory: bool = False
    """The walk ends at its start: pairs may wrap around (A0 no. 5)."""
    exhaustive: bool = False
    """Test all pairs as the thesis does; the work is quadratic in the path length."""
    neighbors: int = 4
    """Number of preceding nodes that each node is paired with."""
    revisits: int = 6
    """Largest number of pairs of a node with earlier visits of the same place."""
    revisit_radius_m: float = 4.0
    """Nodes farther apart are not revisits of one place [m] …"""
    drift_ratio: float = 0.005
    """… plus this ratio of the path length in between, to allow for drift."""
    retry_rounds: int = 2
    """Number of rounds in which rejected pairs are registered again from better poses; 0 = none."""
    retry_move_m: float = 0.2
    """A rejected pair is registered again if its predicted pose has moved by more than this [m,
    rotation as at 5 m]."""
    source_reach: int = 2
    """Multiframes before and after the source node whose segments are registered."""
    source_segments: int = 6000
    """Largest number of these segments."""
    target_reach: int = 5
    """Multiframes before and after the target node that form the target map."""
    workers: int = 2
    """Threads that register pairs; the result does not depend on it."""
    min_match_ratio: float = 0.4
    """A pair with a smaller match ratio is rejected."""
    min_degeneracy: float = 0.005
    """A pair with a smaller degeneracy is rejected (0 = unobservable, 1/3 = isotropic)."""
    max_seen_through: float = 0.2
    """Largest fraction of points of a loop closure in the free space of the other visit: doors and
    people move, walls do not."""
    error_relative: float = 0.01
    """t_r of the acceptance limit ``median_range * t_r + t_a`` (A0 no. 12)."""
    error_absolute_m: float = 0.05
    """t_a of that limit [m]."""
    normal_noise_rad: float = 0.08
    """Error of the normals of a sub-map's planes [rad]: directions with no more information than
    such errors create count as unobservable. Pairs of one place share these errors, unlike the
    multiframes of odometry."""
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
    """``paths``: as in the text. ``cycle``: triangles only, with the edge itself as a path without
    error, as in the author's code."""
    max_path_edges: int = 3
    """Longest alternative path, 2 or 3 edges."""
    limit_m: float = 0.1
    """An edge with a larger path discrepancy is rejected [m] (A0 no. 1)."""
    robust: Literal["gnc", "cauchy", "none"] = "gnc"
    """The final solve after verification: ``gnc`` and ``cauchy`` also reject outliers of the whole
    graph, ``none`` is as in the text."""
    inlier_probability: float = 0.999
    """Fraction of correct edges that the robust solve keeps if their information is true."""

    def __post_init__(self) -> None:
        require(2 <= self.max_path_edges <= 3, "max_path_edges must be 2 or 3", self.max_path_edges)
        require(self.limit_m > 0.0, "limit_m must be above 0", self.limit_m)
        require(
            0.5 <= self.inlier_probability < 1.0,
            "inlier_probability must be 0.5 to below 1",
            self.inlier_probability,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class RecognitionSettings:
    """Place recognition: loop closures that lie beyond the search radius of revisits."""

    enabled: bool = True
    """Search for places beyond the search radius; off = only revisits near the predicted pose."""
    passes: int = 4
    """Largest number of searches; each begins with the poses that the one before has corrected."""
    spacing_m: float = 1.5
    """Path length from one place to the next [m]."""
    reach_m: float = 8.0
    """Path before and after a place whose walls form its image [m]."""
    min_path_m: float = 15.0
    """Places with less path in between are not compared [m]."""
    candidates: int = 10
    """Number of earlier places with the most similar descriptors that each place is laid onto."""
    hypotheses: int = 5
    """Number of poses of a place that are registered."""
    min_score: float = 0.5
    """Smallest cosine of two images laid onto each other."""
    bound_sd: float = 2.0
    """A recognized place may move a node by this many standard deviations of the graph …"""
    bound_m: float = 0.3
    """… plus this [m] …"""
    bound_ratio: float = 0.005
    """… plus this ratio of the path length in between. Farther ones are ambiguous: they are
    announced and wait for a decision."""
    search_ratio: float = 0.1
    """The search goes farther by this ratio of the path length in between, so that a drift larger
    than stated is announced."""
    max_seen_through: float = 0.06
    """The same as ``graph.max_seen_through`` for recognized places, which nothing predicted."""
    min_places: int = 3
    """Number of nodes in a row that must agree on a correction."""
    rival_ratio: float = 0.5
    """Another correction with at least this ratio of the nodes of the best one makes both
    ambiguous."""

    def __post_init__(self) -> None:
        for name in ("spacing_m", "reach_m"):
            value = getattr(self, name)
            require(value > 0.0, f"{name} must be above 0", value)
        for name in ("passes", "candidates", "hypotheses", "min_places"):
            value = getattr(self, name)
            require(value >= 1, f"{name} must be 1 or more", value)
