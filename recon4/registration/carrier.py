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

_SPEED_SD_M_S = 1.5
"""Standard deviation of the speed of a carrier, each axis [m/s]."""
_SPEED_S = 10.0
"""Time over which a speed is forgotten [s]; it changes by 0.2 m/s in a tenth of a second."""
_LEAST_SD_M = 0.002
_TURN_SD_RAD_S = 2.0
"""Standard deviation of the turn rate of a carrier [rad/s]. A tunnel looks the same forward and
back: nothing else keeps a scan from being turned over."""
_LEAST_SD_RAD = 0.02
_HEAVY = 3.0
"""Distance in standard deviations from which a motion is implausible."""


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
        kept = float(np.exp(-seconds / _SPEED_S))
        sd_m = seconds * _SPEED_SD_M_S * float(np.sqrt(1.0 - kept**2))
        return CarrierPrior(
            seconds * kept * velocity_m_s,
            max(sd_m, _LEAST_SD_M),
            max(seconds * _TURN_SD_RAD_S, _LEAST_SD_RAD),
        )

    def plausibility(self, T_last_now: SE3) -> float:
        """1 = as expected, less the farther a pose lies from there or is turned; never 0."""
        shift = float(np.linalg.norm(T_last_now.t - self.t_m)) / self.sd_m
        turn = float(T_last_now.angle()) / self.sd_rad
        return 1.0 / float(np.linalg.norm([1.0, shift / _HEAVY, turn / _HEAVY]))
