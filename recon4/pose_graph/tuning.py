"""Tuning of the pose graph: search, place recognition, verification."""

from __future__ import annotations

from dataclasses import dataclass, fields

from recon4.settings import GraphSettings, RecognitionSettings, VerificationSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphTuning(GraphSettings):
    """Progressive pose graph (docs/explanation/search.md; V §2.7, requirements A6)."""

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


@dataclass(frozen=True, slots=True, kw_only=True)
class RecognitionTuning(RecognitionSettings):
    """Place recognition: loop closures beyond the search radius of revisits
    (docs/explanation/search.md).
    """

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
    """That of ``GraphTuning`` for recognized places, which nothing predicted."""
    min_places: int = 3
    """Number of nodes in a row that must agree on a correction."""
    rival_ratio: float = 0.5
    """Another correction with at least this ratio of the nodes of the best one makes both
    ambiguous."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationTuning(VerificationSettings):
    """Verification by alternative paths
    (docs/explanation/pose-graph.md; V §2.8, requirements A7).
    """

    max_path_edges: int = 3
    """Longest alternative path, 2 or 3 edges."""
    inlier_probability: float = 0.999
    """Fraction of correct edges that the robust solve keeps if their information is true."""


def graph_tuning(settings: GraphSettings) -> GraphTuning:
    """The tuning of a search: that of sub-maps, or of single multiframes as published.

    The published one has the values of V §2.7 and Table 3.1, and no limits that the text lacks.
    """
    if isinstance(settings, GraphTuning):
        return settings
    chosen = {field.name: getattr(settings, field.name) for field in fields(settings)}
    if settings.pairs == "submaps":
        return GraphTuning(**chosen)
    return GraphTuning(
        **chosen,
        retry_rounds=0,
        source_reach=0,
        target_reach=0,
        min_match_ratio=0.0,
        min_degeneracy=0.0,
        max_seen_through=1.0,
        loop_sd_m=0.1,
        loop_sd_rad=0.01,
    )
