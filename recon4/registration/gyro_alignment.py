"""Rotation, clock and scale of an IMU from its turn rates against those of the LiDARs.

A first estimate from any start: axes that are swapped, an IMU upside down, a wrong unit, a clock
that is off by tenths of a second (requirements A2; closed form of Arun 1987 for each clock offset).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array, so3_log
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.imu_saturation import saturated_samples
from recon4.registration.tuning_imu import GYRO_ALIGNMENT

_CLOCKS_S = np.arange(
    -GYRO_ALIGNMENT.largest_clock_s, GYRO_ALIGNMENT.largest_clock_s, GYRO_ALIGNMENT.clock_step_s
)


@dataclass(frozen=True, slots=True, kw_only=True)
class GyroAlignment:
    """How turn rates of an IMU fit those of a trajectory."""

    R_body_imu: Array
    """(3, 3)."""
    clock_s: float
    """To be added to the IMU's time stamps [s]."""
    scale: float
    """Of the gyroscope: its readings are this many times too large."""
    explained: float
    """Part of the turning of the trajectory that the IMU explains, 0..1."""
    mirrored: bool
    """Whether left-handed axes explain it clearly better."""


@dataclass(frozen=True, slots=True, eq=False)
class ComparedTurns:
    """Turns of a trajectory beside those of a gyroscope, for any clock offset."""

    of_body: Array
    """From one time to the next, without their mean [rad], (N, 3)."""
    _t_s: Array
    _measured: NDArray[np.bool_]
    _imu_s: Array
    _turned: Array

    def of_imu(self, clock_s: float) -> Array:
        """Of the gyroscope, without their mean: its bias [rad], (N, 3)."""
        turned = _interpolated(self._t_s - clock_s, self._imu_s, self._turned)
        return _centered(np.diff(turned, axis=0)[self._measured])

    def aligned(self, *, left_handed: bool = False) -> GyroAlignment:
        """Rotation and clock that explain the most; of left-handed axes, a rotated reflection."""
        det = -1.0 if left_handed else 1.0
        fits = [_fit(self.of_body, self.of_imu(clock), det) for clock in _CLOCKS_S]
        explained = np.array([fit[1] for fit in fits])
        best = int(np.argmax(explained))
        R_body_imu, _, scale, mirrored = fits[best]
        return GyroAlignment(
            R_body_imu=R_body_imu,
            clock_s=float(_CLOCKS_S[best]) + _vertex(explained, best) * GYRO_ALIGNMENT.clock_step_s,
            scale=scale,
            explained=float(explained[best]),
            mirrored=mirrored,
        )

    def explained_by(self, R_body_imu: Array) -> float:
        """Part of the turning that a rotation explains with its best clock, up to 1."""
        turns = ((self.of_body, self.of_imu(clock) @ R_body_imu.T) for clock in _CLOCKS_S)
        return max(_squared_correlation(a, b) for a, b in turns)

    def log_likelihood_ratio(self, explained: float, simpler: float) -> float:
        """Of turns that are explained so far, against a simpler hypothesis that explains less.

        Twice its logarithm: beside errors of one size it is chi-square distributed.
        """
        return _log_ratio(self.of_body.size, explained, simpler)

    def rotation_sd_rad(self, explained: float) -> float:
        """Standard deviation of a rotation that explains so much, about its vaguest axis [rad]."""
        squares = np.linalg.eigvalsh(self.of_body.T @ self.of_body)
        left = (1.0 - explained) * float(squares.sum()) / self.of_body.size
        return float(np.sqrt(left / max(squares[0] + squares[1], 1e-12)))


def compare_turns(trajectory: Trajectory, t_ns: Times, imu: ImuSamples) -> ComparedTurns | None:
    """Turns of a trajectory beside those of a gyroscope.

    Args:
        trajectory: ``T_odom_body``.
        t_ns: Times between which turns are compared, as the middles of multiframes [ns], (N,).
        imu: Samples in the frame of the IMU.

    Returns:
        None with too few samples, or where the body hardly turns.
    """
    # Without the ends every clock offset compares the same intervals.
    margin_ns = int(GYRO_ALIGNMENT.largest_clock_s * 1e9)
    inside = (t_ns > imu.t_ns[0] + margin_ns) & (t_ns < imu.t_ns[-1] - margin_ns)
    t_ns = t_ns[inside]
    if len(t_ns) <= GYRO_ALIGNMENT.min_intervals:
        return None
    measured = ~_saturated(t_ns, imu)
    if measured.sum() < GYRO_ALIGNMENT.min_intervals:
        return None
    R = trajectory.at(t_ns, slack_ns=margin_ns).R
    of_body = _centered(so3_log(np.swapaxes(R[:-1], -1, -2) @ R[1:])[measured])
    t_s, imu_s = (t_ns - t_ns[0]) * 1e-9, (imu.t_ns - t_ns[0]) * 1e-9
    if np.sqrt(np.mean(of_body**2)) < GYRO_ALIGNMENT.min_rate_rad_s * np.median(np.diff(t_s)):
        return None
    return ComparedTurns(of_body, t_s, measured, imu_s, _integral(imu_s, imu.gyro_rad_s))


