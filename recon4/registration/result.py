"""Outcome of a registration, whatever solved it."""

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
    UNSTABLE = "solution left the area around the guess"


@dataclass(frozen=True, slots=True, eq=False)
class Registration:
    """Not converging is an outcome, not an error."""

    T_target_source: SE3
    """Maps points of the source into the target."""
    stop: StopReason
    iterations: int
    error_m: float
    """Mean distance of the matches kept, after the last step [m]; NaN without any."""
    error_sd_m: float
    """Standard deviation of that error over the last rounds [m] (0 where it is not kept)."""
    match_ratio: float
    """Matched share of the source."""
    information: Array
    """Inverse covariance of a left correction in the target (rotation first), (6, 6)."""
    degeneracy: float
    """Smallest eigenvalue of the mean of n n^T, 0..1/3: 0 = free to slide along a direction."""

    @property
    def converged(self) -> bool:
        """Stopped for a good reason, not for a limit (requirements A3.2)."""
        return self.stop in {
            StopReason.SMALL_STEP,
            StopReason.SMALL_ERROR,
            StopReason.STEADY_ERROR,
        }
