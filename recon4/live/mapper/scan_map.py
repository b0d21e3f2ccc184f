"""Maps the scans of a 2-D laser during a capture and reports the result as messages.

No clocks, no sockets. The odometry is that of ``recon4 process``; the messages are those of LiDARs.
With a profiler the plan shows what its line scans have covered.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se2 import compose, inverse, to_se3, transform, wrap
from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.live.ipc.messages import PlanSchedule, Snapshot, gaps_message, points_message
from recon4.live.mapper.live_attitude import LiveAttitude
from recon4.live.mapper.loops import LoopGate
from recon4.live.mapper.scan_places import ScanPlaces
from recon4.live.mapper.scan_tracker import ScanStep, ScanTracker
from recon4.live.mapper.shown_path import RecentCounts, ShownPath
from recon4.live.mapper.swept_lines import SweptLines
from recon4.live.mapper.tuning import SCAN_MAP
from recon4.live.preview.cloud import PreviewCloud
from recon4.live.preview.coverage import Coverage
from recon4.live.preview.tuning import PLAN_TILES
from recon4.live.protocol import Gaps, Loop, MapperMessage, Path, Points, Pose
from recon4.model.laser_scans import LaserScans
from recon4.model.laser_upright import is_upside_down, seen_from_above, turned_round
from recon4.model.multiframe import Multiframe
from recon4.model.plain import finite_or_none
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.tuning import OBSERVATION
from recon4.profiler.tuning import LineTuning
from recon4.settings import Settings
from recon4.settings.tuning import tuned
from recon4.slam2d.tuning import Slam2dTuning

_RESTARTED = "restarted"


class ScanMap:
    """The map of a running capture with a 2-D laser; memory grows slowly with the path."""

    def __init__(self, rig: Rig, settings: Settings) -> None:
        """Start with an empty map.

        Args:
            rig: With a 2-D laser, and perhaps a profiler.
            settings: Groups ``slam2d`` and ``loops2d``.
        """
        row = rig.row_of("laser2d")
        assert row is not None
        self._rig, self._laser = rig, seen_from_above(rig.sensors[row])
        self._is_upside_down = is_upside_down(rig.sensors[row].T_body_sensor)
        self._tracker = ScanTracker(self._laser, tuned(Slam2dTuning, settings.slam2d))
        self._attitude = LiveAttitude(rig)
        self._coverage, self._preview = Coverage(), PreviewCloud()
        self._places, self._gate = ScanPlaces(settings), LoopGate()
        self._lines: SweptLines | None = None
        if rig.row_of("profiler") is not None:
            self._lines = SweptLines(rig, min_range_m=tuned(LineTuning, settings.lines).min_range_m)
        self._T_map_odom = np.zeros(3)
        self._path, self._recent = ShownPath(), RecentCounts()
        self._scans = self._lost = self._relocated = 0
        self._tracked_ns = 0
        self._restarted = False
        """Whether the part of the map since a restart is not yet joined to the rest."""
        self._shown_ns = self._summary_ns = self._redrawn_ns = self._tried = 0
        self._stale = False
        """Whether keyframes moved since plan and preview were made."""
        self._loop = Loop(near=False, closed=False)
        self._gaps = Gaps([], well=None, elsewhere=0)
        self._plan = PlanSchedule()

    def extend_imu(self, imu: ImuSamples) -> None:
        """Add IMU samples."""
        self._attitude.extend(imu)

    def thin(self, scan: LaserScans) -> None:
        """Count a scan that is left out because of latency; the recording contains it."""
        self._recent.add(int(scan.t_ns[0]), left_out=True)

    def push(self, scan: LaserScans) -> tuple[Pose, list[MapperMessage]]:
        """Map a scan.

        Returns:
            The pose, and further messages: ``points`` when there are new ones, about once a second
            ``plan``, ``gaps`` and ``loop``.
        """
        self._scans += 1
        if self._is_upside_down:
            scan = turned_round(scan)
        step = self._tracker.push(scan, self._attitude)
        self._recent.add(step.t_ns)
        self._follow(step)
        T_map_laser = compose(self._T_map_odom, step.pose)
        T_map_body = self._body(T_map_laser, step)
        pose = self._pose(step, T_map_body)
        if step.lost:
            return pose, []
        self._tracked_ns = step.t_ns
        self._path.extend(T_map_body.t)
        messages = self._show(step, T_map_laser)
        if step.keyframe:
            self._places.keep(T_map_laser, step.seen)
        if step.t_ns - self._summary_ns >= SCAN_MAP.summary_every_ns:
            self._summary_ns = step.t_ns
            messages += self._summary(step, T_map_laser)
        return pose, messages

    def sweep(self, frame: Multiframe) -> list[MapperMessage]:
        """Add a multiframe of a profiler; its lines are placed once their poses are known."""
        if self._lines is None:
            return []
        self._lines.push(frame)
        return self._add_lines()

    def snapshot(self) -> Snapshot:
        """The current state, for clients that connect late."""
        chunk = self._preview.since(0) if len(self._preview) else None
        return Snapshot(
            list(self._path.places), chunk, [*self._plan.newest, self._gaps, self._loop]
        )

    # -- pose

    def _follow(self, step: ScanStep) -> None:
        """Count lost scans; a restarted local map is joined by the next loop closure."""
        if step.restarted:
            seconds = (step.t_ns - self._tracked_ns) * 1e-9 if self._tracked_ns else 0.0
            self._places.restart(SCAN_MAP.fastest_m_s * seconds)
            self._restarted = len(self._places) > 0
        if not step.lost and self._lost:
            self._relocated += 1
        self._lost = self._lost + 1 if step.lost else 0

    def _body(self, T_map_laser: Array, step: ScanStep) -> SE3:
        """``T_map_body``: heading and place by the laser, roll and pitch by the IMU.

        The body's height is zero.
        """
        T_body_laser = self._laser.T_body_sensor
        R_world_body = np.eye(3)
        if step.with_imu:
            at = np.array([step.t_ns], np.int64)
            R_world_body = self._attitude.trajectory().at(at, slack_ns=100_000_000).R[0]
        R_world_laser = R_world_body @ T_body_laser.R
        turn = float(T_map_laser[2]) - _yaw(R_world_laser)
        R_map_body = so3_exp([0.0, 0.0, turn]) @ R_world_body
        shift = R_map_body @ T_body_laser.t
        T = SE3(R_map_body, np.array([*(T_map_laser[:2] - shift[:2]), 0.0]))
        if self._lines is not None and not step.lost:
            self._lines.add_pose(step.t_ns, turn, T.t[:2])
        return T

    def _pose(self, step: ScanStep, T_map_body: SE3) -> Pose:
        yaw = _yaw(T_map_body.R)
        along = ""
        if not step.lost and step.weak_sd_m > OBSERVATION.weak_sd_m and self._scans > 1:
            off = float(wrap(np.array(step.weak_rad + self._T_map_odom[2] - yaw)))
            along = "along" if abs(np.cos(off)) > np.sqrt(0.5) else "across"
        return Pose(
            frame_id=self._scans - 1,
            t_ns=step.end_ns,
            p=[round(float(v), 3) for v in T_map_body.t],
            yaw=round(yaw, 4),
            lost=step.lost,
            lost_frames=self._lost,
            relocated=self._relocated,
            error_m=None,
            match_ratio=None if step.lost or self._scans == 1 else round(step.match_ratio, 4),
            weak_sd_m=finite_or_none(step.weak_sd_m, 4) if self._scans > 1 else None,
            prediction_offset_m=None,
            turn_rad_s=finite_or_none(step.turn_rad_s, 4),
            points=[len(step.seen.points)],
            thinned=self._recent.thinned,
            lately=self._recent.message(step.t_ns),
            imu=step.with_imu,
            remark=_RESTARTED if self._restarted else self._attitude.remark,
            unobserved=along,
        )

    # -- what is shown

    def _show(self, step: ScanStep, T_map_laser: Array) -> list[MapperMessage]:
        """Add the returns of a scan, and the lines whose poses are known now."""
        messages: list[MapperMessage] = []
        if step.t_ns - self._shown_ns >= SCAN_MAP.shown_every_ns:
            self._shown_ns = step.t_ns
            seen = step.seen.points[:: max(1, len(step.seen.points) // SCAN_MAP.rays)]
            height_m = float(self._laser.T_body_sensor.t[2])
            at = np.array([T_map_laser[0], T_map_laser[1], height_m])
            ends = _raised(transform(T_map_laser, seen), height_m)
            self._coverage.add(at, ends) if self._lines is None else self._clear(at, ends)
            messages += self._add_points(ends, np.full(len(ends), SCAN_MAP.laser_value, np.uint8))
        return messages + self._add_lines()

    def _clear(self, at: Array, ends: Array) -> None:
        """With a profiler the 2-D laser says where there is space, not what was covered."""
        ray = ends - at
        length = np.linalg.norm(ray, axis=1, keepdims=True)
        far = length[:, 0] > 2.0 * PLAN_TILES.cell_m
        shorter = at + ray * (1.0 - 1.5 * PLAN_TILES.cell_m / np.maximum(length, PLAN_TILES.cell_m))
        self._coverage.add(at, shorter[far], solid=False)

    def _add_lines(self) -> list[MapperMessage]:
        messages: list[MapperMessage] = []
        if self._lines is None:
            return messages
        for placed in self._lines.ready(self._attitude):
            self._coverage.add(placed.from_m, placed.rays)
            messages += self._add_points(placed.points, placed.values)
        return messages

    def _add_points(self, p_map: Array, values: NDArray[np.uint8]) -> list[Points]:
        chunk = self._preview.add(p_map, values)
        return [] if chunk is None else [points_message(chunk)]

    def _summary(self, step: ScanStep, T_map_laser: Array) -> list[MapperMessage]:
        self._close_loop(T_map_laser)
        messages: list[MapperMessage] = []
        if self._stale and step.t_ns - self._redrawn_ns >= SCAN_MAP.redraw_every_ns:
            self._stale, self._redrawn_ns = False, step.t_ns
            messages = self._redraw()
        self._coverage.refresh()
        self._gaps = gaps_message(self._coverage)
        return [*messages, *self._plan.due(self._coverage, step.t_ns), self._gaps, self._loop]

    def _close_loop(self, T_map_laser: Array) -> None:
        """Recognize a place visited before and correct the drift of the map."""
        place = self._places.revisited()
        if len(self._places) > self._tried:  # standing still says nothing new
            self._tried = len(self._places)
            self._recognize(place)
        start_m = np.array(self._path.places[0][:2])
        self._loop = Loop(
            near=place is not None,
            closed=self._gate.closed,
            drift_m=round(self._gate.drift_m, 3) if self._gate.closed else None,
            walked_m=round(self._places.walked_m, 1),
            start_m=round(float(np.linalg.norm(T_map_laser[:2] - start_m)), 1),
        )

    def _recognize(self, place: int | None) -> None:
        found = None if place is None else self._places.locate(place)
        last = self._places.newest
        accepted = found is not None and found.accepted
        T_found = to_se3(found.pose) if found is not None and accepted else None
        drifted = self._gate.judge_pose(T_found, to_se3(last))
        if accepted and (drifted or not self._restarted):
            self._places.recognized()
        if place is None or found is None or not drifted:
            return
        correction = compose(found.pose, inverse(last))
        self._T_map_odom = compose(correction, self._T_map_odom)
        self._places.correct(place, found.pose)
        self._restarted = False
        self._stale = self._lines is None

    def _redraw(self) -> list[MapperMessage]:
        """Make plan, preview and path again from the corrected keyframes."""
        self._coverage = Coverage()
        self._preview.reset()
        self._plan.reset()
        self._path = ShownPath()
        height_m = float(self._laser.T_body_sensor.t[2])
        for pose, seen in self._places.views():
            ends = _raised(seen[:: max(1, len(seen) // SCAN_MAP.rays)], height_m)
            self._coverage.add(np.array([pose[0], pose[1], height_m]), ends)
            self._preview.add(ends, np.full(len(ends), SCAN_MAP.laser_value, np.uint8))
            self._path.extend(self._level_body(pose))
        return [Path(list(self._path.places)), points_message(self._preview.since(0))]

    def _level_body(self, T_map_laser: Array) -> Array:
        """Position of the body under a laser, if both are level [m], (3,)."""
        mount = self._laser.T_body_sensor
        T_laser_body = inverse(np.array([mount.t[0], mount.t[1], _yaw(mount.R)]))
        T_map_body = compose(T_map_laser, T_laser_body)
        return np.array([T_map_body[0], T_map_body[1], 0.0])


def _yaw(R: Array) -> float:
    return float(np.arctan2(R[1, 0], R[0, 0]))


def _raised(points: Array, height_m: float) -> Array:
    return np.column_stack([points, np.full(len(points), height_m)])
