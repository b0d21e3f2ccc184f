"""A chain of states at equal times, joined by IMU samples and solved for all at once.

The states are knots of the trajectory: pose, velocity and biases. Between two knots the IMU
determines the motion (preintegration), with its covariance. Measurements add information about the
poses of knots. One Gauss-Newton step solves a banded system: its work grows with the time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from recon4.errors import GraphError
from recon4.geometry.se3 import SE3, Array, proper, so3_exp, so3_log
from recon4.kernels.imu import samples_at
from recon4.kernels.imu_chain import SIZE, level_by_gravity, linearize_chain
from recon4.locales.coded import CodedText
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.tuning_solve import IMU_CHAIN
from recon4.registration.motion import imu_in_body, level_rotation
from recon4.registration.tuning import OdometryTuning
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned
from recon4.units import STANDARD_GRAVITY_M_S2

ROTATION, POSITION, VELOCITY = slice(0, 3), slice(3, 6), slice(6, 9)
GYRO_BIAS, ACCEL_BIAS = slice(9, 12), slice(12, 15)
"""Rows of the error state of a knot (15,); rotations are about the map's axes."""
POSE = slice(0, 6)


@dataclass(frozen=True, slots=True, eq=False)
class Information:
    """What measurements say of the poses: normal equations of corrections."""

    H: Array
    """Of the poses at start and end of each interval, (K - 1, 12, 12)."""
    g: Array
    """Gradient, (K - 1, 12)."""

    @staticmethod
    def none(intervals: int) -> Information:
        """No measurement."""
        return Information(np.zeros((intervals, 12, 12)), np.zeros((intervals, 12)))

    def __add__(self, other: Information) -> Information:
        return Information(self.H + other.H, self.g + other.g)


@dataclass(frozen=True, slots=True, eq=False)
class Drive:
    """IMU samples at equal steps, the knots among them."""

    knot_ns: Times
    """Times of the knots [ns], equal steps, (K,)."""
    gyro: Array
    """In the body [rad/s], (G, 3)."""
    accel: Array
    """In the body [m/s²], (G, 3)."""
    noise: Array
    """Densities of gyroscope, accelerometer and the walks of their biases, (4,)."""
    gravity: Array
    """In the map [m/s²], (3,); zero without an IMU."""
    bias_sd: Array
    """Standard deviations of the biases, (6,)."""

    @property
    def step_s(self) -> float:
        """Time between two samples [s]."""
        return float(self.knot_ns[1] - self.knot_ns[0]) * 1e-9 / self.steps

    @property
    def steps(self) -> int:
        """Samples of an interval."""
        return (len(self.gyro) - 1) // (len(self.knot_ns) - 1)

    @property
    def has_imu(self) -> bool:
        """Whether there are samples; without them velocity and turn rate are free."""
        return bool(self.gravity.any())


