"""What is known of a carrier's motion before any scan: a speed that changes little in a tenth of a
second, and in ten seconds becomes that of anybody on foot; a turn that is no somersault.

It is a prior, not a bound: where the LiDAR observes a direction to millimeters, it has no weight
and a car is as welcome. Along a tunnel nothing else says where the body is, and a registration
without it slides by meters from scan to scan.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.registration.tuning_motion import CARRIER


@dataclass(frozen=True, slots=True, eq=False)
class CarrierPrior:
    """Place of the body after a time, by its speed before."""

    t_m: Array
    """Expected place in the frame of the last pose [m], (3,)."""
    sd_m: float
    """Standard deviation along each axis [m]."""
    sd_rad: float
    """Standard deviation of the turn since the last pose [rad]."""

    @staticmethod
    def after(seconds: float, velocity_m_s: Array) -> CarrierPrior:
        """The place after some time.

        Args:
            seconds: Since the last pose.
            velocity_m_s: The last velocity, (3,).
        """
        kept = float(np.exp(-seconds / CARRIER.speed_s))
        sd_m = seconds * CARRIER.speed_sd_m_s * float(np.sqrt(1.0 - kept**2))
        return CarrierPrior(
            seconds * kept * velocity_m_s,
            max(sd_m, CARRIER.least_sd_m),
            max(seconds * CARRIER.turn_sd_rad_s, CARRIER.least_sd_rad),
        )

    def plausibility(self, T_last_now: SE3) -> float:
        """1 = as expected, less the farther a pose lies from there or is turned; never 0."""
        shift = float(np.linalg.norm(T_last_now.t - self.t_m)) / self.sd_m
        turn = float(T_last_now.angle()) / self.sd_rad
        return 1.0 / float(np.linalg.norm([1.0, shift / CARRIER.heavy, turn / CARRIER.heavy]))
