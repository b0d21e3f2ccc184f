"""Prediction of the motion between two registrations: by IMU, or with constant velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_exp, so3_log
from recon4.kernels.imu import ROWS, middle_pose, propagate, samples_at, turned
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.registration.imu_saturation import saturated_samples
from recon4.registration.state_vector import STATE, VECTOR
from recon4.registration.tuning import OdometryTuning
from recon4.registration.tuning_imu import IMU_ERRORS, PREDICTION
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned
from recon4.units import STANDARD_GRAVITY_M_S2

_VECTOR_SIZE = ROWS.size - 3


@dataclass(frozen=True, slots=True, eq=False)
class MotionState:
    """Pose, velocity and sensor biases at one time, with the covariance of their error."""

    t_ns: int
    R: Array
    """``R_odom_body``, (3, 3)."""
    vector: Array
    """Position, velocity, gyro bias, accelerometer bias, gravity, gain of the gyroscope, clock of
    the IMU, all in SI, (25,)."""
    P: Array
    """Covariance of (rotation about odom axes, then as ``vector``), (28, 28)."""

    @property
    def T_odom_body(self) -> SE3:
        """The pose."""
        return SE3(self.R, self.vector[VECTOR.position])

    def at_pose(self, T_odom_body: SE3, *, sd_rad: float, sd_m: float) -> MotionState:
        """The same state at another pose, known with these standard deviations."""
        P = self.P.copy()
        P[STATE.pose, :] = P[:, STATE.pose] = 0.0
        P[STATE.pose, STATE.pose] = np.diag(np.repeat([sd_rad, sd_m], 3) ** 2)
        vector = self.vector.copy()
        vector[VECTOR.position] = T_odom_body.t
        return replace(self, R=T_odom_body.R, vector=vector, P=P)

    def moving(self, velocity: Array, sd_m_s: float) -> MotionState:
        """The same state with another velocity (3,), known with a standard deviation [m/s]."""
        vector, P = self.vector.copy(), self.P.copy()
        vector[VECTOR.velocity] = velocity
        P[STATE.velocity, :] = P[:, STATE.velocity] = 0.0
        P[STATE.velocity, STATE.velocity] = sd_m_s**2 * np.eye(3)
        return replace(self, vector=vector, P=P)

    def with_biases(self, vector: Array, cov: Array) -> MotionState:
        """The same motion with another `StateIndex.calibration` (19,) and its covariance."""
        P = self.P.copy()
        P[STATE.calibration, :] = P[:, STATE.calibration] = 0.0
        P[STATE.calibration, STATE.calibration] = cov
        whole = self.vector.copy()
        whole[VECTOR.calibration] = vector
        return replace(self, vector=whole, P=P)

    def corrected(self, delta: Array, P: Array) -> MotionState:
        """The state moved by an error (28,), with a new covariance."""
        R = turned(delta[STATE.rotation], self.R)
        return replace(self, R=R, vector=self.vector + delta[STATE.position.start :], P=P)


class Rest(Enum):
    """What an IMU says of a body that may stand."""

    MOVING = auto()
    STOPPED = auto()
    """It is still, and only a velocity that nothing observes says otherwise."""
    STATIONARY = auto()


@dataclass(frozen=True, slots=True, eq=False)
class Prediction:
    """Predicted motion over one frame, before the LiDAR is used."""

    t_s: Array
    """Times after the start of the frame [s], from 0 to its end, (K,)."""
    T_odom_body: SE3
    """Poses at these times, a batch of K."""
    end: MotionState
    prior: Array
    """Covariance of the pose error at the start (6) and the state's error at the end (28)."""
    expected: SE3 | None = None
    """Pose at the middle of the frame by registration to the last scan; None = not known."""


