"""Maps multiframes during a capture and reports the result as messages. No clocks, no sockets.

The messages are those of ``docs/how-to/live.md``; arrays are base64.

A rotation of the IMU about an axis shows in turns about the others, a position along it in the
acceleration that a lever arm of 1 m would have, a clock in the change of the turn rate. LiDARs that
see walls are known better than the IMU, so it stands for all.
"""

from __future__ import annotations

from collections import deque
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3, Array, skew, so3_log
from recon4.kernels.imu import place_points
from recon4.live.ipc.messages import PlanSchedule, Snapshot, gaps_message, points_message
from recon4.live.mapper.live_intensity import LiveIntensity
from recon4.live.mapper.loops import LoopGate
from recon4.live.mapper.place_index import PlaceIndex
from recon4.live.mapper.recovery import Recovery
from recon4.live.mapper.shown_path import RecentCounts, ShownPath
from recon4.live.mapper.tracker import Tracker
from recon4.live.mapper.tuning import LIVE_MAP, MOTION_WATCH
from recon4.live.preview.cloud import PreviewCloud
from recon4.live.preview.coverage import Coverage
from recon4.live.protocol import Axis, Gaps, Loop, MapperMessage, Motion, Points, Pose
from recon4.live.protocol import Path as PathMessage
from recon4.model.multiframe import Multiframe
from recon4.model.plain import finite_or_none
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.segments import sample_segments
from recon4.registration.step import OdometryStep
from recon4.settings import Settings


