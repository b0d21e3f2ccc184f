"""Odometry by planes: the pose of each multiframe from the ones before, for files and live."""

from __future__ import annotations

from dataclasses import dataclass, replace

from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.aiding import GnssAiding
from recon4.registration.bridge import bridge_cov
from recon4.registration.frame_fit import FrameFit
from recon4.registration.frame_view import FrameView
from recon4.registration.imu_strategy import ImuStrategy
from recon4.registration.local_map import LocalMap
from recon4.registration.motion import MotionState, Prediction
from recon4.registration.motion_strategy import MotionStrategy
from recon4.registration.point_map import WeakDirections
from recon4.registration.scan_strategy import ScanStrategy
from recon4.registration.state_vector import END
from recon4.registration.step import OdometryStep, make_step
from recon4.registration.tracking import Seen, TrackingState
from recon4.registration.tuning import OdometryTuning
from recon4.registration.tuning_motion import GAPS
from recon4.settings.reads import OdometryReads
from recon4.settings.tuning import tuned


@dataclass(frozen=True, slots=True, eq=False)
class _Try:
    """A frame at the pose where it fits best, and what that shows."""

    prediction: Prediction
    fit: FrameFit
    seen: Seen
    first: bool = False
    """Whether it begins a map, so that there is nothing to fit."""


