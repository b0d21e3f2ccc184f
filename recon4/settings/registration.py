"""Settings of pair registration: segments, overlap, solver, plane map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import require


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentSettings:
    """Collar line segments (V §2.4, requirements A3.1)."""

    azimuth_bins: int = 36
    """Cells around the spin axis."""
    generated: int = 20
    """Number of random segments per cell between two neighboring rings."""
    preserved: int = 5
    """Number of the shortest of them that are kept."""
    max_length_per_range: float = 0.34
    """A segment longer than this times the range of its nearer end crosses a depth edge and is
    dropped (a third: 2° between beams, at least 6° of incidence)."""
    seed: int = 4
    """Seed of the random draws; combined with the frame id."""

    def __post_init__(self) -> None:
        require(4 <= self.azimuth_bins <= 3600, "azimuth_bins must be 4 to 3600", self.azimuth_bins)
        require(
            1 <= self.preserved <= self.generated,
            "preserved must be 1 to generated",
            self.preserved,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class OverlapSettings:
    """Overlap by a spherical z-buffer (V §2.5, requirements A4)."""

    azimuth_bins: int = 180
    elevation_bins: int = 90
    min_points: int = 5
    """A bin with fewer points is empty."""
    relative_tolerance: float = 0.1
    """t_r of V Eq. 2.6, read as ``p_r < r_min * (1 + t_r) + t_a`` (A0 no. 2)."""
    absolute_tolerance_m: float = 0.3
    """t_a of V Eq. 2.6 [m]."""
    threshold: float = 0.5
    """t_o: pairs that overlap less are rejected."""
    mode: Literal["target", "source", "min", "harmonic"] = "target"
    """Which points are tested in which buffer; ``target`` is as in the text."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationSettings:
    """Registration of two sets of collar line segments (V §2.4, requirements A3)."""

    solver: Literal["planes", "common_normal", "svd"] = "planes"
    """``svd``: closed form on closest points of lines, as in the documents. ``common_normal``:
    distance along the common normals of lines. ``planes``: distance from a map of small planes."""
    max_iterations: int = 20
    """Upper bound on match-and-solve rounds (thesis: 500)."""
    max_move_m: float = 2.5
    """A solution farther from its initial pose has not converged [m, rotation as at 5 m]."""
    converged_step_m: float = 5e-4
    """Stop if a round moves a point at 5 m by less than this [m] (``common_normal``)."""
    max_distance_m: float = 1.0
    """Midpoints farther apart never match [m] (``common_normal``)."""
    kernel_m: float = 0.05
    """Scale of the Cauchy kernel on the line distance [m] (``common_normal``)."""
    portion: float = 0.5
    """Smallest fraction of nearest matches that odometry keeps, even if the overlap is smaller
    (``svd``, ``common_normal``)."""
    error_window: int = 20
    """Rounds over which the error must not change (``svd``)."""
    error_deviation: float = 1e-4
    """Standard deviation of the error in that window below which it has converged (``svd``)."""
    target_error_m: float = 0.01
    """An error below this has converged [m] (``svd``)."""

    def __post_init__(self) -> None:
        require(
            self.solver in {"planes", "common_normal", "svd"},
            "solver must be planes, common_normal or svd (single scans are registered only inside "
            "odometry without an IMU, by solver planes and the group scans)",
            self.solver,
        )
        require(self.max_iterations >= 1, "max_iterations must be 1 or more", self.max_iterations)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneSettings:
    """Map of small planes to which the solver ``planes`` registers segments."""

    finest_m: float = 0.2
    """Edge of the smallest cubes [m]."""
    levels: int = 4
    """Number of sizes of cubes; each is twice the one before."""
    min_points: int = 8
    """A cube with fewer points has no plane."""
    max_sd_m: float = 0.03
    """Largest standard deviation of the points of a plane across it [m]."""
    point_sd_m: float = 0.02
    """Standard deviation of one measured point [m]."""
    kernel_m: float = 0.02
    """Scale of the Cauchy kernel on the distance from the plane [m]."""
