"""The motion by registering each scan to the last good one, and by fixes where that is not sure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.model.multiframe import Multiframe
from recon4.model.samples import ImuSamples
from recon4.registration.aiding import GnssAiding
from recon4.registration.frame_fit import FrameFit, FrameFitter, pose_correction
from recon4.registration.frame_view import FrameView
from recon4.registration.lost import FreshChain, LostLimits
from recon4.registration.met_fixes import MetFixes
from recon4.registration.motion import FreeMotion, MotionState, Prediction, Rest
from recon4.registration.motion_strategy import is_numeric
from recon4.registration.scan_chain import ScanChain
from recon4.registration.state_vector import END_MOTION, END_POSE, POSES, START, VECTOR
from recon4.registration.step import OdometryStep
from recon4.registration.tracking import Seen, TrackingState
from recon4.registration.tuning import PLANES, OdometryTuning, registration_tuning
from recon4.registration.tuning_motion import SCAN_MOTION, STILL
from recon4.registration.weak_motion import unknown_motion_cov
from recon4.settings.reads import OdometryReads
from recon4.settings.tuning import tuned


class ScanStrategy:
    """Without an IMU: the last scan says where the next one is expected."""

    def __init__(self, settings: OdometryReads, aiding: GnssAiding | None) -> None:
        self._settings = settings
        self._free, self._chain = (
            FreeMotion(settings.odometry),
            ScanChain(tuned(OdometryTuning, settings.odometry).scans),
        )
        self._fresh: FreshChain | None = None
        """The scans since tracking was lost."""
        self._met = MetFixes(aiding, settings.odometry)
        self._goes_on = False
        """Whether the velocity predicted the newest scan, as nothing else places it."""
        self.longest_map = tuned(OdometryTuning, settings.odometry).longest_map(with_imu=False)
        self.fitter = FrameFitter(
            settings.odometry,
            registration_tuning(settings.registration).converged_step_m,
            coarse=PLANES.levels - 1,
            rounds=tuned(OdometryTuning, settings.odometry).rounds_without_imu,
            with_imu=False,
        )

    def remember(self, known: MotionState) -> None:
        """See `MotionStrategy.remember`: there is no IMU."""

    def extend(self, imu: ImuSamples) -> None:
        """See `MotionStrategy.extend`: an IMU that comes later is not used."""

    def moving_start(self, frame: Multiframe) -> tuple[Multiframe, MotionState] | None:
        """See `MotionStrategy.moving_start`: the first two scans are distorted alike."""
        return None

    def covers(self, start_ns: int, end_ns: int) -> bool:
        """See `MotionStrategy.covers`: a scan hardly overlaps with one long before."""
        return False

    def bridge(self, view: FrameView, last_ns: int) -> Prediction | None:
        """See `MotionStrategy.bridge`."""
        if view.start_ns - last_ns < SCAN_MOTION.unseen_ns:
            return None
        found = self._chain.bridge(view.scan(self._chain.motion), view.frame.t_mid_ns)
        if found is None:
            return None
        return self._through(self._chain.last[0] @ found, view)

    def predict(
        self, state: MotionState | None, view: FrameView, tracking: TrackingState
    ) -> Prediction:
        """See `MotionStrategy.predict`; its ``expected`` is None if nothing places the scan.

        Right after a scan that was tracked its velocity then predicts this one: on bare ground two
        scans of a tilted LiDAR share too little, and the local map has all of it.
        """
        self._goes_on = False
        found = view.locate_in(self._chain)
        if state is None:
            state = self._free.initial(view.start_ns)
            state = self._met.begin(state, self._free.predict)
            self.fitter = replace(self.fitter, aiding=self._met.fixes)
            return self._move(state, view)
        state = self._met.meet(state)
        self.fitter = replace(self.fitter, aiding=self._met.fixes)
        by_scans = self._chain.last[0] @ found if found else None
        expected = self._placed(by_scans, view.frame.t_mid_ns)
        if expected is None:
            seen = view.start_ns - state.t_ns < SCAN_MOTION.unseen_ns
            self._goes_on = tracking.is_velocity_known and seen and self._chain.shares_usual
            if not self._goes_on:
                state = self._free.at_rest(state, view.start_ns)
            return self._move(state, view)
        if not tracking.is_velocity_known:
            return self._through(expected, view)
        return replace(self._move(state, view), expected=expected)

    def _placed(self, by_scans: SE3 | None, t_ns: int) -> SE3 | None:
        """Pose by the last good scan, else by fixes."""
        if self._chain.is_sure or self._met.fixes is None:
            return by_scans
        return self._met.fixes.pose(t_ns) or by_scans

    def _through(self, now: SE3, view: FrameView) -> Prediction:
        """Constant velocity from the last good scan to a pose in the middle of a frame."""
        before, before_ns = self._chain.last
        T, times_ns = SE3.stack([before, now]), (before_ns, view.frame.t_mid_ns)
        state = self._free.between(T, times_ns, view.start_ns)
        return replace(self._move(state, view), expected=now)

    def _move(self, state: MotionState, view: FrameView) -> Prediction:
        if state.t_ns < view.start_ns:  # frames are missing in between
            state = self._free.predict(state, view.start_ns).end
        return self._free.predict(state, view.end_ns)

    def rest(self, end: MotionState, *, weak: bool) -> Rest:
        """See `MotionStrategy.rest`."""
        return self._free.rest(end, weak=weak)

    def is_lost(self, fit: FrameFit, prediction: Prediction, limits: LostLimits) -> bool:
        """See `MotionStrategy.is_lost`."""
        if not is_numeric(fit):
            return True
        if prediction.expected is None:
            return not (self._goes_on and limits.is_usual(fit.match))
        return limits.is_lost(fit.match, sure=self._chain.is_sure)

    def by_fixes(self, view: FrameView, prediction: Prediction) -> Prediction | None:
        """See `MotionStrategy.by_fixes`."""
        if self._met.fixes is None or not self._met.fixes.covers(view.start_ns, view.end_ns):
            return None
        return replace(prediction, expected=self._met.fixes.pose(view.frame.t_mid_ns))

    def refined(self, fit: FrameFit, prediction: Prediction) -> FrameFit:
        """See `MotionStrategy.refined`: two scans that agree are those of a body at rest."""
        if self._goes_on or not is_stationary(self._chain.located):
            return fit
        return zero_velocity_update(fit, prediction, self._chain.last[0])

    def unknown_cov(self, frame: Multiframe, fit: FrameFit) -> Array:
        """See `MotionStrategy.unknown_cov`: fixes bound what no velocity excludes."""
        aided = self._met.fixes and self._met.fixes.pose(frame.t_ns + frame.duration_ns)
        most_m = tuned(OdometryTuning, self._settings.odometry).gnss_sd_m if aided else float("inf")
        return unknown_motion_cov(fit, seconds=1e-9 * frame.duration_ns, most_m=most_m)

    def keep(self, step: OdometryStep) -> None:
        """See `MotionStrategy.keep`."""
        self._fresh = None
        self._chain.keep(step.T_odom_body, step.t_mid_ns)

    def after_loss(self, view: FrameView, tracking: TrackingState) -> Seen | None:
        """See `MotionStrategy.after_loss`."""
        if self._fresh is None:
            self._fresh = FreshChain(tuned(OdometryTuning, self._settings.odometry).scans)
        sure = self._fresh.push(view)
        return Seen.SURE_AGAIN if sure else None

    def at_rest(self, state: MotionState, t_ns: int) -> MotionState:
        """See `MotionStrategy.at_rest`."""
        self._chain, self._fresh = (
            ScanChain(tuned(OdometryTuning, self._settings.odometry).scans),
            None,
        )
        return self._free.at_rest(state, t_ns)

    def imu_state(self, good: MotionState | None) -> MotionState | None:
        """See `MotionStrategy.imu_state`."""
        return None


def is_stationary(T_scan_scan: SE3) -> bool:
    """Whether the motion between two consecutive scans is within its noise."""
    small = np.linalg.norm(T_scan_scan.t) < STILL.scans_m and T_scan_scan.angle() < STILL.scans_rad
    return bool(small)


def zero_velocity_update(fit: FrameFit, prediction: Prediction, T_odom_body: SE3) -> FrameFit:
    """The fit with the body stationary at an earlier pose, if the points are consistent with it.

    The chi-square of the hypothesis is ``d^T H d``: ``d`` is its difference from the fit and ``H``
    the information of the points. The reference pose stays the same, so errors do not accumulate.

    Args:
        fit: The fit without the hypothesis.
        prediction: The motion that the fit corrects.
        T_odom_body: The pose at which the body may still be.
    """
    delta = _standing(fit, prediction, T_odom_body)
    d = (delta - fit.delta)[POSES]
    if d @ fit.H_lidar @ d > STILL.chi2:
        return fit
    poses = len(prediction.t_s)
    return replace(fit, delta=delta, T_dense=SE3.stack([T_odom_body] * poses))


def _standing(fit: FrameFit, prediction: Prediction, T_odom_body: SE3) -> Array:
    """Correction that makes a predicted motion stationary at a pose, (34,)."""
    delta = fit.delta.copy()
    predicted, end = prediction.T_odom_body, prediction.end
    center = predicted.t[-1]
    for pose, k in ((delta[START], 0), (delta[END_POSE], -1)):
        pose[:] = pose_correction(predicted[k], T_odom_body, center)
    still = np.concatenate([end.vector[VECTOR.velocity], end.vector[VECTOR.gyro_bias]])
    delta[END_MOTION] = -still  # no velocity, no turn rate
    return delta