def make_drive(
    imu: ImuSamples | None,
    rig: Rig,
    span_ns: tuple[int, int],
    *,
    knot_s: float,
    settings: OdometrySettings,
) -> Drive:
    """IMU samples in the body, resampled; without an IMU constant velocity and turn rate.

    Args:
        imu: Samples; None, or samples that leave holes, = motion without an IMU.
        rig: Mounting of the IMU.
        span_ns: First and last time that is needed [ns].
        knot_s: Time between two knots [s].
        settings: Noise of the IMU, and of a motion without one.
    """
    step_ns = round(knot_s * 1e9)
    count = max(2, -(-(span_ns[1] - span_ns[0]) // step_ns) + 1)
    knot_ns = span_ns[0] + step_ns * np.arange(count, dtype=np.int64)
    if imu is None or not covers(imu, span_ns):
        silent = np.zeros((count, 3))
        free = tuned(OdometryTuning, settings)
        noise = np.array([1e-3, free.free_accel, free.free_turn_walk, 1e-9])
        return Drive(knot_ns, silent, silent, noise, np.zeros(3), np.repeat([1.0, 1e-6], 3))
    gyro, accel = imu_in_body(imu, rig)
    usual_ns = float(np.median(np.diff(imu.t_ns)))
    steps = int(np.clip(round(step_ns / usual_ns), 1, 50))
    t_ns = span_ns[0] + (step_ns * np.arange((count - 1) * steps + 1, dtype=np.int64)) // steps
    s = tuned(OdometryTuning, settings)
    return Drive(
        knot_ns,
        samples_at(t_ns, imu.t_ns, gyro),
        samples_at(t_ns, imu.t_ns, accel),
        np.array([s.gyro_noise, s.accel_noise, s.gyro_bias_walk, s.accel_bias_walk]),
        np.array([0.0, 0.0, -STANDARD_GRAVITY_M_S2]),
        np.repeat([IMU_CHAIN.gyro_bias_sd, IMU_CHAIN.accel_bias_sd], 3),
    )


def covers(imu: ImuSamples, span_ns: tuple[int, int]) -> bool:
    """Whether accelerations and turn rates are there over a span, without a hole of 0.2 s."""
    if len(imu) < 2 or not np.isfinite(imu.accel_m_s2).all():
        return False
    first, last = np.searchsorted(imu.t_ns, span_ns)
    t_ns = imu.t_ns[max(int(first) - 1, 0) : int(last) + 1]
    if len(t_ns) < 2:
        return False
    outside = max(int(t_ns[0]) - span_ns[0], span_ns[1] - int(t_ns[-1]))
    return (
        outside <= IMU_CHAIN.longest_hole_ns
        and int(np.diff(t_ns).max()) <= IMU_CHAIN.longest_hole_ns
    )


@dataclass(frozen=True, slots=True, eq=False)
class ImuChain:
    """States of all knots."""

    drive: Drive
    R: Array
    """``R_map_body``, (K, 3, 3)."""
    vector: Array
    """Position, velocity, gyro bias, accelerometer bias, gravity, (K, 15)."""

    def __len__(self) -> int:
        return len(self.R)

    @property
    def knots(self) -> Trajectory:
        """``T_map_body`` at the knots."""
        return Trajectory(self.drive.knot_ns, SE3(self.R, self.vector[:, 0:3]))

    def moved(self, delta: Array) -> ImuChain:
        """The states corrected by error states, (K, 15)."""
        vector = self.vector.copy()
        vector[:, 0:12] += delta[:, 3:15]
        return replace(self, R=proper(so3_exp(delta[:, ROTATION]) @ self.R), vector=vector)

    def following(self, trajectory: Trajectory) -> ImuChain:
        """The states with the poses of a trajectory and its velocities."""
        slack_ns = int(self.drive.knot_ns[1] - self.drive.knot_ns[0]) * 2
        T = trajectory.at(self.drive.knot_ns, slack_ns=slack_ns)
        vector = self.vector.copy()
        vector[:, 0:3] = T.t
        knot_s = (self.drive.knot_ns - self.drive.knot_ns[0]) * 1e-9
        vector[:, 3:6] = np.gradient(T.t, knot_s, axis=0)
        return replace(self, R=T.R, vector=vector)


@dataclass(frozen=True, slots=True, eq=False)
class LinearizedChain:
    """The chain at its current states: how the knots differ from what the IMU predicts."""

    chain: ImuChain
    residual: Array
    """Knot minus prediction from the one before, (K - 1, 15)."""
    transition: Array
    """(K - 1, 15, 15)."""
    information: Array
    """Inverse covariance of the prediction, (K - 1, 15, 15)."""
    poses: SE3
    """``T_map_body`` at the samples of each interval by the IMU, (K - 1, M + 1)."""

    def trajectory(self) -> Trajectory:
        """Dense ``T_map_body`` at all samples of the IMU.

        Within an interval the IMU determines the motion; what it misses at the next knot is
        distributed linearly.
        """
        drive = self.chain.drive
        s = np.linspace(0.0, 1.0, drive.steps + 1)[:-1]
        turn = so3_exp(s[None, :, None] * self.residual[:, None, ROTATION])
        R = turn @ self.poses.R[:, :-1]
        p = self.poses.t[:, :-1] + s[None, :, None] * self.residual[:, None, POSITION]
        step_ns = int(drive.knot_ns[1] - drive.knot_ns[0])
        inner = (step_ns * np.arange(drive.steps, dtype=np.int64)) // drive.steps
        t_ns = (drive.knot_ns[:-1, None] + inner).ravel()
        last = self.chain.knots.T_a_b[-1]
        return Trajectory(
            np.append(t_ns, drive.knot_ns[-1]),
            SE3(
                proper(np.concatenate([R.reshape(-1, 3, 3), last.R[None]])),
                np.concatenate([p.reshape(-1, 3), last.t[None]]),
            ),
        )

    def solve(self, measured: Information, *, anchor: Array | None = None) -> Array:
        """One step of all states, (K, 15).

        Args:
            measured: What the measurements say of the poses.
            anchor: Information of a prior that keeps each pose where it is, (6,); None = the first
                position and heading are kept.

        Raises:
            GraphError: If the system cannot be solved.
        """
        knots = len(self.chain)
        diagonal, lower, gradient = self._priors()
        weighted = self.information @ self.transition
        diagonal[:-1] += np.swapaxes(self.transition, 1, 2) @ weighted
        diagonal[1:] += self.information
        lower -= weighted
        pull = np.einsum("kij,kj->ki", self.information, self.residual)
        gradient[:-1] -= np.einsum("kji,kj->ki", self.transition, pull)
        gradient[1:] += pull
        diagonal[:-1, POSE, POSE] += measured.H[:, 0:6, 0:6]
        diagonal[1:, POSE, POSE] += measured.H[:, 6:12, 6:12]
        lower[:, POSE, POSE] += measured.H[:, 6:12, 0:6]
        gradient[:-1, POSE] += measured.g[:, 0:6]
        gradient[1:, POSE] += measured.g[:, 6:12]
        if anchor is None:
            diagonal[0][[2, 3, 4, 5], [2, 3, 4, 5]] += 1e8
        else:
            diagonal[:, np.arange(6), np.arange(6)] += anchor
        try:
            step = solveh_banded(_lower_band(diagonal, lower), gradient.ravel(), lower=True)
        except LinAlgError as error:
            raise GraphError(CodedText("imu-chain", states=knots, why=str(error))) from error
        return -np.asarray(step, dtype=np.float64).reshape(knots, SIZE)

    def _priors(self) -> tuple[Array, Array, Array]:
        """Weak priors of velocities, and those of the biases at the first knot."""
        chain, knots = self.chain, len(self.chain)
        diagonal, lower = np.zeros((knots, SIZE, SIZE)), np.zeros((knots - 1, SIZE, SIZE))
        gradient = np.zeros((knots, SIZE))
        # Divided by the number of knots in a second, so that it does not depend on their step.
        weight = self.chain.drive.step_s * self.chain.drive.steps / IMU_CHAIN.velocity_sd**2
        rows = np.arange(6, 9)
        diagonal[:, rows, rows] += weight
        gradient[:, VELOCITY] += weight * chain.vector[:, 3:6]
        rows, weights = np.arange(9, 15), chain.drive.bias_sd**-2.0
        diagonal[0, rows, rows] += weights
        gradient[0, 9:15] += weights * chain.vector[0, 6:12]
        return diagonal, lower, gradient


def initial_chain(drive: Drive) -> ImuChain:
    """States at rest at the origin, with the attitude of gyroscope and gravity."""
    knots = len(drive.knot_ns)
    vector = np.zeros((knots, SIZE))
    vector[:, 12:15] = drive.gravity
    if not drive.has_imu:
        return ImuChain(drive, np.tile(np.eye(3), (knots, 1, 1)), vector)
    R = np.empty((len(drive.gyro), 3, 3))
    rest = max(1, round(IMU_CHAIN.rest_s / drive.step_s))
    R[0] = level_rotation(drive.accel[:rest].mean(axis=0))
    level_by_gravity(drive.gyro, drive.accel, drive.step_s, IMU_CHAIN.level_gain, R)
    return ImuChain(drive, proper(R[:: drive.steps]), vector)


def linearize(chain: ImuChain) -> LinearizedChain:
    """Compare every knot with the prediction of the IMU from the one before."""
    drive, intervals = chain.drive, len(chain) - 1
    residual, cov = np.empty((intervals, SIZE)), np.empty((intervals, SIZE, SIZE))
    transition = np.empty_like(cov)
    poses = SE3.identity(intervals, drive.steps + 1)
    linearize_chain(
        drive.gyro, drive.accel, drive.step_s, np.ascontiguousarray(chain.R), chain.vector,
        drive.noise, residual, transition, cov, poses.R, poses.t,
    )  # fmt: skip
    scale = 1.0 / np.sqrt(np.diagonal(cov, axis1=1, axis2=2) + 1e-24)
    correlation = scale[:, :, None] * cov * scale[:, None, :]
    information = np.asarray(np.linalg.inv(correlation + 1e-9 * np.eye(SIZE)), np.float64)
    information = scale[:, :, None] * information * scale[:, None, :]
    information = 0.5 * (information + np.swapaxes(information, 1, 2))
    return LinearizedChain(chain, residual, transition, information, poses)


def _lower_band(diagonal: Array, lower: Array) -> Array:
    """Block-tridiagonal matrix in the form of scipy: ``out[r - c, c]``, (2 S, S K)."""
    knots, size = len(diagonal), diagonal.shape[1]
    out = np.zeros((2 * size, size * knots))
    for row in range(size):
        for column in range(size):
            if row >= column:
                out[row - column, column::size] = diagonal[:, row, column]
            out[size + row - column, column : size * (knots - 1) : size] = lower[:, row, column]
    return out


def rotation_error(R_measured: Array, R: Array) -> Array:
    """Rotation about the map's axes from measured to estimated, (..., 3) [rad]."""
    return so3_log(R @ np.swapaxes(R_measured, -1, -2))
