"""Result of a registration, common to all solvers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from recon4.geometry.se3 import SE3, Array


class StopReason(StrEnum):
    """Why a registration ended."""

    SMALL_STEP = "steps became small"
    SMALL_ERROR = "error below target"
    STEADY_ERROR = "error no longer changes"
    LIMIT = "limit of rounds reached"
    TOO_FEW = "too few matches"
    UNSTABLE = "solution left the area around the initial pose"


@dataclass(frozen=True, slots=True, eq=False)
class Registration:
    """Result of a registration. Failing to converge is a result, not an error."""

    T_target_source: SE3
    """Maps points of the source into the target."""
    stop: StopReason
    iterations: int
    error_m: float
    """Mean distance of the matches kept, after the last step [m]; NaN without any."""
    match_ratio: float
    """Part of the source that found a match, 0..1."""
    information: Array
    """Inverse covariance of a left correction in the target (rotation first), (6, 6)."""
    degeneracy: float
    """Smallest eigenvalue of the mean of n n^T: 0 = unobservable direction, 1/3 = isotropic."""

    @property
    def converged(self) -> bool:
        """Whether the stop reason is convergence, not a limit (requirements A3.2)."""
        return self.stop in {
            StopReason.SMALL_STEP,
            StopReason.SMALL_ERROR,
            StopReason.STEADY_ERROR,
        }