def align_gyro(trajectory: Trajectory, t_ns: Times, imu: ImuSamples) -> GyroAlignment | None:
    """Rotation and clock that make the turn rates of an IMU fit a trajectory, if it turns."""
    turns = compare_turns(trajectory, t_ns, imu)
    return None if turns is None else turns.aligned()


def for_other_axes(of_body: Array, of_imu: Array) -> float:
    """What speaks for a rotation of the gyroscope: see `ComparedTurns.log_likelihood_ratio`.

    Args:
        of_body: Turns of the body [rad], (N, 3).
        of_imu: The same as the gyroscope measures them by its rig.
    """
    _, explained, _, _ = _fit(of_body, of_imu, 1.0)
    return _log_ratio(of_body.size, explained, _squared_correlation(of_body, of_imu))


def _log_ratio(count: int, explained: float, simpler: float) -> float:
    left, left_simpler = (max(1.0 - part, 1e-12) for part in (explained, simpler))
    return count * float(np.log(left_simpler / left))


def _saturated(t_ns: Times, imu: ImuSamples) -> NDArray[np.bool_]:
    """Intervals in which the gyroscope misses a part of the turn, (N - 1,)."""
    rows = np.flatnonzero(saturated_samples(imu)[:, 0])
    found = np.zeros(len(t_ns) - 1, np.bool_)
    # With one more on either side: the clock may be off.
    near = np.searchsorted(t_ns, imu.t_ns[rows])[:, None] - 1 + np.array([-1, 0, 1])
    found[np.clip(near, 0, len(found) - 1)] = True
    return found


def _fit(of_body: Array, of_imu: Array, det: float) -> tuple[Array, float, float, bool]:
    """Rotation or reflection, explained part, scale and handedness for one clock offset."""
    U, singular, Vt = np.linalg.svd(of_body.T @ of_imu)
    sign = det * float(np.sign(np.linalg.det(U @ Vt)))
    proper = singular * np.array([1.0, 1.0, sign])
    energy, energy_imu = float(np.sum(of_body**2)), float(np.sum(of_imu**2))
    explained = float(proper.sum()) ** 2 / max(energy * energy_imu, 1e-12)
    any_handed = float(singular.sum()) ** 2 / max(energy * energy_imu, 1e-12)
    mirrored = (
        sign < 0 and any_handed > GYRO_ALIGNMENT.sure and 1.0 - any_handed < 0.5 * (1.0 - explained)
    )
    scale = energy_imu / max(float(proper.sum()), 1e-12)
    return U @ np.diag([1.0, 1.0, sign]) @ Vt, explained, scale, mirrored


def _squared_correlation(a: Array, b: Array) -> float:
    """Of vectors (N, 3), with the sign of their correlation, -1..1."""
    both = float((a * b).sum())
    return both * abs(both) / max(float((a**2).sum() * (b**2).sum()), 1e-12)


def _centered(values: Array) -> Array:
    """Without the mean: the bias of the gyroscope."""
    return values - values.mean(axis=0)


def _integral(t_s: Array, rate: Array) -> Array:
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(t_s)[:, None]
    return np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])


def _interpolated(t_s: Array, known_s: Array, values: Array) -> Array:
    return np.stack([np.interp(t_s, known_s, values[:, axis]) for axis in range(3)], axis=1)


def _vertex(values: Array, best: int) -> float:
    """Where a parabola through the largest value and its neighbors is highest, -0.5..0.5."""
    if not 0 < best < len(values) - 1:
        return 0.0
    left, middle, right = values[best - 1 : best + 2]
    curvature = left - 2.0 * middle + right
    return float(0.5 * (left - right) / curvature) if curvature < 0.0 else 0.0
