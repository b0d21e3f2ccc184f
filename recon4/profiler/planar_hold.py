"""What 2-D SLAM says of the motion between two knots while every line is refined.

A place that the profiler sees only once has no surface from another time: there the IMU alone would
drift by centimeters within seconds. The first trajectory knows the motion better, so its steps are
measurements too, as a random walk: a slow error of it is corrected by the surfaces at no cost.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import TRANSLATION, Array
from recon4.model.trajectory import Times, Trajectory
from recon4.model.tuning import OBSERVATION
from recon4.profiler.imu_chain import ImuChain, Information
from recon4.profiler.tuning_solve import PLANAR_HOLD
from recon4.registration.state_vector import END_POSE, START, VECTOR


@dataclass(frozen=True, slots=True, eq=False)
class PlanarHold:
    """Steps of the first trajectory from knot to knot, with their information."""

    step_m: Array
    """In the map [m], (K - 1, 3)."""
    weight: Array
    """Information of each step [1/m²], (K - 1, 3); 0 = not known."""

    @staticmethod
    def of(start: Trajectory, knot_ns: Times, known: NDArray[np.bool_]) -> PlanarHold:
        """Take the steps of a trajectory.

        Args:
            start: ``T_map_body``.
            knot_ns: Knots of the chain [ns], (K,).
            known: Whether 2-D SLAM observed the motion after each knot, (K - 1,).
        """
        slack_ns = 2 * int(knot_ns[1] - knot_ns[0])
        step_m = np.diff(start.at(knot_ns, slack_ns=slack_ns).t, axis=0)
        seconds = 1e-9 * np.diff(knot_ns)[:, None]
        return PlanarHold(step_m, known[:, None] / (np.array(PLANAR_HOLD.walk_m) ** 2 * seconds))

    def information(self, chain: ImuChain) -> Information:
        """Normal equations at the present states."""
        residual = np.diff(chain.vector[:, VECTOR.position], axis=0) - self.step_m
        found = Information.none(len(chain) - 1)
        start, end = (np.arange(12)[pose][TRANSLATION] for pose in (START, END_POSE))
        found.H[:, start, start] = found.H[:, end, end] = self.weight
        found.H[:, start, end] = found.H[:, end, start] = -self.weight
        found.g[:, start] = -self.weight * residual
        found.g[:, end] = self.weight * residual
        return found


def observed_motion(
    t_mid_ns: Times, knot_ns: Times, *, weak_sd_m: Array, lost: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Whether 2-D SLAM observed the motion after each knot, (K - 1,).

    Args:
        t_mid_ns: Middle of each multiframe [ns], (N,).
        knot_ns: Knots [ns], (K,).
        weak_sd_m: Standard deviation of the 2-D laser along its weakest direction [m], (N,); NaN =
            there is no 2-D laser.
        lost: Multiframes without a pose by it, (N,).
    """
    known = (weak_sd_m <= OBSERVATION.weak_sd_m) & ~lost  # NaN is not
    middle = knot_ns[:-1] + np.diff(knot_ns) // 2
    nearest = np.clip(np.searchsorted(t_mid_ns, middle), 1, len(t_mid_ns) - 1)
    nearest -= middle - t_mid_ns[nearest - 1] < t_mid_ns[nearest] - middle
    return np.asarray(known[nearest], np.bool_)
