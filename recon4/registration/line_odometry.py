"""Multi-frame CLS odometry as the documents have it (V §2.4-2.6, Velas 2016 Alg. 1)."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

import numpy as np

from recon4.geometry.lines import Lines
from recon4.geometry.se3 import SE3, interpolate, mean_rotation, so3_exp, so3_log
from recon4.kernels.imu import place_points
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.collar_lines import LineTarget, register_lines
from recon4.registration.motion import ImuMotion
from recon4.registration.odometry import OdometryStep
from recon4.registration.result import Registration
from recon4.registration.segments import Segments, sample_segments
from recon4.settings import Settings

_PREDICTOR = 3
"""Motions the linear predictor looks back on (requirements A3.2)."""
_PASSES = 2
"""Correct the rolling shutter, register, correct again (V §2.6)."""


class LineOdometry:
    """Registers each multiframe against the lines of the last ones.

    The motion is predicted by the linear predictor, its rotation by the gyroscope if there is one
    and the settings allow it. Within the frame the motion is interpolated (V Eq. 2.8).
    """

    def __init__(self, rig: Rig, settings: Settings, imu: ImuSamples | None = None) -> None:
        self._rig, self._settings = rig, settings
        with_imu = imu is not None and len(imu) > 1 and settings.odometry.use_imu
        self._imu = ImuMotion(imu, rig, settings.odometry) if with_imu and imu else None
        self._history: deque[Lines] = deque(maxlen=settings.odometry.history)
        self._motions: deque[SE3] = deque(maxlen=_PREDICTOR)
        self._T_odom_start = SE3.identity()

    def push(self, frame: Multiframe) -> OdometryStep:
        """Register the next multiframe; frames come in the order of their time."""
        segments = sample_segments(frame, self._rig, self._settings.segments)
        duration_s = frame.duration_ns * 1e-9
        predicted = self._predicted_motion(frame)
        motion, found = predicted, None
        for _ in range(_PASSES if self._history else 1):
            lines = self._lines(segments, self._T_odom_start, motion, duration_s)
            if self._history:
                found = self._register(lines)
                # The step moves the whole frame; what it adds to the motion is its end.
                moved_end = found.T_target_source @ self._T_odom_start @ motion
                motion = self._T_odom_start.inverse() @ moved_end
        return self._finish(frame, segments, predicted, motion=motion, found=found)

    def _predicted_motion(self, frame: Multiframe) -> SE3:
        """``T_start_end`` of the frame: newest motion heaviest, weights N…1 over their sum."""
        if not self._motions:
            motion = SE3.identity()
        else:
            w = np.arange(1, len(self._motions) + 1, dtype=np.float64)
            T = SE3.stack(self._motions)
            motion = SE3(so3_exp(w @ so3_log(T.R) / w.sum()), w @ T.t / w.sum())
        if self._imu and self._imu.covers(frame.t_ns, frame.t_ns + frame.duration_ns):
            return SE3(self._imu.turn(frame.t_ns, frame.t_ns + frame.duration_ns), motion.t)
        return motion

    def _lines(
        self, segments: Segments, T_odom_start: SE3, motion: SE3, duration_s: float
    ) -> Lines:
        t_s = np.array([0.0, duration_s])
        T = SE3.stack([T_odom_start, T_odom_start @ motion])
        a = place_points(t_s, T.R, T.t, segments.a_s, segments.a_body)
        b = place_points(t_s, T.R, T.t, segments.b_s, segments.b_body)
        apart = np.linalg.norm(b - a, axis=1) > 1e-6
        return Lines.through(a[apart], b[apart])

    def _register(self, lines: Lines) -> Registration:
        if self._settings.odometry.history_mode == "averaged":
            return averaged([self._register_to(old, lines) for old in self._history])
        joined = Lines(
            np.concatenate([old.mid for old in self._history]),
            np.concatenate([old.dir for old in self._history]),
        )
        return self._register_to(joined, lines)

    def _register_to(self, target: Lines, lines: Lines) -> Registration:
        settings = self._settings.registration
        return register_lines(
            LineTarget(target), lines, guess=SE3.identity(), portion=settings.portion,
            settings=settings,
        )  # fmt: skip

    def _finish(
        self,
        frame: Multiframe,
        segments: Segments,
        predicted: SE3,
        *,
        motion: SE3,
        found: Registration | None,
    ) -> OdometryStep:
        o = self._settings.odometry
        lost = found is not None and not (found.converged and found.error_m < o.lost_error_m)
        used = predicted if lost else motion
        duration_s = frame.duration_ns * 1e-9
        lines = self._lines(segments, self._T_odom_start, used, duration_s)
        # An empty first frame would leave nothing for any later one to match.
        if not lost and len(lines):
            self._history.append(lines)
        self._motions.append(used)
        T_start, T_end = self._T_odom_start, self._T_odom_start @ used
        self._T_odom_start = T_end
        ends_ns = np.array([frame.t_ns, frame.t_ns + frame.duration_ns], np.int64)
        nan = float("nan")
        return OdometryStep(
            frame.frame_id,
            frame.t_mid_ns,
            interpolate(T_start, T_end, 0.5),
            ends_ns,
            SE3.stack([T_start, T_end]),
            found.error_m if found else nan,
            found.share if found else 0.0,
            found.iterations if found else 0,
            found.converged if found else True,
            found.degeneracy if found else 0.0,
            float(np.linalg.norm(motion.t - predicted.t)),
            lost,
            np.diag(np.repeat([o.line_sd_rad, o.line_sd_m], 3) ** 2),
        )


def averaged(found: list[Registration]) -> Registration:
    """The simple mean of the poses that converged (V §3.1); rotations after Markley."""
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
