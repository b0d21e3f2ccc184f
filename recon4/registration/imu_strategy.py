"""The motion by an IMU, with constant velocity where it has no samples.

An IMU does not know it, and the first frame is undistorted with it: with a velocity of 0 in place
of a person's 1.2 m/s its points are smeared over 12 cm, and all others are registered to them.
Two scans in a row are smeared alike, so their relative pose is right before either is undistorted.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.aiding import GnssAiding
from recon4.registration.frame_fit import FrameFit, FrameFitter
from recon4.registration.frame_view import FrameView
from recon4.registration.lost import LostLimits
from recon4.registration.met_fixes import MetFixes
from recon4.registration.motion import FreeMotion, ImuMotion, MotionState, Prediction, Rest
from recon4.registration.motion_strategy import is_numeric
from recon4.registration.scan_chain import ScanChain, body_points, times_located
from recon4.registration.state_vector import STATE, VECTOR
from recon4.registration.step import OdometryStep
from recon4.registration.tracking import Seen, TrackingState
from recon4.registration.tuning import SCANS, OdometryTuning, ScanTuning, registration_tuning
from recon4.registration.tuning_imu import IMU_MOTION
from recon4.registration.tuning_matching import SCAN_CHAIN
from recon4.registration.tuning_motion import MOVING_START
from recon4.registration.weak_motion import unknown_motion_cov
from recon4.settings.reads import OdometryReads
from recon4.settings.tuning import tuned


class ImuStrategy:
    """An IMU predicts every frame, also those that are lost."""

    def __init__(
        self, imu: ImuSamples, rig: Rig, settings: OdometryReads, *, aiding: GnssAiding | None
    ) -> None:
        self._rig, self._settings = rig, settings
        self._imu, self._free = (
            ImuMotion(imu, rig, settings.odometry),
            FreeMotion(settings.odometry),
        )
        self._before_hole: MotionState | None = None
        """During a gap in the samples: the last state before it, with the IMU biases."""
        self._met = MetFixes(aiding, settings.odometry)
        self._begun: tuple[Multiframe, MotionState] | None = None
        """The first frame until the second one comes, and the state at its start."""
        self.longest_map = tuned(OdometryTuning, settings.odometry).history
        self.fitter = FrameFitter(
            settings.odometry,
            registration_tuning(settings.registration).converged_step_m,
            coarse=0,
            rounds=tuned(OdometryTuning, settings.odometry).rounds,
            with_imu=True,
        )

    def remember(self, known: MotionState) -> None:
        """See `MotionStrategy.remember`."""
        self._imu.remember(known, of_walk=True)

    def extend(self, imu: ImuSamples) -> None:
        """See `MotionStrategy.extend`."""
        self._imu.extend(imu)

    def moving_start(self, frame: Multiframe) -> tuple[Multiframe, MotionState] | None:
        """See `MotionStrategy.moving_start`."""
        begun, self._begun = self._begun, None
        if begun is None or self._met.fixes:
            return None
        first, state = begun
        velocity = starting_velocity(
            first,
            frame,
            rig=self._rig,
            settings=tuned(OdometryTuning, self._settings.odometry).scans,
        )
        if velocity is None:
            return None
        # Not a new initial state: live there are more samples by now, and they tilt it otherwise.
        return first, set_moving(state, velocity, duration_ns=first.duration_ns)

    def covers(self, start_ns: int, end_ns: int) -> bool:
        """See `MotionStrategy.covers`."""
        return self._imu.covers(start_ns, end_ns)

    def bridge(self, view: FrameView, last_ns: int) -> Prediction | None:
        """See `MotionStrategy.bridge`: the IMU is more exact than scans."""
        return None

    def predict(
        self, state: MotionState | None, view: FrameView, tracking: TrackingState
    ) -> Prediction:
        """See `MotionStrategy.predict`."""
        if state is None:
            state = self._imu.initial(view.start_ns)
            state = self._met.begin(state, self._move)
            self._begun = view.frame, state
        if state.t_ns < view.start_ns:  # frames are missing in between
            state = self._move(state, view.start_ns).end
        state = self._met.meet(state)
        self.fitter = replace(self.fitter, aiding=self._met.fixes)
        return self._move(state, view.end_ns)

    def _move(self, state: MotionState, end_ns: int) -> Prediction:
        if self._imu.covers(state.t_ns, end_ns):
            if self._before_hole is not None:
                before, self._before_hole = self._before_hole, None
                state = state.with_biases(
                    before.vector[VECTOR.calibration],
                    before.P[STATE.calibration, STATE.calibration],
                )
            return self._imu.predict(state, end_ns)
        if self._before_hole is None:
            self._before_hole = state
            state = self._free.coasting(state)
        return self._free.predict(state, end_ns)

    def rest(self, end: MotionState, *, weak: bool) -> Rest:
        """See `MotionStrategy.rest`."""
        return self._imu.rest(end, weak=weak)

    def is_lost(self, fit: FrameFit, prediction: Prediction, limits: LostLimits) -> bool:
        """See `MotionStrategy.is_lost`."""
        offset_m = float(np.linalg.norm(fit.T_dense.t[-1] - prediction.T_odom_body.t[-1]))
        fits = fit.converged and max(fit.match.mean_m, offset_m) < IMU_MOTION.as_predicted_m
        sure = fits and not limits.is_usual_known
        return not is_numeric(fit) or limits.is_lost(fit.match, sure=sure)

    def by_fixes(self, view: FrameView, prediction: Prediction) -> Prediction | None:
        """See `MotionStrategy.by_fixes`: they pull what the IMU predicts."""
        known = self._met.fixes is not None and self._met.fixes.covers(view.start_ns, view.end_ns)
        return prediction if known else None

    def refined(self, fit: FrameFit, prediction: Prediction) -> FrameFit:
        """See `MotionStrategy.refined`: the filter knows it already."""
        return fit

    def unknown_cov(self, frame: Multiframe, fit: FrameFit) -> Array:
        """See `MotionStrategy.unknown_cov`: fixes and accelerometer exclude the rest."""
        if self._met.fixes and self._met.fixes.pose(frame.t_ns + frame.duration_ns):
            return np.zeros((6, 6))
        return unknown_motion_cov(fit, seconds=1e-9 * frame.duration_ns)

    def keep(self, step: OdometryStep) -> None:
        """See `MotionStrategy.keep`: the state knows all."""

    def after_loss(self, view: FrameView, tracking: TrackingState) -> Seen | None:
        """See `MotionStrategy.after_loss`: for so long the IMU leads to what is new."""
        lost_for_long = (
            tracking.lost_frames >= tuned(OdometryTuning, self._settings.odometry).restart_after
        )
        return Seen.LOST_FOR_LONG if lost_for_long else None

    def at_rest(self, state: MotionState, t_ns: int) -> MotionState:
        """The last position and heading, with what the IMU says of the attitude now."""
        self._imu.remember(self._before_hole or state)
        self._before_hole = None
        leveled = self._imu.initial(t_ns)
        vector = leveled.vector.copy()
        vector[VECTOR.position] = state.vector[VECTOR.position]
        yaw_rad = float(np.arctan2(state.R[1, 0], state.R[0, 0]))
        return replace(leveled, R=so3_exp([0.0, 0.0, yaw_rad]) @ leveled.R, vector=vector)

    def imu_state(self, good: MotionState | None) -> MotionState | None:
        """See `MotionStrategy.imu_state`."""
        return self._before_hole or good


def starting_velocity(
    first: Multiframe, second: Multiframe, *, rig: Rig, settings: ScanTuning = SCANS
) -> Array | None:
    """Velocity between two frames in axes of the body [m/s], (3,).

    None if the body stands, or if the scans do not surely fit each other.
    """
    span_ns = second.t_mid_ns - first.t_mid_ns
    if not 0 < span_ns <= MOVING_START.longest_ns:
        return None
    found = SE3.identity()
    for _ in range(times_located(rig)):
        motion = SE3.exp(found.log() * (first.duration_ns / span_ns))
        chain = ScanChain(settings)
        chain.locate(body_points(first, rig, motion), first.t_mid_ns)
        chain.keep(chain.located, first.t_mid_ns)
        before, located = found, chain.locate(body_points(second, rig, motion), second.t_mid_ns)
        if located is None or not chain.is_sure:
            return None
        found = located
        if not (before.inverse() @ found).moves_more_than(SCAN_CHAIN.settled_m):
            break
    velocity = found.t / (1e-9 * span_ns)
    return velocity if float(np.linalg.norm(velocity)) > MOVING_START.moving_m_s else None


def set_moving(state: MotionState, velocity_body: Array, *, duration_ns: int) -> MotionState:
    """A state at the start of a frame with a velocity; the middle of the frame stays at its pose.

    Args:
        state: At the start of the frame.
        velocity_body: In axes of the body [m/s], (3,).
        duration_ns: Of the frame.
    """
    velocity = state.R @ velocity_body
    vector = state.vector.copy()
    vector[VECTOR.position] -= 0.5e-9 * duration_ns * velocity
    return replace(state, vector=vector).moving(velocity, MOVING_START.sd_m_s)
