"""What the odometry assumes while it tracks a walk: the IMU, the points that move, the fixes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum, auto

from recon4.geometry.se3 import Array
from recon4.model.hidden_points import HiddenPoints
from recon4.model.odometry_figures import ImuChoice
from recon4.model.samples import ImuSamples
from recon4.model.tried_hypotheses import Because
from recon4.registration.aiding import GnssAiding
from recon4.registration.motion import MotionState
from recon4.registration.score import Score


class Proof(Enum):
    """What a hypothesis must show to be preferred to its rival."""

    CLEARLY_BETTER = auto()
    """It knows less: without an IMU, without its accelerometer. It must fit clearly better."""
    NO_WORSE = auto()
    """It corrects what its rival has shown to be wrong, with the same points."""
    HOLDS = auto()
    """It sees fewer points, so residuals say nothing: it must lose no more multiframes."""
    HOLDS_WITH_FIXES = auto()
    """The same, and it must agree with the fixes that have shown which points move."""


@dataclass(frozen=True, slots=True, eq=False)
class ImuAssumption:
    """The IMU as a hypothesis uses it."""

    samples: ImuSamples | None
    """None = not used, or none was recorded."""
    choice: ImuChoice
    known: MotionState | None = None
    """State with the gain and the clock that an earlier walk has found; None = as the rig says."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Hypothesis:
    """What one walk over the recording assumes, and what it must show to be chosen."""

    because: Because
    imu: ImuAssumption
    hidden: HiddenPoints | None = None
    """Points on moving objects, which it does not see; None = it sees all."""
    aiding: GnssAiding | None = None
    """Fixes; None = there are none."""
    proof: Proof = Proof.NO_WORSE
    rival: Score | None = None
    """What it is compared with; None = the best so far."""
    doubted: ImuAssumption | None = None
    """The IMU that it does without."""
    suggested_by: Array | None = None
    """Positions of the walk that has shown which points move [m], (N, 3); None = no walk did."""

    def with_imu(self, imu: ImuAssumption) -> Hypothesis:
        """The same with an IMU of which gain and clock are known."""
        return replace(
            self,
            because=Because.IMU_FAULTS,
            imu=imu,
            proof=Proof.NO_WORSE,
            rival=None,
            suggested_by=None,
        )
