"""What is known of a carrier's motion before any scan: a speed that changes little in a tenth of a
second, and in ten seconds becomes that of anybody on foot.

It is a prior, not a bound: where the LiDAR observes a direction to millimeters, it has no weight
and a car is as welcome. Along a tunnel nothing else says where the body is, and a registration
without it slides by meters from scan to scan.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array

_SPEED_SD_M_S = 1.5
"""Standard deviation of the speed of a carrier, each axis [m/s]."""
_SPEED_S = 10.0
"""Time over which a speed is forgotten [s]; it changes by 0.2 m/s in a tenth of a second."""
_LEAST_SD_M = 0.002
_HEAVY = 3.0
"""Distance in standard deviations from which a motion is implausible."""


@dataclass(frozen=True, slots=True, eq=False)
class CarrierPrior:
    """Place of the body after a time, by its speed before."""

    t_m: Array
    """Expected place in the frame of the last pose [m], (3,)."""
    sd_m: float
    """Standard deviation along each axis [m]."""

    @staticmethod
    def after(seconds: float, velocity_m_s: Array) -> CarrierPrior:
        """The place after some time.

        Args:
            seconds: Since the last pose.
            velocity_m_s: The last velocity, (3,).
        """
        kept = float(np.exp(-seconds / _SPEED_S))
        sd_m = seconds * _SPEED_SD_M_S * float(np.sqrt(1.0 - kept**2))
        return CarrierPrior(seconds * kept * velocity_m_s, max(sd_m, _LEAST_SD_M))

    def plausibility(self, t_m: Array) -> float:
        """1 = as expected, less the farther a place (3,) lies from there; never 0."""
        z = float(np.linalg.norm(t_m - self.t_m)) / self.sd_m
        return 1.0 / float(np.hypot(1.0, z / _HEAVY))