class LiveMap:
    """The map of a running capture; memory grows slowly with the area seen."""

    def __init__(self, rig: Rig, settings: Settings, *, scratch: Path | None = None) -> None:
        """Start with an empty map.

        Args:
            rig: The sensors of the backpack.
            settings: Settings of odometry and registration.
            scratch: Folder of the spill file; None = the system's temporary folder.
        """
        self._rig, self._settings = rig, settings
        self._scratch = scratch
        self.tracker = Tracker(rig, settings)
        self._preview = PreviewCloud()
        self._intensity = LiveIntensity(len(rig.sensors))
        self._motion = MotionWatch()
        self._relocated = 0
        self._recent = RecentCounts()
        self._offsets_m: deque[tuple[int, float]] = deque()
        """Time and prediction offset of each recent multiframe."""
        self._summary_ns = 0
        self._reset()

    def _reset(self) -> None:
        """Reset the map, except the preview, whose generation continues."""
        self._coverage = Coverage()
        self._places = PlaceIndex(self._settings, scratch=self._scratch)
        self._path = ShownPath()
        self._lost = self._lost_steps = 0
        self._recovery: Recovery | None = None
        self._gate = LoopGate()
        self._loop = Loop(near=False, closed=False)
        self._plan = PlanSchedule()
        self._gaps = Gaps([], well=None, elsewhere=0)

    def extend_imu(self, imu: ImuSamples) -> None:
        """Add IMU samples."""
        self.tracker.extend_imu(imu)

    def thin(self, frame: Multiframe) -> None:
        """Count a multiframe that is left out because of latency; the recording contains it."""
        self._recent.add(frame.t_ns, left_out=True)

    def push(self, frame: Multiframe) -> tuple[Pose, list[MapperMessage]]:
        """Map a multiframe.

        Returns:
            The pose, and further messages: ``path`` after a map reset, ``points`` when there are
            new ones, about once a second ``plan``, ``gaps``, ``loop`` and ``motion``.
        """
        self._recent.add(frame.t_ns)
        interrupted = self.tracker.interrupted(frame)
        step = self.tracker.restart(frame) if interrupted else self.tracker.push(frame)
        messages: list[MapperMessage] = []
        if self.tracker.map_reset:
            self._reset()
            self._preview.reset()
            messages.append(PathMessage([]))
        self._motion.push(step)
        step, lost = self._resume(frame, step) if interrupted else self._follow(frame, step)
        T_map_body = self.tracker.T_map_odom @ step.T_odom_body
        pose = self._pose(frame, step, T_map_body, lost=lost)
        if lost:
            return pose, messages
        self._path.extend(T_map_body.t)
        self.tracker.last_known.set(T_map_body, frame.t_ns + frame.duration_ns)
        messages += self._add_points(frame, step)
        if frame.t_ns - self._summary_ns >= LIVE_MAP.summary_every_ns:
            self._summary_ns = frame.t_ns
            messages += self._summary(frame, T_map_body, step)
        return pose, messages

    def snapshot(self) -> Snapshot:
        """The current state, for clients that connect late."""
        chunk = self._preview.since(0) if len(self._preview) else None
        others: list[MapperMessage] = [*self._plan.newest, self._gaps, self._loop]
        others.append(self._motion.message())
        return Snapshot(list(self._path.places), chunk, others)

    def _resume(self, frame: Multiframe, step: OdometryStep) -> tuple[OdometryStep, bool]:
        """After a pause: assume the position of its start until relocalization confirms it."""
        self._recovery = self._recover(frame, step, expected=True)
        self._lost, self._lost_steps = int(self._recovery is not None), 0
        return step, self._recovery is not None

    def _recover(self, frame: Multiframe, step: OdometryStep, *, expected: bool) -> Recovery | None:
        """Search the place where the odometry began again; None without places.

        Args:
            frame: Its first multiframe.
            step: The result of that.
            expected: Whether the body may not have moved since it was lost.
        """
        tracker = self.tracker
        end_ns = frame.t_ns + frame.duration_ns
        reach = tracker.last_known.reach(step.T_odom_body, end_ns, with_imu=tracker.with_imu)
        if reach is None or not len(self._places):
            return None
        return Recovery(self._places, reach, expected=tracker.T_map_odom if expected else None)

    def _follow(self, frame: Multiframe, step: OdometryStep) -> tuple[OdometryStep, bool]:
        """The step to continue with, and whether tracking is lost.

        The odometry recovers from a few lost multiframes by itself. After `LIVE_MAP.search_after`
        of them it restarts, and its views are relocalized in the map so far. Until that succeeds
        nothing is added to the map.
        """
        self._lost_steps = self._lost_steps + 1 if step.lost else 0
        self._lost = self._lost + 1 if step.lost or self._recovery else 0
        if self._lost_steps >= LIVE_MAP.search_after:
            step = self.tracker.restart(frame)
            self._lost_steps = 0
            paused = self._recovery is not None and self._recovery.is_expected
            self._recovery = self._recover(frame, step, expected=paused)
            return step, True
        if self._recovery is None or step.lost:
            return step, step.lost
        if self._lost % LIVE_MAP.search_after:
            return step, True
        found = self._recovery.search(self._midpoints(frame), step.T_odom_body)
        if found is None:
            return step, True
        self.tracker.T_map_odom, self._recovery = found, None
        self._lost, self._relocated = 0, self._relocated + 1
        return step, False

    def _midpoints(self, frame: Multiframe) -> Array:
        segments = sample_segments(frame, self._rig)
        return (segments.a_body + segments.b_body) / 2

    def _pose(self, frame: Multiframe, step: OdometryStep, T_map_body: SE3, *, lost: bool) -> Pose:
        R = T_map_body.R
        offset_m = self._largest_offset_m(frame.t_ns, step.prediction_offset_m)
        return Pose(
            frame_id=frame.frame_id,
            t_ns=frame.t_ns + frame.duration_ns,
            p=[round(float(v), 3) for v in T_map_body.t],
            yaw=round(float(np.arctan2(R[1, 0], R[0, 0])), 4),
            lost=lost,
            lost_frames=self._lost,
            relocated=self._relocated,
            error_m=finite_or_none(step.error_m, 4),
            match_ratio=finite_or_none(step.match_ratio, 4),
            weak_sd_m=None if step.stationary else finite_or_none(step.weak_sd_m, 4),
            prediction_offset_m=finite_or_none(offset_m, 4),
            turn_rad_s=finite_or_none(_turn_rate(step), 4),
            points=np.bincount(frame.sensor, minlength=len(self._rig.sensors)).tolist(),
            thinned=self._recent.thinned,
            lately=self._recent.message(frame.t_ns),
            imu=self.tracker.with_imu,
            remark=self.tracker.remark,
            imu_turn=self.tracker.repairs.turn,
            imu_axes=self.tracker.repairs.axes,
        )

    def _largest_offset_m(self, t_ns: int, prediction_offset_m: float) -> float:
        """Largest prediction offset of the last seconds, so that the warning stays readable."""
        self._offsets_m.append((t_ns, prediction_offset_m))
        while t_ns - self._offsets_m[0][0] > LIVE_MAP.offset_shown_ns:
            self._offsets_m.popleft()
        return max(prediction_offset_m for _, prediction_offset_m in self._offsets_m)

    def _add_points(self, frame: Multiframe, step: OdometryStep) -> list[Points]:
        rows = np.arange(0, len(frame), max(1, len(frame) // LIVE_MAP.preview_points))
        part = frame.take(rows)
        T_map_dense = self.tracker.T_map_odom @ step.T_dense
        t_s = (step.t_ns - frame.t_ns).astype(np.float64) * 1e-9
        dt_s = part.dt_ns.astype(np.float64) * 1e-9
        p_map = place_points(t_s, T_map_dense.R, T_map_dense.t, dt_s, _in_body(part, self._rig))
        range_m = np.linalg.norm(part.xyz, axis=1).astype(np.float64)
        values = self._intensity.normalize(part.intensity, part.sensor, part.ring, range_m=range_m)
        every = max(1, len(p_map) // LIVE_MAP.coverage_rays)
        self._coverage.add(T_map_dense.t[-1], p_map[::every])
        chunk = self._preview.add(p_map, values)
        return [] if chunk is None else [points_message(chunk)]

    def _summary(
        self, frame: Multiframe, T_map_body: SE3, step: OdometryStep
    ) -> list[MapperMessage]:
        segments = sample_segments(frame, self._rig)
        ends = np.concatenate([segments.a_body, segments.b_body])
        self._close_loop(self._midpoints(frame), T_map_body, step)
        self._places.keep(self.tracker.T_map_odom @ step.T_odom_body, ends)
        self._coverage.refresh()
        self._gaps = gaps_message(self._coverage)
        plan = self._plan.due(self._coverage, frame.t_ns)
        return [*plan, self._gaps, self._loop, self._motion.message()]

    def _close_loop(self, source: Array, T_map_body: SE3, step: OdometryStep) -> None:
        """Recognize a place visited before and correct the drift of the map."""
        start_m = np.array(self._path.places[0])
        place = self._places.revisited(
            T_map_body.t, within_m=LIVE_MAP.loop_within_m, walked_before_m=LIVE_MAP.loop_walked_m
        )
        found = None if place is None else self._places.locate(source, T_map_body, place)
        drifted = self._gate.judge(found, T_map_body)
        self._loop = Loop(
            near=place is not None,
            closed=self._gate.closed,
            drift_m=round(self._gate.drift_m, 3) if self._gate.closed else None,
            walked_m=round(self._places.walked_m, 1),
            start_m=round(float(np.linalg.norm(T_map_body.t - start_m)), 1),
        )
        if drifted and found is not None:
            self.tracker.move(found.T_target_source, step)


def _in_body(frame: Multiframe, rig: Rig) -> Array:
    T = rig.T_body_sensor[frame.sensor.astype(np.intp)]
    p: Array = np.einsum("nij,nj->ni", T.R, frame.xyz.astype(np.float64)) + T.t
    return p


def _turn_rate(step: OdometryStep) -> float:
    """Largest turn rate within the frame [rad/s]."""
    if len(step.t_ns) < 2:
        return 0.0
    between = step.T_dense[:-1].inverse() @ step.T_dense[1:]
    seconds = np.maximum(np.diff(step.t_ns) * 1e-9, 1e-3)
    return float(np.max(between.angle() / seconds))


_NAMES = (*(("rotation", axis) for axis in "xyz"), *(("position", axis) for axis in "xyz"))


class MotionWatch:
    """Adds up over the multiframes what their motion shows."""

    def __init__(self) -> None:
        self._info = np.zeros(7)
        """Information on rotation and position about x, y, z of the body, and clock, (7,)."""
        self._last: OdometryStep | None = None
        self._rate: Array | None = None
        """Turn rate before [rad/s], (3,)."""
        self._still_s = self._longest_still_s = 0.0
        self._turned = np.zeros(2)
        """To the left and to the right [rad], (2,)."""
        self._tilts: Array | None = None
        """Least and most of the vertical along x and y of the body, (2, 2)."""

    def push(self, step: OdometryStep) -> None:
        """Add a multiframe; one that is lost says nothing."""
        before, self._last = self._last, step
        seconds = (step.t_mid_ns - before.t_mid_ns) * 1e-9 if before else 0.0
        if (
            step.lost
            or before is None
            or before.lost
            or not 0.0 < seconds <= MOTION_WATCH.longest_s
        ):
            self._rate = None
            return
        R_before, R = before.T_odom_body.R, step.T_odom_body.R
        rate = so3_log(R_before.T @ R) / seconds
        shift_m = step.T_odom_body.t - before.T_odom_body.t
        speed = float(np.linalg.norm(shift_m)) / seconds
        self._stand(
            np.linalg.norm(rate) < MOTION_WATCH.still_rad_s and speed < MOTION_WATCH.still_m_s,
            seconds,
        )
        turned = float((R @ rate)[2]) * seconds
        self._turned += [max(turned, 0.0), max(-turned, 0.0)]
        self._tilt(R)
        if self._rate is not None:
            self._learn(rate, (rate - self._rate) / seconds)
        self._rate = rate

    def message(self) -> Motion:
        """What was shown so far."""
        with np.errstate(divide="ignore"):
            sd = np.where(self._info > 0.0, self._info**-0.5, np.inf)
        tuning = MOTION_WATCH
        enough = np.repeat([tuning.enough_rad, tuning.enough_m, tuning.enough_s], [3, 3, 1])
        done = np.minimum((enough / sd) ** 2, 1.0)
        tilts = np.zeros(2) if self._tilts is None else np.rad2deg(np.ptp(self._tilts, axis=0))
        left, right = np.rad2deg(self._turned).tolist()
        return Motion(
            still_s=round(self._longest_still_s, 1),
            tilt_deg=[round(float(v), 1) for v in tilts],
            turned_deg=[round(left), round(right)],
            axes=[
                Axis(quantity=quantity, axis=axis, shown=round(float(part), 2))
                for (quantity, axis), part in zip((*_NAMES, ("clock", "")), done, strict=True)
            ],
        )

    def _stand(self, still: bool | np.bool_, seconds: float) -> None:
        self._still_s = self._still_s + seconds if still else 0.0
        self._longest_still_s = max(self._longest_still_s, self._still_s)

    def _tilt(self, R_odom_body: Array) -> None:
        """Widen the extremes of the tilt to the front and to the sides."""
        tilt = np.arcsin(np.clip(R_odom_body[2, :2], -1.0, 1.0))
        low, high = (tilt, tilt) if self._tilts is None else self._tilts
        self._tilts = np.stack([np.minimum(low, tilt), np.maximum(high, tilt)])

    def _learn(self, rate: Array, change: Array) -> None:
        lever = skew(change) + skew(rate) @ skew(rate)
        self._info[:3] += (rate @ rate - rate**2) / MOTION_WATCH.sd_rad_s**2
        self._info[3:6] += (lever**2).sum(axis=0) / MOTION_WATCH.sd_m_s2**2
        self._info[6] += change @ change / MOTION_WATCH.sd_rad_s2**2
