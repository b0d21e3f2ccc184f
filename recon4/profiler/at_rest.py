"""Times at which the IMU feels no motion, where nothing else observes the motion.

Without a 2-D laser the first trajectory is the integral of the IMU: its position drifts by meters
in seconds. A scanner on a tripod or on a robot that waits feels neither turns nor accelerations.
Who walks, or stands and holds the scanner, is felt.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from recon4.geometry.se3 import Array
from recon4.profiler.imu_chain import POSITION, Drive, ImuChain, Information, rotation_error
from recon4.profiler.tuning_solve import AT_REST


@dataclass(frozen=True, slots=True, eq=False)
class AtRest:
    """Intervals between knots without motion."""

    still: NDArray[np.bool_]
    """(K - 1,)."""
    step_s: float
    """Time between two knots [s]."""

    @staticmethod
    def of(drive: Drive) -> AtRest:
        """Find the intervals in which the IMU feels no motion; none without an IMU."""
        step_s = drive.step_s * drive.steps
        intervals = len(drive.knot_ns) - 1
        if not drive.has_imu:
            return AtRest(np.zeros(intervals, np.bool_), step_s)
        window = max(3, round(AT_REST.window_s / drive.step_s))
        calm = (_spread(drive.gyro, window) < AT_REST.turn_rad_s) & (
            _spread(drive.accel, window) < AT_REST.accel_m_s2
        )
        inside = calm[: intervals * drive.steps].reshape(intervals, drive.steps)
        return AtRest(np.asarray(inside.all(axis=1), np.bool_), step_s)

    def information(self, chain: ImuChain) -> Information:
        """Normal equations of poses that stay the same from knot to knot."""
        found = Information.none(len(chain) - 1)
        turned = rotation_error(chain.R[:-1], chain.R[1:])
        moved = np.diff(chain.vector[:, 0:3], axis=0)
        walk = np.repeat([AT_REST.walk_rad, AT_REST.walk_m], 3)
        weight = self.still[:, None] / (walk**2 * self.step_s)
        residual = np.concatenate([turned, moved], axis=1)
        start = np.arange(12)[: POSITION.stop]
        end = start + POSITION.stop
        found.H[:, start, start] = found.H[:, end, end] = weight
        found.H[:, start, end] = found.H[:, end, start] = -weight
        found.g[:, start], found.g[:, end] = -weight * residual, weight * residual
        return found


def _spread(values: Array, window: int) -> Array:
    """Standard deviation over a window around each sample, over all axes, (G, 3) -> (G,)."""
    mean = uniform_filter1d(values, window, axis=0, mode="nearest")
    square = uniform_filter1d((values - values.mean(axis=0)) ** 2, window, axis=0, mode="nearest")
    variance = square - (mean - values.mean(axis=0)) ** 2
    return np.asarray(np.sqrt(np.maximum(variance.sum(axis=1), 0.0)), np.float64)