class ImuMotion:
    """Motion predicted by an IMU, rotated into the body."""

    def __init__(self, imu: ImuSamples, rig: Rig, settings: OdometrySettings) -> None:
        self._rig = rig
        self._t_ns = imu.t_ns
        self._gyro, self._accel = imu_in_body(imu, rig)
        self._saturated = saturated_samples(imu)
        self._has_accel = bool(np.isfinite(self._accel).all())
        s = tuned(OdometryTuning, settings)
        walks = (
            PREDICTION.gain_walk if s.gyro_gain_sd else 0.0,
            PREDICTION.clock_walk_s if s.imu_clock_sd_s else 0.0,
        )
        self._noise = np.array(
            [s.gyro_noise, s.accel_noise, s.gyro_bias_walk, s.accel_bias_walk, *walks]
        )
        if not self._has_accel:
            self._noise[1] = s.free_accel
        self._unit = np.zeros(10)
        self._unit_cov = np.diag(np.repeat([s.gyro_gain_sd, s.imu_clock_sd_s], [9, 1]) ** 2)
        self._is_estimated = np.diag(self._unit_cov) > 0.0

    def remember(self, state: MotionState, *, of_walk: bool = False) -> None:
        """Begin later initial states with what this one knows of gain and clock.

        What is far beyond the expected was found with a trajectory that it had bent: some of it is
        left. A gain that a whole walk has found with a wrong clock is found again: turns that come
        late look like turns about another axis.
        """
        found, cov = state.vector[VECTOR.unit].copy(), state.P[STATE.unit, STATE.unit].copy()
        less = np.repeat([PREDICTION.less_sure_gain, PREDICTION.less_sure_clock_s], [9, 1])
        beyond = np.abs(found - self._unit)
        usual = beyond < PREDICTION.beyond_sd * np.sqrt(np.diag(self._unit_cov))
        less = np.maximum(less, PREDICTION.left_ratio * np.where(usual, 0.0, beyond))
        if of_walk and beyond[-1] > IMU_ERRORS.most_clock_s:  # the last one is the clock
            gain = np.flatnonzero(usual[:-1])
            found[gain] = self._unit[gain]
            cov[gain, :] = cov[:, gain] = 0.0
            cov[gain, gain] = np.diag(self._unit_cov)[gain]
        self._unit, self._unit_cov = found, cov + np.diag(self._is_estimated * less**2)

    def extend(self, imu: ImuSamples) -> None:
        """Append newer samples of a live capture; drop samples older than a minute."""
        gyro, accel = imu_in_body(imu, self._rig)
        kept = self._t_ns > imu.t_ns[-1] - PREDICTION.kept_ns
        self._t_ns = np.concatenate([self._t_ns[kept], imu.t_ns])
        self._gyro = np.concatenate([self._gyro[kept], gyro])
        self._accel = np.concatenate([self._accel[kept], accel])
        self._saturated = np.concatenate([self._saturated[kept], saturated_samples(imu)])

    def covers(self, start_ns: int, end_ns: int) -> bool:
        """Whether there are samples over a whole time span, without a gap of more than 50 ms."""
        first, last = np.searchsorted(self._t_ns, [start_ns, end_ns])
        first, last = max(first - 1, 0), min(last, len(self._t_ns) - 1)
        times = self._t_ns[first : last + 1]
        outside = start_ns < times[0] - 50_000_000 or end_ns > times[-1] + 50_000_000
        return len(times) > 1 and not outside and bool(np.diff(times).max() <= 50_000_000)

    def rest(self, state: MotionState, *, weak: bool) -> Rest:
        """Whether the body stands, by the samples of the last half second and the velocity.

        A cart that rolls evenly shakes as little as a person who stands: the velocity decides.
        Where nothing observes it, a body that shook like a walker's before has stopped.

        Args:
            state: Predicted.
            weak: Whether the LiDARs hardly observe the motion.
        """
        if not self._has_accel or not self._is_still(state):
            return Rest.MOVING
        speed = np.linalg.norm(state.vector[VECTOR.velocity])
        speed_sd = np.sqrt(np.trace(state.P[STATE.velocity, STATE.velocity]))
        slow = speed < PREDICTION.rest_m_s + 3.0 * min(speed_sd, PREDICTION.rest_m_s)
        if slow and self._keeps_speed(state.t_ns):
            return Rest.STATIONARY
        walked = self._shakes(state.t_ns, PREDICTION.walked_ns) > PREDICTION.walk_m_s2
        stopped = weak and walked and self._acceleration(state) < PREDICTION.stopped_m_s2
        return Rest.STOPPED if stopped else Rest.MOVING

    def _acceleration(self, state: MotionState) -> float:
        """Mean of the last half second by the accelerometer as it is [m/s²].

        Where the motion is not observed its estimated bias may be as wrong as the velocity.
        """
        force = self._accel[self._before(state.t_ns, PREDICTION.rest_ns)].mean(axis=0)
        return float(np.linalg.norm(state.R @ force + state.vector[VECTOR.gravity]))

    def _is_still(self, state: MotionState) -> bool:
        rows = self._before(state.t_ns, PREDICTION.rest_ns)
        turn = self._gyro[rows] - state.vector[VECTOR.gyro_bias]
        return bool(
            len(turn) >= PREDICTION.min_rest_samples
            and np.abs(turn).max() < PREDICTION.rest_rad_s
            and self._shakes(state.t_ns, PREDICTION.rest_ns) < PREDICTION.rest_m_s2
        )

    def _shakes(self, t_ns: int, span_ns: int) -> float:
        """Standard deviation of the specific force over a time span [m/s²]."""
        return float(np.linalg.norm(self._accel[self._before(t_ns, span_ns)].std(axis=0)))

    def _keeps_speed(self, t_ns: int) -> bool:
        """Whether the speed of the last half second stays the same, but for the noise.

        Who begins to walk shakes little at first: 1 to 2 cm/s within three multiframes, always to
        the same side. Where no LiDAR observes that direction, that error of the velocity stays for
        the rest of the walk.
        """
        rows = self._before(t_ns, PREDICTION.rest_ns)
        force, dt_s = self._accel[rows], np.diff(self._t_ns[rows])[:, None] * 1e-9
        steps = (force[1:] + force[:-1] - 2.0 * force.mean(axis=0)) * dt_s / 2.0
        change = np.linalg.norm(np.ptp(np.cumsum(steps, axis=0), axis=0))
        noise_sd = np.linalg.norm(np.diff(force, axis=0).std(axis=0)) / np.sqrt(2.0)
        noise = noise_sd * float(dt_s.mean()) * np.sqrt(len(dt_s))
        return bool(change < np.hypot(PREDICTION.rest_change_m_s, 3.0 * noise))

    def _before(self, t_ns: int, span_ns: int) -> slice:
        return slice(*np.searchsorted(self._t_ns, [t_ns - span_ns, t_ns + 1]).tolist())

    def initial(self, t_ns: int) -> MotionState:
        """Initial state at ``t_ns``: roll and pitch from the mean specific force."""
        away_ns = np.abs(self._t_ns - t_ns)
        near = away_ns <= max(PREDICTION.rest_ns, int(away_ns.min()))
        up_body = self._accel[near].mean(axis=0) if self._has_accel else np.array([0, 0, 1.0])
        sd = _start_sd([1e-4, 1e-4, 1.0, 0.02, 0.2, 0.3])
        if not self._has_accel:
            sd[STATE.accel_bias] = sd[STATE.gravity] = 1e-9
        vector = np.zeros(_VECTOR_SIZE)
        vector[VECTOR.unit] = self._unit
        if self._has_accel:
            vector[VECTOR.gravity] = [0.0, 0.0, -STANDARD_GRAVITY_M_S2]
        P = np.diag(sd**2)
        P[STATE.unit, STATE.unit] = self._unit_cov
        return MotionState(t_ns, level_rotation(up_body), vector, P)

    def turn(self, start_ns: int, end_ns: int) -> Array:
        """Rotation from the body at one time to the body at another by the gyroscope, (3, 3)."""
        state = MotionState(
            start_ns, np.eye(3), np.zeros(_VECTOR_SIZE), np.zeros((ROWS.size, ROWS.size))
        )
        return self.predict(state, end_ns).end.R

    def predict(self, state: MotionState, end_ns: int) -> Prediction:
        """Integrate the IMU samples from the state's time to ``end_ns``."""
        first, last = np.searchsorted(self._t_ns, [state.t_ns + 1, end_ns])
        times = np.concatenate([[state.t_ns], self._t_ns[first:last], [end_ns]])
        ahead_s = np.clip(
            state.vector[VECTOR.clock][0], -PREDICTION.most_clock_s, PREDICTION.most_clock_s
        )
        stamps = times + round(1e9 * float(ahead_s))
        gyro, accel = (samples_at(stamps, self._t_ns, v) for v in (self._gyro, self._accel))
        if not self._has_accel:
            accel = np.zeros_like(gyro)
        noise = self._noise.copy()
        first, last = np.searchsorted(self._t_ns, stamps[[0, -1]])
        saturated = self._saturated[max(first - 1, 0) : last + 1].any(axis=0)
        noise[:2] = np.where(
            saturated, np.maximum(noise[:2], PREDICTION.saturated_noise), noise[:2]
        )
        return _predict(state, times, gyro, accel=accel, noise=noise)


