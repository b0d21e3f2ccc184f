"""Odometry by planes: the pose of each multiframe from the ones before, for files and live."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.kernels.imu import place_points
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.aiding import GnssAiding
from recon4.registration.bridge import bridge_cov
from recon4.registration.frame_fit import FrameFit, FrameFitter
from recon4.registration.lost import FreshChain, LostLimits
from recon4.registration.motion import (
    FreeMotion,
    ImuMotion,
    Motion,
    MotionState,
    Prediction,
)
from recon4.registration.moving_start import set_moving, starting_velocity
from recon4.registration.plane_map import PlaneMap
from recon4.registration.point_map import FramePoints, PointMap, WeakDirections, frame_points
from recon4.registration.scan_chain import ScanChain, body_points
from recon4.registration.segments import Segments, sample_segments
from recon4.registration.state import END, STATE, VECTOR
from recon4.registration.step import OdometryStep, make_step
from recon4.registration.weak_motion import unknown_speed_sd, weak_motion_cov
from recon4.registration.zero_velocity import is_stationary, zero_velocity_update
from recon4.settings import Settings

_TRUSTED_FRAMES = 30
"""If a new map is lost before this many frames, the state it began with was wrong."""
_AS_PREDICTED_M = 0.03
"""While it is not known how much usually matches, a frame is sure of its pose if the LiDARs move
what the IMU predicts by less, and what matches lies as near [m]."""
_INTERRUPTED_NS = 2_000_000_000
"""Longest gap between two frames that is predicted across without an IMU [ns]."""
_UNSEEN_NS = 200_000_000
"""Least time without a frame in which the body moved unseen [ns]. Without such a gap a scan that is
lost shows a change of what stands around: the doors of an elevator that opened elsewhere."""


@dataclass(frozen=True, slots=True, eq=False)
class _Try:
    """A frame at the pose where it fits best."""

    prediction: Prediction
    fit: FrameFit
    lost: bool


class Odometry:
    """Registers multiframes one after the other against a local map of keyframes.

    Each frame is undistorted with the predicted motion and its collar line segments are matched to
    planes of the last keyframes. An iterated error-state Kalman filter over the pose at the start
    and the state at the end of the frame updates pose, velocity and IMU biases together. Without
    an IMU the registration to the last scan (`ScanChain`) predicts the pose of every frame; if it
    fails, the frame is lost.
    """

    def __init__(
        self,
        rig: Rig,
        settings: Settings,
        imu: ImuSamples | None = None,
        *,
        aiding: GnssAiding | None = None,
    ) -> None:
        self._rig, self._settings, self._aiding = rig, settings, aiding
        with_imu = imu is not None and len(imu) > 1 and settings.odometry.use_imu
        self._free = FreeMotion(settings.odometry)
        self._motion: Motion = (
            ImuMotion(imu, rig, settings.odometry) if with_imu and imu else self._free
        )
        self._chain = None if with_imu else ScanChain(settings.scans)
        self._state: MotionState | None = None
        self._good: MotionState | None = None
        """The state after the last frame that was not lost."""
        self._before_hole: MotionState | None = None
        """During a gap in the IMU samples: the last state before it, with the IMU biases."""
        self._fitter = FrameFitter(
            settings.odometry,
            settings.registration.converged_step_m,
            coarse=0 if with_imu else settings.planes.levels - 1,
            rounds=settings.odometry.rounds if with_imu else settings.odometry.rounds_without_imu,
            with_imu=with_imu,
            aiding=aiding,
        )
        self._map = PlaneMap(settings.planes)
        self._points = PointMap(settings.planes)
        self._keyframes: deque[tuple[Array, Array]] = deque()
        """Ends of the segments of the last keyframes (N, 3), and from where they were seen (3,)."""
        self._last_keyframe = SE3.identity()
        self._lost_frames, self._is_weak = 0, False
        self._limits = LostLimits(settings.odometry)
        self._fresh: FreshChain | None = None
        """Without an IMU: the scans since tracking was lost."""
        self._first: Multiframe | None = None
        """The first frame until the second one comes, and the state at its start."""
        self._begun: MotionState | None = None
        self._end_ns: int | None = None
        self._fixes: GnssAiding | None = None
        """The aiding, if the odometry began in its frame."""
        self._piece = self._resets = self._tracked_frames = 0

    def remember_imu(self, known: MotionState) -> None:
        """Begin with what another odometry found out about the same IMU (`imu_state`)."""
        if isinstance(self._motion, ImuMotion):
            self._motion.remember(known)

    def extend_imu(self, imu: ImuSamples) -> None:
        """Append newer IMU samples of a live capture. Without an IMU at first this does nothing."""
        if isinstance(self._motion, ImuMotion):
            self._motion.extend(imu)

    @property
    def imu_state(self) -> MotionState | None:
        """The last tracked state that knows the IMU; None without one, or before the first."""
        return None if self._chain else self._before_hole or self._good

    def push(self, frame: Multiframe) -> OdometryStep:
        """Register the next multiframe; frames come in the order of their time."""
        segments = sample_segments(frame, self._rig, self._settings.segments)
        self._begin_moving(frame)
        across = None
        if self._is_interrupted(frame):
            across = self._across(frame)
            if across is None:
                self._begin_piece(frame.t_ns)
        first = not self._keyframes
        points = cache(lambda: frame_points(frame, self._rig))
        tried = self._try(frame, segments, points, across=across)
        if tried.lost and across is None:
            across = self._across(frame)
            if across is not None:
                tried = self._try(frame, segments, points, across=across)
        step = self._keep(frame, tried, first=first, bridged=across is not None)
        if not step.lost and self._is_keyframe(step.T_dense[-1]):
            self._extend_map(segments, tried.prediction.t_s, step.T_dense)
            self._points.add(points(), tried.prediction.t_s, step.T_dense)
        self._follow_lost(frame, step)
        self._end_ns = frame.t_ns + frame.duration_ns
        return step

    def _try(
        self,
        frame: Multiframe,
        segments: Segments,
        points: Callable[[], FramePoints],
        *,
        across: SE3 | None,
    ) -> _Try:
        """Fit a frame to the local map, at the pose across a gap or from that of the last scan."""
        first = not self._keyframes
        expected = self._place(frame) if across is None else across
        found = self._chain is None or first or expected is not None
        prediction = replace(self._predict(frame), expected=expected)
        weak = WeakDirections(
            self._points,
            points,
            prediction,
            max_eigenvalue=self._settings.odometry.weak_eigenvalue,
        )
        rest = self._motion.rest(prediction.end, weak=self._is_weak)
        fit = self._fitter.fit(self._map, segments, prediction, weak=weak, rest=rest)
        lost = not first and (not found or self._is_lost(fit, prediction))
        if lost and across is not None:
            # So much is new that the local map says little.
            return _Try(prediction, self._fitter.as_expected(fit, prediction), lost=False)
        return _Try(prediction, fit, lost=lost)

    def _keep(self, frame: Multiframe, tried: _Try, *, first: bool, bridged: bool) -> OdometryStep:
        """Take over the state after a frame, and report it."""
        prediction, fit, lost = tried.prediction, tried.fit, tried.lost
        if not lost and not first and not bridged:
            self._limits.learn(fit.match.match_ratio)
        if self._chain and not lost and not bridged and is_stationary(self._chain.located):
            fit = zero_velocity_update(fit, prediction, self._chain.last[0])
        self._state = _updated(prediction, fit, lost=lost, first=first)
        if not lost:
            self._good = self._state
        self._is_weak = not lost and fit.is_weak
        self._count_lost(prediction.end.t_ns, lost=lost)
        T_dense = prediction.T_odom_body if lost or first else fit.T_dense
        step = make_step(frame, prediction, fit, T_dense=T_dense, lost=lost)
        cov = step.motion_cov + self._unknown(frame, fit)
        if bridged:
            cov = cov + bridge_cov()
        step = replace(step, motion_cov=cov, piece=self._piece, bridged=bridged)
        if self._chain and not lost:
            self._chain.keep(step.T_odom_body, frame.t_mid_ns)
        return step

    def _begin_moving(self, frame: Multiframe) -> None:
        """At the second frame: if the body moves, place the first one again with its velocity."""
        first, self._first = self._first, frame if self._state is None else None
        if first is None or self._begun is None or self._chain or self._aiding:
            return
        rig, scans = self._rig, self._settings.scans
        velocity = starting_velocity(first, frame, rig=rig, settings=scans)
        if velocity is None:
            return
        self._clear_map()
        # Not a new initial state: live there are more samples by now, and they tilt it otherwise.
        self._state = set_moving(self._begun, velocity, duration_ns=first.duration_ns)
        prediction = self._predict(first)
        self._state = self._good = prediction.end
        segments = sample_segments(first, rig, self._settings.segments)
        self._extend_map(segments, prediction.t_s, prediction.T_odom_body)
        self._points.add(frame_points(first, rig), prediction.t_s, prediction.T_odom_body)

    def _unknown(self, frame: Multiframe, fit: FrameFit) -> Array:
        """Covariance of the motion that neither LiDAR nor GNSS nor standing still excludes."""
        seconds = 1e-9 * frame.duration_ns
        aided = self._aiding and self._aiding.pose(frame.t_ns + frame.duration_ns)
        with_imu = self._chain is None
        if fit.stationary or (aided and with_imu):
            return np.zeros((6, 6))
        moved_m = float(np.linalg.norm(fit.T_dense.t[-1] - fit.T_dense.t[0]))
        unknown_m = seconds * unknown_speed_sd(moved_m / seconds, with_imu=with_imu)
        return weak_motion_cov(
            fit.match.weak_direction,
            fit.weak_sd_m,
            unknown_m=min(unknown_m, self._settings.odometry.gnss_sd_m) if aided else unknown_m,
            converged=with_imu or fit.converged,
        )

    def _is_interrupted(self, frame: Multiframe) -> bool:
        """Whether the motion since the last frame is unknown: a long gap that no IMU covers."""
        if self._end_ns is None or frame.t_ns - self._end_ns <= _INTERRUPTED_NS:
            return False
        return self._chain is not None or not self._motion.covers(self._end_ns, frame.t_ns)

    def _begin_piece(self, t_ns: int) -> None:
        """Begin a new map at the last pose, because the motion since then is not known."""
        self._clear_map()
        self._piece += 1
        self._tracked_frames = 0
        if self._chain is not None:
            self._chain = ScanChain(self._settings.scans)
        if self._good is not None:
            # Not where the prediction has run to while tracking was lost.
            self._state, self._before_hole = self._at_rest(self._good, t_ns), None

    def _at_rest(self, state: MotionState, t_ns: int) -> MotionState:
        """The last position and heading, with what the IMU says of the attitude now."""
        if self._chain is not None:
            return self._free.at_rest(state, t_ns)
        if self.imu_state is not None:
            self.remember_imu(self.imu_state)
        leveled = self._motion.initial(t_ns)
        vector = leveled.vector.copy()
        vector[VECTOR.position] = state.vector[VECTOR.position]
        yaw_rad = float(np.arctan2(state.R[1, 0], state.R[0, 0]))
        return replace(leveled, R=so3_exp([0.0, 0.0, yaw_rad]) @ leveled.R, vector=vector)

    def _clear_map(self) -> None:
        self._map.clear()
        self._points.clear()
        self._keyframes.clear()
        self._lost_frames, self._fresh = 0, None

    def _follow_lost(self, frame: Multiframe, step: OdometryStep) -> None:
        """Without an IMU: once the scans since tracking was lost are sure, begin a new piece."""
        if self._chain is None or not step.lost:
            self._fresh = None
            return
        if self._fresh is None:
            self._fresh = FreshChain(self._settings.scans)
        if self._fresh.push(body_points(frame, self._rig), frame.t_mid_ns):
            self._begin_piece(frame.t_ns + frame.duration_ns)

    def _count_lost(self, t_ns: int, *, lost: bool) -> None:
        """Count lost frames; with an IMU reset the map after ``odometry.restart_after`` of them.

        Only the IMU determined the motion meanwhile, so the edge of the pose graph is weak. If the
        map before was lost soon too, the state itself is wrong, and a new piece begins.
        """
        self._lost_frames = self._lost_frames + 1 if lost else 0
        self._tracked_frames += not lost
        if self._chain is None and self._lost_frames >= self._settings.odometry.restart_after:
            if self._tracked_frames < _TRUSTED_FRAMES and self._resets + self._piece:
                self._begin_piece(t_ns)
            else:
                self._clear_map()
            self._tracked_frames, self._resets = 0, self._resets + 1

    def _across(self, frame: Multiframe) -> SE3 | None:
        """Without an IMU: pose at the middle of a frame that only the scans before a gap tell."""
        if self._chain is None or self._state is None or self._end_ns is None:
            return None
        if frame.t_ns - self._end_ns < _UNSEEN_NS:
            return None
        found = self._chain.bridge(body_points(frame, self._rig), frame.t_mid_ns)
        if found is None:
            return None
        before, before_ns = self._chain.last
        T = SE3.stack([before, before @ found])
        self._state = self._free.between(T, (before_ns, frame.t_mid_ns), frame.t_ns)
        return T[1]

    def _place(self, frame: Multiframe) -> SE3 | None:
        """Without an IMU: pose at the middle of a frame by the last good scan, else by fixes."""
        if self._chain is None:
            return None
        found = self._chain.locate(body_points(frame, self._rig), frame.t_mid_ns)
        if self._state is None:
            return None
        before, before_ns = self._chain.last
        middle = before @ found if found else None
        if not self._chain.is_sure and self._fixes:
            middle = self._fixes.pose(frame.t_mid_ns) or middle
        if middle is None:
            self._state = self._free.at_rest(self._state, frame.t_ns)
            return None
        if self._tracked_frames < 2 or self._lost_frames:  # velocity and turn rate are not known
            T = SE3.stack([before, middle])
            self._state = self._free.between(T, (before_ns, frame.t_mid_ns), frame.t_ns)
        return middle

    def _predict(self, frame: Multiframe) -> Prediction:
        start_ns, end_ns = frame.t_ns, frame.t_ns + frame.duration_ns
        if self._state is None:
            self._state = self._begun = self._initial(start_ns)
        if self._state.t_ns < start_ns:  # frames are missing in between
            self._state = self._move(self._state, start_ns).end
        return self._move(self._state, end_ns)

    def _move(self, state: MotionState, end_ns: int) -> Prediction:
        if self._motion.covers(state.t_ns, end_ns):
            if self._before_hole is not None:
                before, self._before_hole = self._before_hole, None
                state = state.with_biases(
                    before.vector[VECTOR.calibration],
                    before.P[STATE.calibration, STATE.calibration],
                )
            return self._motion.predict(state, end_ns)
        if self._before_hole is None:
            self._before_hole = state
            state = self._free.coasting(state)
        return self._free.predict(state, end_ns)

    def _initial(self, t_ns: int) -> MotionState:
        """Initial state at the pose of the GNSS aiding, else at the origin."""
        state = self._motion.initial(t_ns)
        T_enu_body = self._aiding.pose(t_ns) if self._aiding else None
        if self._aiding is None or T_enu_body is None:
            return state
        self._fixes = self._aiding
        return state.at_pose(
            T_enu_body,
            sd_rad=self._aiding.attitude_sd_rad,
            sd_m=self._settings.odometry.gnss_sd_m,
        )

    def _is_lost(self, fit: FrameFit, prediction: Prediction) -> bool:
        if self._chain is not None:
            sure = self._chain.is_sure
        else:
            offset_m = float(np.linalg.norm(fit.T_dense.t[-1] - prediction.T_odom_body.t[-1]))
            fits = fit.converged and max(fit.match.mean_m, offset_m) < _AS_PREDICTED_M
            sure = fits and not self._limits.is_usual_known
        return not np.isfinite(fit.delta).all() or self._limits.is_lost(fit.match, sure=sure)

    def _is_keyframe(self, T_odom_body: SE3) -> bool:
        """Whether the body moved or turned far enough since the last keyframe."""
        o = self._settings.odometry
        T_last_now = self._last_keyframe.inverse() @ T_odom_body
        moved = np.linalg.norm(T_last_now.t) > o.keyframe_m or T_last_now.angle() > o.keyframe_rad
        return bool(moved) or not self._keyframes

    def _extend_map(self, segments: Segments, t_s: Array, T_dense: SE3) -> None:
        if len(segments) == 0:
            return
        self._last_keyframe = T_dense[-1]
        ends = (segments.a_s, segments.a_body), (segments.b_s, segments.b_body)
        ends_odom = np.concatenate([place_points(t_s, T_dense.R, T_dense.t, *end) for end in ends])
        seen_from = T_dense.t[-1].copy()
        self._map.add(ends_odom, seen_from)
        self._keyframes.append((ends_odom, seen_from))
        longest = self._settings.odometry.longest_map(with_imu=self._chain is None)
        if len(self._keyframes) > longest:
            self._map.remove(*self._keyframes.popleft())


def _updated(prediction: Prediction, fit: FrameFit, *, lost: bool, first: bool) -> MotionState:
    if lost or first:
        return prediction.end
    return prediction.end.corrected(fit.delta[END], fit.P[END, END])
