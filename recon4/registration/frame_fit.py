"""Registration of one frame to the plane map: the iterations of the error-state filter."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from recon4.geometry.se3 import ROTATION, SE3, Array, so3_exp, so3_log, tangent_size_m
from recon4.kernels.frame_fit import corrected_poses
from recon4.kernels.imu import place_points
from recon4.registration.aiding import GnssAiding
from recon4.registration.degeneracy import observable_directions, of_rigid_pose
from recon4.registration.motion import Prediction, Rest, middle_of
from recon4.registration.plane_map import Match, PlaneMap
from recon4.registration.point_map import WeakDirections
from recon4.registration.segments import NO_SEGMENTS, Segments
from recon4.registration.state_vector import (
    END,
    END_POSE,
    END_VELOCITY,
    POSES,
    START,
    STATE,
    VECTOR,
)
from recon4.registration.tuning import OdometryTuning
from recon4.registration.tuning_matching import FRAME_FIT
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned

_MIDDLE: Array = np.zeros((6, END.stop))
"""A correction of the pose at the middle of a frame, by those at its start and end."""
_MIDDLE[:, START] = _MIDDLE[:, END_POSE] = 0.5 * np.eye(6)
_AT_REST = {
    Rest.STATIONARY: np.array([0.02, 0.02, 0.005]) ** -2.0,
    Rest.STOPPED: np.array([0.1, 0.1, np.inf]) ** -2.0,
}
"""Information on the velocity of a person who stands [s²/m²], odom axes. One sways sideways by
1 cm/s and hardly up or down: with 2 cm/s a second of standing knew gravity to 30 mm/s² only. Who
has just stopped still sways more; the ground observes the height."""


@dataclass(frozen=True, eq=False)
class FrameFit:
    """Result of the registration of one frame."""

    T_dense: SE3
    delta: Array
    """Correction of the pose at the start (6) and of the state at the end (28)."""
    P: Array
    """Covariance of that correction, (34, 34)."""
    H_lidar: Array
    """Information of the points alone about the poses at start and end, (12, 12)."""
    match: Match
    rounds: int
    converged: bool
    stationary: bool
    """Whether the body was known to stand at the end of the frame."""
    with_imu: bool

    @property
    def is_weak(self) -> bool:
        """Whether the points hardly observe a direction."""
        return self.weak_sd_m > FRAME_FIT.weak_sd_m

    @cached_property
    def weak_sd_m(self) -> float:
        """Standard deviation along the weak direction by the points [m], at most 100 m.

        A gyroscope knows the turn: on spiral stairs it tells a turn from a rise.
        """
        H6 = of_rigid_pose(self.H_lidar)
        if self.with_imu:
            H6[ROTATION, ROTATION] += np.eye(3) / FRAME_FIT.gyroscope_sd_rad**2
        direction = np.zeros(6)
        direction[STATE.position] = self.match.weak_direction
        return float(np.sqrt(direction @ np.linalg.solve(H6 + 1e-4 * np.eye(6), direction)))


@dataclass(frozen=True, eq=False)
class FrameFitter:
    """Fits frames to the plane map with the same bounds and weights."""

    settings: OdometrySettings
    converged_step_m: float
    coarse: int
    """First level of cubes, 0 = the finest. Larger cubes allow a larger prediction error."""
    rounds: int
    """Upper bound on match-and-solve rounds."""
    with_imu: bool = True
    """Whether an IMU predicts the motion, with a velocity that adds up its errors."""
    aiding: GnssAiding | None = None

    def fit(
        self,
        target: PlaneMap,
        segments: Segments,
        prediction: Prediction,
        *,
        weak: WeakDirections | None = None,
        rest: Rest = Rest.MOVING,
    ) -> FrameFit:
        """Correct a predicted motion until the ends of the segments lie on the planes.

        Where these observe a direction weakly, ``weak`` adds points that observe it. A body at
        ``rest`` at the end has no velocity there. Both ends of a segment are used, not its
        midpoint: planes are fitted to ends. While stationary this halves the scatter of the pose.
        """
        information, g_prior = self._known(prediction, rest)
        center = prediction.T_odom_body.t[-1]
        p_body = np.concatenate([segments.a_body, segments.b_body])
        p_s = np.concatenate([segments.a_s, segments.b_s])
        frame_fraction = p_s / prediction.t_s[-1]
        delta = _first_correction(prediction)
        T_dense = _correct(prediction, delta, center)
        converged, rounds = False, 0
        for rounds in range(1, self.rounds + 1):
            p_odom = place_points(prediction.t_s, T_dense.R, T_dense.t, p_s, p_body)
            match = target.match(
                p_odom, frame_fraction, center=center,
                finest=max(self.coarse + 1 - rounds, 0), gate_m=self._gate_m(rounds),
            )  # fmt: skip
            H_lidar, g_lidar = self._weighted(match)
            if weak is not None:
                gate_m = self._gate_m(rounds)
                H_points, g_points = weak.pull(match, rounds, gate_m, T_odom_body=T_dense)
                H_lidar, g_lidar = H_lidar + H_points, g_lidar + g_points
            H, g = information.copy(), information @ delta + g_prior
            H[POSES, POSES] += H_lidar
            g[POSES] += g_lidar
            self._add_aiding(H, g, T_dense[-1], t_ns=prediction.end.t_ns)
            step = np.asarray(-np.linalg.solve(H, g), np.float64)
            delta = delta + step
            T_dense = _correct(prediction, delta, center)
            if rounds > self.coarse and _largest_move_m(step) < self.converged_step_m:
                converged = True
                break
        P, still = np.asarray(np.linalg.inv(H), np.float64), rest is Rest.STATIONARY
        return FrameFit(T_dense, delta, P, H_lidar, match, rounds, converged, still, self.with_imu)

    def _known(self, prediction: Prediction, rest: Rest) -> tuple[Array, Array]:
        """What is known before the points are used, in the form of `_prior`."""
        information, g = _prior(prediction, rest)
        if self.with_imu:
            _add_speed_of_person(information, g, prediction)
        return information, g

    def by_fixes(self, tried: FrameFit, prediction: Prediction, rest: Rest) -> FrameFit | None:
        """The motion by prediction and fixes alone, where the local map says too little of it.

        None if it does not lead to where the fixes are.

        Args:
            tried: The fit to the local map, for its figures.
            prediction: Of the motion.
            rest: Whether the body stands at its end.
        """
        fit = self.fit(PlaneMap(), NO_SEGMENTS, prediction, rest=rest)
        if self.aiding is None or not self.aiding.agrees(fit.T_dense[-1], prediction.end.t_ns):
            return None
        return replace(fit, match=tried.match)

    def as_expected(self, tried: FrameFit, prediction: Prediction) -> FrameFit:
        """The motion through the expected pose, where the local map says too little of it.

        Args:
            tried: The fit to the local map, for its figures.
            prediction: With an expected pose.
        """
        information, g_prior = _prior(prediction, Rest.MOVING)
        P = np.asarray(np.linalg.inv(information), np.float64)
        delta = np.asarray(-P @ g_prior, np.float64)
        T_dense = _correct(prediction, delta, prediction.T_odom_body.t[-1])
        return replace(tried, T_dense=T_dense, delta=delta, P=P, converged=False)

    def _add_aiding(self, H: Array, g: Array, T_odom_body: SE3, *, t_ns: int) -> None:
        """Add what GNSS knows of the pose at the end to the normal equations, in place."""
        if self.aiding is not None:
            H_aiding, g_aiding = self.aiding.pull(T_odom_body, t_ns)
            H[END_POSE, END_POSE] += H_aiding
            g[END_POSE] += g_aiding

    def _gate_m(self, rounds: int) -> float:
        return FRAME_FIT.gates_m[
            min(rounds - 1 + (0 if self.coarse else 1), len(FRAME_FIT.gates_m) - 1)
        ]

    @cached_property
    def _tuning(self) -> OdometryTuning:
        return tuned(OdometryTuning, self.settings)

    def _weighted(self, match: Match) -> tuple[Array, Array]:
        tuning = self._tuning
        H, g = observable_directions(match, tuning.normal_noise_rad, with_imu=self.with_imu)
        return tuning.information_scale * H, tuning.information_scale * g


def motion_cov(P: Array) -> Array:
    """Covariance of the end pose against the start pose, from their joint covariance."""
    cross = P[START, END_POSE]
    return np.asarray(P[START, START] + P[END_POSE, END_POSE] - cross - P[END_POSE, START])


def _prior(prediction: Prediction, rest: Rest) -> tuple[Array, Array]:
    """Information (34, 34) of the prediction and gradient (34,) where nothing is corrected."""
    information = np.asarray(np.linalg.inv(prediction.prior + 1e-12 * np.eye(END.stop)), np.float64)
    g = np.zeros(END.stop)
    if prediction.expected is not None:
        weighted = _MIDDLE.T / np.repeat(FRAME_FIT.expected_sd, 3) ** 2
        information += weighted @ _MIDDLE
        g -= weighted @ _from_expected(prediction, prediction.expected)
    at_rest = _AT_REST.get(rest)
    if at_rest is not None:
        information[END_VELOCITY, END_VELOCITY] += np.diag(at_rest)
        g[END_VELOCITY] += at_rest * prediction.end.vector[VECTOR.velocity]
    return information, g


def _add_speed_of_person(information: Array, g: Array, prediction: Prediction) -> None:
    """Add to the normal equations, in place, that a person is hardly faster."""
    velocity = prediction.end.vector[VECTOR.velocity]
    speed = float(np.linalg.norm(velocity))
    if speed > FRAME_FIT.person_m_s:
        along = velocity / speed
        information[END_VELOCITY, END_VELOCITY] += (
            np.outer(along, along) / FRAME_FIT.person_sd_m_s**2
        )
        g[END_VELOCITY] += along * (speed - FRAME_FIT.person_m_s) / FRAME_FIT.person_sd_m_s**2


def _correct(prediction: Prediction, delta: Array, center: Array) -> SE3:
    """Apply a correction to the predicted poses, interpolated linearly over the frame."""
    predicted, fraction = prediction.T_odom_body, prediction.t_s / prediction.t_s[-1]
    return SE3(*corrected_poses(fraction, predicted.R, predicted.t, delta, center))


def pose_correction(predicted: SE3, T_odom_body: SE3, center: Array) -> Array:
    """Rotation about a center and shift that correct a predicted pose to another, (6,)."""
    omega = so3_log(T_odom_body.R @ predicted.R.T)
    arm = so3_exp(omega) @ (predicted.t - center)
    return np.concatenate([omega, T_odom_body.t - center - arm])


def _from_expected(prediction: Prediction, expected: SE3) -> Array:
    """Correction of the middle of a prediction that leads to the pose expected there, (6,)."""
    middle = middle_of(prediction.t_s, prediction.T_odom_body)
    return pose_correction(middle, expected, prediction.T_odom_body.t[-1])


def _first_correction(prediction: Prediction) -> Array:
    """Most probable correction of a prediction that passes the expected pose, (34,)."""
    if prediction.expected is None:
        return np.zeros(END.stop)
    cross = prediction.prior @ _MIDDLE.T
    innovation_cov = _MIDDLE @ cross + FRAME_FIT.near_variance * np.eye(6)
    z = _from_expected(prediction, prediction.expected)
    return np.asarray(cross @ np.linalg.solve(innovation_cov, z))


def _largest_move_m(step: Array) -> float:
    """How far a step moves a point at `ARM_M`, at the start or end of the frame [m]."""
    poses = (step[START], step[END_POSE])
    return float(max(tangent_size_m(pose) for pose in poses))