class FreeMotion:
    """Constant velocity and constant turn rate, when there is no IMU.

    The same filter with sensors that read 0: the gyroscope bias is then the negative turn rate.
    """

    def __init__(self, settings: OdometrySettings) -> None:
        free = tuned(OdometryTuning, settings)
        self._noise = np.array([1e-3, free.free_accel, free.free_turn_walk, 1e-9, 0, 0])

    def covers(self, start_ns: int, end_ns: int) -> bool:
        """Whether the span is not empty: this model needs no samples."""
        return end_ns > start_ns

    def initial(self, t_ns: int) -> MotionState:
        """State at rest at the origin, with a large covariance."""
        sd = _start_sd([1e-4, 1e-4, 1.0, 0.5, 1e-9, 1e-9])
        return MotionState(t_ns, np.eye(3), np.zeros(_VECTOR_SIZE), np.diag(sd**2))

    def between(self, T_odom_body: SE3, t_ns: tuple[int, int], start_ns: int) -> MotionState:
        """State at ``start_ns`` of a motion of constant velocity through two poses (batch of 2)."""
        span_s = (t_ns[1] - t_ns[0]) * 1e-9
        velocity = (T_odom_body.t[1] - T_odom_body.t[0]) / span_s
        turn_rate = so3_log(T_odom_body.R[0].T @ T_odom_body.R[1]) / span_s
        back_s = (t_ns[1] - start_ns) * 1e-9
        vector = np.zeros(_VECTOR_SIZE)
        vector[VECTOR.position] = T_odom_body.t[1] - back_s * velocity
        vector[VECTOR.velocity], vector[VECTOR.gyro_bias] = velocity, -turn_rate
        sd = _start_sd([*PREDICTION.free_sd, 1e-9, 1e-9])
        R = T_odom_body.R[1] @ so3_exp(-back_s * turn_rate)
        return MotionState(start_ns, R, vector, np.diag(sd**2))

    def coasting(self, state: MotionState) -> MotionState:
        """State without IMU after a gap began: no gravity, no biases, the turn rate unknown."""
        sd = _start_sd([*PREDICTION.free_sd, 1e-9, 1e-9])[STATE.calibration]
        return state.with_biases(np.zeros(len(sd)), np.diag(sd**2))

    def rest(self, state: MotionState, *, weak: bool) -> Rest:
        """Nothing is known of it without an IMU: registration decides (`zero_velocity`)."""
        return Rest.MOVING

    def at_rest(self, state: MotionState, t_ns: int) -> MotionState:
        """Stationary state at ``t_ns`` at the last position, because the motion is unknown."""
        vector = np.zeros(_VECTOR_SIZE)
        vector[VECTOR.position] = state.vector[VECTOR.position]
        return replace(self.initial(t_ns), R=state.R, vector=vector)

    def predict(self, state: MotionState, end_ns: int) -> Prediction:
        """Continue with constant velocity until ``end_ns``."""
        slots = max(2, round((end_ns - state.t_ns) * 1e-9 / PREDICTION.slot_s) + 1)
        times = np.linspace(state.t_ns, end_ns, slots).astype(np.int64)
        silent = np.zeros((slots, 3))
        return _predict(state, times, silent, accel=silent, noise=self._noise)


