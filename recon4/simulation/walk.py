"""How a person walks: waypoints to a smooth motion that can be evaluated at any time.

Positions and angles are quintic splines, so velocities and accelerations are exact derivatives
and the IMU's samples integrate back to the poses.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.simulation import evaluate_polynomials
from recon4.simulation.rides import Ride


@dataclass(frozen=True, slots=True, eq=False)
class Walk:
    """A motion of the body in the map, four times continuously differentiable."""

    KNOT_S: ClassVar[float] = 0.02
    """Between two knots of the splines [s]."""

    seconds: float
    coefficients: Array
    """Of x, y, z [m], roll, pitch, yaw [rad] around the middles of 20 ms, (M, 6, 6)."""
    ride: Ride | None = None
    """Where the elevator is; None = there is none."""

    @staticmethod
    def through(samples: ArrayLike) -> Walk:
        """Interpolate x, y, z, roll, pitch, yaw given every 20 ms, (M + 1, 6)."""
        from scipy.interpolate import make_interp_spline

        values = np.asarray(samples, dtype=np.float64)
        t_s = Walk.KNOT_S * np.arange(len(values))
        spline = make_interp_spline(t_s, values, k=5)
        middles = t_s[:-1] + 0.5 * Walk.KNOT_S
        factorial = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0]
        terms = [spline(middles, nu=order) / factorial[order] for order in range(6)]
        return Walk(float(t_s[-1]), np.ascontiguousarray(np.stack(terms, axis=1)))

    def state(self, t_s: ArrayLike, derivative: int = 0) -> Array:
        """x, y, z [m], roll, pitch, yaw [rad] or a derivative of them, (N,) -> (N, 6)."""
        t = np.ascontiguousarray(np.atleast_1d(t_s), dtype=np.float64)
        out = np.empty((len(t), 6))
        evaluate_polynomials(self.coefficients, self.KNOT_S, t, derivative, out)
        return out

    def poses(self, t_s: ArrayLike) -> SE3:
        """``T_map_body`` at any times [s] since the start, (N,)."""
        state = self.state(t_s)
        return SE3(rotation(state[:, 3:]), state[:, :3])

    def angular_rate(self, t_s: ArrayLike) -> Array:
        """Angular rate of the body in the body [rad/s], (N,) -> (N, 3)."""
        roll, pitch, _ = self.state(t_s)[:, 3:].T
        d_roll, d_pitch, d_yaw = self.state(t_s, 1)[:, 3:].T
        return np.stack(
            [
                d_roll - d_yaw * np.sin(pitch),
                d_pitch * np.cos(roll) + d_yaw * np.sin(roll) * np.cos(pitch),
                -d_pitch * np.sin(roll) + d_yaw * np.cos(roll) * np.cos(pitch),
            ],
            axis=1,
        )

    def acceleration(self, t_s: ArrayLike) -> Array:
        """Acceleration of the body's origin in the map [m/s²], (N,) -> (N, 3)."""
        return self.state(t_s, 2)[:, :3]


def rotation(rpy: Array) -> Array:
    """``Rz(yaw) Ry(pitch) Rx(roll)``, (N, 3) -> (N, 3, 3)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy).T, np.sin(rpy).T
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
