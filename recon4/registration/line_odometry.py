"""Multi-frame CLS odometry as in the documents (V §2.4-2.6, Velas 2016 Alg. 1)."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.lines import Lines
from recon4.geometry.se3 import SE3, interpolate, mean_rotation, so3_exp, so3_log
from recon4.kernels.imu import place_points
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.collar_lines import LineTarget, register_lines
from recon4.registration.motion import ImuMotion
from recon4.registration.overlap import RangeImage, make_range_image, overlap
from recon4.registration.result import Registration
from recon4.registration.scan_chain import body_points
from recon4.registration.segments import Segments, sample_segments
from recon4.registration.step import OdometryStep
from recon4.registration.tuning import OdometryTuning, registration_tuning
from recon4.registration.tuning_matching import LINE_ODOMETRY
from recon4.settings.reads import OdometryReads
from recon4.settings.tuning import tuned


@dataclass(frozen=True, slots=True, eq=False)
class _HistoryFrame:
    """A multiframe that later ones are registered to."""

    T_odom_body: SE3
    """Pose at its middle."""
    target: LineTarget
    """Its lines in odom."""
    view: RangeImage
    """Its points as measured, in the body: for the overlap."""


class LineOdometry:
    """Registers each multiframe against the lines of the last ones.

    The linear predictor predicts the motion from the middle of one multiframe to the middle of the
    next; the gyroscope predicts its rotation if there is one and the settings allow it. This
    motion undistorts the frame (V Eq. 2.8). The registration moves the whole frame and improves
    the motion; then both steps are repeated. The fraction of matches kept is the overlap (V §2.5).
    """

    def __init__(self, rig: Rig, settings: OdometryReads, imu: ImuSamples | None = None) -> None:
        self._rig, self._settings = rig, settings
        with_imu = imu is not None and len(imu) > 1 and settings.odometry.use_imu
        self._imu = ImuMotion(imu, rig, settings.odometry) if with_imu and imu else None
        self._history: deque[_HistoryFrame] = deque(maxlen=settings.odometry.history)
        self._motions: deque[SE3] = deque(maxlen=LINE_ODOMETRY.predictor)
        self._T_odom_body, self._t_mid_ns = SE3.identity(), 0

    def push(self, frame: Multiframe) -> OdometryStep:
        """Register the next multiframe; frames come in the order of their time."""
        segments = sample_segments(frame, self._rig)
        view = make_range_image(body_points(frame, self._rig))
        steps = (frame.t_mid_ns - self._t_mid_ns) / frame.duration_ns if self._history else 1.0
        predicted = motion = self._predicted_motion(frame)
        T_predicted = T_odom_body = self._T_odom_body @ _times(motion, steps)
        found = None
        for _ in range(LINE_ODOMETRY.passes if self._history else 1):
            lines = self._lines(segments, frame, T_odom_body, motion=motion)
            if self._history:
                found = self._register(lines, view, T_odom_body)
                T_odom_body = found.T_target_source @ T_odom_body
                motion = _times(self._T_odom_body.inverse() @ T_odom_body, 1.0 / steps)
        prediction_offset_m = float(np.linalg.norm(T_odom_body.t - T_predicted.t))
        lost = found is not None and self._is_lost(found)
        if lost:
            motion, T_odom_body = predicted, T_predicted
        lines = self._lines(segments, frame, T_odom_body, motion=motion)
        # An empty first frame would leave nothing for any later one to match.
        if not lost and len(lines):
            self._history.append(_HistoryFrame(T_odom_body, LineTarget(lines), view))
        if found is not None:
            self._motions.append(motion)
        self._T_odom_body, self._t_mid_ns = T_odom_body, frame.t_mid_ns
        return self._step(frame, motion, found, prediction_offset_m=prediction_offset_m, lost=lost)

    def _predicted_motion(self, frame: Multiframe) -> SE3:
        """Predicted motion over one multiframe: mean of the last ones, weights 1…N over their sum.

        The newest motion has the largest weight.
        """
        motion = SE3.identity()
        if self._motions:
            w = np.arange(1, len(self._motions) + 1, dtype=np.float64)
            T = SE3.stack(self._motions)
            motion = SE3(so3_exp(w @ so3_log(T.R) / w.sum()), w @ T.t / w.sum())
        start_ns, end_ns = frame.t_mid_ns - frame.duration_ns, frame.t_mid_ns
        if self._imu and self._imu.covers(start_ns, end_ns):
            return SE3(self._imu.turn(start_ns, end_ns), motion.t)
        return motion

    def _lines(
        self, segments: Segments, frame: Multiframe, T_odom_body: SE3, *, motion: SE3
    ) -> Lines:
        """Lines in odom, undistorted with a constant motion over the frame."""
        t_s = np.array([0.0, frame.duration_ns * 1e-9])
        T = T_odom_body @ SE3.stack([_times(motion, -0.5), _times(motion, 0.5)])
        a = place_points(t_s, T.R, T.t, segments.a_s, segments.a_body)
        b = place_points(t_s, T.R, T.t, segments.b_s, segments.b_body)
        apart = np.linalg.norm(b - a, axis=1) > 1e-6
        return Lines.through(a[apart], b[apart])

    def _register(self, lines: Lines, view: RangeImage, T_odom_body: SE3) -> Registration:
        """Register the frame to the joined history, or to each of its frames and average."""
        overlaps = [
            overlap(
                observed.view,
                view,
                observed.T_odom_body.inverse() @ T_odom_body,
            )
            for observed in self._history
        ]
        if self._settings.odometry.history_mode == "averaged":
            targets = [observed.target for observed in self._history]
            return averaged(
                [
                    self._register_to(target, lines, overlap_ratio)
                    for target, overlap_ratio in zip(targets, overlaps, strict=True)
                ]
            )
        joined = Lines(
            np.concatenate([observed.target.lines.mid for observed in self._history]),
            np.concatenate([observed.target.lines.dir for observed in self._history]),
        )
        return self._register_to(LineTarget(joined), lines, max(overlaps))

    def _register_to(self, target: LineTarget, lines: Lines, overlap_ratio: float) -> Registration:
        settings = registration_tuning(self._settings.registration)
        # A scan too sparse to fill the bins of a view volume has an overlap of 0.
        overlap_ratio = max(overlap_ratio, settings.portion)
        return register_lines(
            target, lines, initial=SE3.identity(), portion=overlap_ratio, settings=settings
        )

    def _is_lost(self, found: Registration) -> bool:
        return not (
            found.converged
            and found.error_m < tuned(OdometryTuning, self._settings.odometry).lost_error_m
        )

    def _step(
        self,
        frame: Multiframe,
        motion: SE3,
        found: Registration | None,
        *,
        prediction_offset_m: float,
        lost: bool,
    ) -> OdometryStep:
        o = tuned(OdometryTuning, self._settings.odometry)
        dense_ns = [frame.t_ns, frame.t_mid_ns, frame.t_ns + frame.duration_ns]
        return OdometryStep(
            frame.frame_id,
            frame.t_mid_ns,
            self._T_odom_body,
            np.array(dense_ns, np.int64),
            self._T_odom_body @ SE3.stack(_times(motion, s) for s in (-0.5, 0.0, 0.5)),
            found.error_m if found else float("nan"),
            found.match_ratio if found else 0.0,
            found.iterations if found else 0,
            found.converged if found else True,
            found.degeneracy if found else 0.0,
            prediction_offset_m,
            lost,
            np.diag(np.repeat([o.line_sd_rad, o.line_sd_m], 3) ** 2),
        )


def _times(motion: SE3, factor: float) -> SE3:
    """Scale a motion by a factor (V Eq. 2.8)."""
    return interpolate(SE3.identity(), motion, np.array([factor]))[0]


def averaged(found: list[Registration]) -> Registration:
    """Mean of the poses that converged (V §3.1); rotations after Markley."""
    good = [one for one in found if one.converged]
    if not good:
        return found[-1]
    T = SE3.stack(one.T_target_source for one in good)
    return replace(
        good[-1],
        T_target_source=SE3(mean_rotation(T.R), T.t.mean(axis=0)),
        error_m=float(np.mean([one.error_m for one in good])),
        iterations=max(one.iterations for one in good),
    )