class Odometry:
    """Registers multiframes one after the other against a local map of keyframes.

    Each frame is undistorted with the predicted motion and its collar line segments are matched to
    planes of the last keyframes. An iterated error-state Kalman filter over the pose at the start
    and the state at the end of the frame updates pose, velocity and IMU biases together. What
    predicts the motion is a strategy: an IMU, or the registration to the last scan.
    """

    def __init__(
        self,
        rig: Rig,
        settings: OdometryReads,
        imu: ImuSamples | None = None,
        *,
        aiding: GnssAiding | None = None,
    ) -> None:
        self._rig = rig
        self._weak_eigenvalue = tuned(OdometryTuning, settings.odometry).weak_eigenvalue
        self._motion: MotionStrategy = (
            ImuStrategy(imu, rig, settings, aiding=aiding)
            if imu is not None and len(imu) > 1 and settings.odometry.use_imu
            else ScanStrategy(settings, aiding)
        )
        self._map = LocalMap(settings, longest=self._motion.longest_map)
        self._tracking = TrackingState(settings.odometry)
        self._state: MotionState | None = None
        self._good: MotionState | None = None
        """The state after the last frame that was not lost."""
        self._is_weak = False
        """Whether the LiDARs hardly observed the motion of the last frame."""
        self._end_ns: int | None = None
        """End of the last frame."""

    def push(self, frame: Multiframe) -> OdometryStep:
        """Register the next multiframe; frames come in the order of their time."""
        return self.push_view(FrameView(frame, self._rig))

    def push_view(self, view: FrameView) -> OdometryStep:
        """Register the next multiframe, as `push`; its segments are drawn already."""
        frame = view.frame
        self._begin_moving(frame)
        tried = self._registered(view)
        self._tracking.next(tried.seen)
        self._state = _updated(tried)
        step = self._step(frame, tried)
        if step.lost:
            self._is_weak = False
            self._restart(self._motion.after_loss(view, self._tracking), view.end_ns)
        else:
            self._good, self._is_weak = self._state, tried.fit.is_weak
            self._motion.keep(step)
            if self._map.needs(step.T_dense[-1]):
                self._map.add(view, tried.prediction.t_s, step.T_dense)
        self._end_ns = view.end_ns
        return step

    def remember_imu(self, known: MotionState) -> None:
        """Begin with what another odometry found out about the same IMU (`imu_state`)."""
        self._motion.remember(known)

    def extend_imu(self, imu: ImuSamples) -> None:
        """Append newer IMU samples of a live capture. Without an IMU at first this does nothing."""
        self._motion.extend(imu)

    @property
    def imu_state(self) -> MotionState | None:
        """The last tracked state that knows the IMU; None without one, or before the first."""
        return self._motion.imu_state(self._good)

    def _registered(self, view: FrameView) -> _Try:
        """A frame at its pose by prediction and map; across a gap by the scans before it."""
        gap = self._is_interrupted(view.start_ns)
        tried = None
        if gap:
            tried = self._across_gap(view)
            if tried is None:
                self._restart(Seen.GAP, view.start_ns)
        if tried is None:
            tried = self._fit(view, self._motion.predict(self._state, view, self._tracking))
            if tried.seen is Seen.MISSES and not gap:
                tried = self._across_gap(view) or tried
        if tried.seen is Seen.MISSES:
            tried = self._by_fixes(view, tried)
        if tried.seen is not Seen.FITS:
            return tried
        if not tried.first:
            self._tracking.limits.learn(tried.fit.match.match_ratio)
        return replace(tried, fit=self._motion.refined(tried.fit, tried.prediction))

    def _across_gap(self, view: FrameView) -> _Try | None:
        if self._end_ns is None:
            return None
        prediction = self._motion.bridge(view, self._end_ns)
        if prediction is None:
            return None
        tried = self._fit(view, prediction)
        fit = tried.fit
        if tried.seen is Seen.MISSES:  # so much is new that the local map says little
            fit = self._motion.fitter.as_expected(fit, prediction)
        return replace(tried, fit=fit, seen=Seen.CROSSES_GAP)

    def _by_fixes(self, view: FrameView, tried: _Try) -> _Try:
        """A frame of which the map says too little where fixes place it, if they do.

        It is not lost, so its points become part of the map: a few returns a frame, as of an open
        field, make planes only together.
        """
        prediction = self._motion.by_fixes(view, tried.prediction)
        if prediction is None:
            return tried
        rest = self._motion.rest(prediction.end, weak=self._is_weak)
        fit = self._motion.fitter.by_fixes(tried.fit, prediction, rest)
        return tried if fit is None else _Try(prediction, fit, Seen.PLACED)

    def _fit(self, view: FrameView, prediction: Prediction) -> _Try:
        """Fit a frame to the local map."""
        first = self._map.is_empty
        weak = WeakDirections(
            self._map.points,
            view.points,
            prediction,
            max_eigenvalue=self._weak_eigenvalue,
        )
        rest = self._motion.rest(prediction.end, weak=self._is_weak)
        fit = self._motion.fitter.fit(
            self._map.planes, view.segments, prediction, weak=weak, rest=rest
        )
        lost = not first and self._motion.is_lost(fit, prediction, self._tracking.limits)
        return _Try(prediction, fit, Seen.MISSES if lost else Seen.FITS, first)

    def _step(self, frame: Multiframe, tried: _Try) -> OdometryStep:
        """What is reported of a frame."""
        prediction, fit, lost = tried.prediction, tried.fit, tried.seen is Seen.MISSES
        T_dense = prediction.T_odom_body if lost or tried.first else fit.T_dense
        step = make_step(frame, prediction, fit, T_dense=T_dense, lost=lost)
        cov = step.motion_cov + self._motion.unknown_cov(frame, fit)
        bridged = tried.seen is Seen.CROSSES_GAP
        if bridged:
            cov = cov + bridge_cov()
        return replace(step, motion_cov=cov, piece=self._tracking.piece, bridged=bridged)

    def _begin_moving(self, frame: Multiframe) -> None:
        """At the second frame: if the body moves, place the first one again with its velocity."""
        again = self._motion.moving_start(frame)
        if again is None:
            return
        first, state = again
        view = FrameView(first, self._rig)
        prediction = self._motion.predict(state, view, self._tracking)
        self._state = self._good = prediction.end
        self._map.clear()
        self._map.add(view, prediction.t_s, prediction.T_odom_body)

    def _is_interrupted(self, start_ns: int) -> bool:
        """Whether the motion since the last frame is unknown: a long gap that nothing covers."""
        if self._end_ns is None or start_ns - self._end_ns <= GAPS.interrupted_ns:
            return False
        return not self._motion.covers(self._end_ns, start_ns)

    def _restart(self, seen: Seen | None, t_ns: int) -> None:
        """Begin another map if something shows that this one is of no use any more.

        The edge of the pose graph is weak there. In another piece it begins at the last good pose,
        not where the prediction has run to.
        """
        if seen is None:
            return
        before = self._tracking.piece
        self._tracking.next(seen)
        self._map.clear()
        if self._tracking.piece != before and self._good is not None:
            self._state = self._motion.at_rest(self._good, t_ns)


def _updated(tried: _Try) -> MotionState:
    prediction, fit = tried.prediction, tried.fit
    if tried.seen is Seen.MISSES or tried.first:
        return prediction.end
    return prediction.end.corrected(fit.delta[END], fit.P[END, END])