def _predict(
    state: MotionState, t_ns: Times, gyro: Array, *, accel: Array, noise: Array
) -> Prediction:
    t_s = (t_ns - t_ns[0]) * 1e-9
    start = np.ascontiguousarray(state.P)  # a kernel is compiled for each layout
    R, p, v, Phi, P = propagate(t_s, gyro, accel, state.R, state.vector, start, noise)
    vector = state.vector.copy()
    vector[VECTOR.position], vector[VECTOR.velocity] = p[-1], v
    cross = state.P[STATE.pose] @ Phi.T
    prior = np.empty((6 + len(P), 6 + len(P)))
    prior[:6, :6], prior[:6, 6:] = state.P[STATE.pose, STATE.pose], cross
    prior[6:, :6], prior[6:, 6:] = cross.T, P
    return Prediction(t_s, SE3(R, p), MotionState(int(t_ns[-1]), R[-1], vector, P), prior)


def _start_sd(first: Sequence[float]) -> Array:
    """Standard deviations of a state without gain and clock, (28,), from those of the others."""
    sd = np.full(ROWS.size, 1e-9)
    sd[: 3 * len(first)] = np.repeat(first, 3)
    return sd


def middle_of(t_s: Array, T_a_b: SE3) -> SE3:
    """Pose halfway in time between the first and the last of dense poses."""
    return SE3(*middle_pose(t_s, T_a_b.R, T_a_b.t))


def imu_in_body(imu: ImuSamples, rig: Rig) -> tuple[Array, Array]:
    """Turn rate and specific force at the body's origin, in body axes."""
    R_body_imu, r = rig.T_body_imu.R, rig.T_body_imu.t
    gyro, accel = imu.gyro_rad_s @ R_body_imu.T, imu.accel_m_s2 @ R_body_imu.T
    if np.linalg.norm(r) > 1e-3 and len(imu) > 1:
        turn_accel = np.gradient(gyro, imu.t_ns * 1e-9, axis=0)
        accel = accel - np.cross(turn_accel, r) - np.cross(gyro, np.cross(gyro, r))
    return np.ascontiguousarray(gyro), np.ascontiguousarray(accel)


def level_rotation(up_body: Array) -> Array:
    """Rotation without heading that maps a direction of the body to the vertical."""
    up = up_body / np.linalg.norm(up_body)
    axis = np.cross(up, [0.0, 0.0, 1.0])
    sine = np.linalg.norm(axis)
    if sine < 1e-9:
        return np.eye(3) if up[2] > 0 else so3_exp([np.pi, 0.0, 0.0])
    return so3_exp(axis / sine * np.arctan2(sine, up[2]))
