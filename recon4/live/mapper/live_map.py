"""Mapping while walking: multiframes in, what the operator should see out. No clocks, no wires.

What comes out are messages, plain JSON values (``docs/live.md`` lists them); arrays are base64.
"""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Any

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.imu import place_points
from recon4.live.ipc.messages import (
    Message,
    Snapshot,
    figure,
    gaps_message,
    plan_message,
    points_message,
)
from recon4.live.mapper.live_intensity import LiveIntensity
from recon4.live.mapper.loops import LoopGate
from recon4.live.mapper.place_index import PlaceIndex
from recon4.live.mapper.recovery import Recovery
from recon4.live.mapper.tracker import Tracker
from recon4.live.preview.cloud import PreviewCloud
from recon4.live.preview.coverage import Coverage
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.odometry import OdometryStep
from recon4.registration.segments import sample_segments
from recon4.settings import Settings

PREVIEW_POINTS = 6000
"""Taken of a multiframe for the preview …"""
COVERAGE_RAYS = 1500
"""… and for the plan."""
SUMMARY_EVERY_NS = 1_000_000_000
_SEARCH_AFTER = 5
"""After so many lost multiframes in a row the place is searched, now and then after as many."""
_LOOP_WITHIN_M = 4.0
_LOOP_WALKED_M = 20.0
_PATH_STEP_M = 0.25
"""The way is kept a point every so far: an hour's walk is a few thousand."""
_GAP_SHOWN_NS = 3_000_000_000
_LATELY_NS = 10_000_000_000
"""What was left out is said for so long."""
_PLAN_BYTES_PER_S = 20_000
"""Of a large plan: it is told less often then."""


class LiveMap:
    """One walk as it goes on; memory follows the area that was seen, and that slowly."""

    def __init__(self, rig: Rig, settings: Settings, *, scratch: Path | None = None) -> None:
        """Begin.

        Args:
            rig: What is on the backpack.
            settings: Of the odometry and of what is registered.
            scratch: Folder for what need not be in memory; None = the system's.
        """
        self._rig, self._settings = rig, settings
        self._scratch = scratch
        self.tracker = Tracker(rig, settings)
        self._preview = PreviewCloud()
        self._intensity = LiveIntensity(len(rig.sensors))
        self._thinned, self._relocated = 0, 0
        self._lately: deque[tuple[int, bool]] = deque()
        """Newest multiframes: time and whether it was left out."""
        self._gaps_m: deque[tuple[int, float]] = deque()
        """Newest multiframes: time and how far the prediction was off."""
        self._summary_ns = 0
        self._begin()

    def _begin(self) -> None:
        """An empty map; the preview is another matter, its generation counts on."""
        self._coverage = Coverage()
        self._places = PlaceIndex(self._settings, scratch=self._scratch)
        self._path: list[list[float]] = []
        self._here_m = np.zeros(3)
        """Where the body was when it was last not lost."""
        self._lost = self._lost_steps = 0
        self._recovery: Recovery | None = None
        self._plan_due_ns = self._plan_floor = 0
        self._gate = LoopGate()
        self._loop: Message = {"kind": "loop", "near": False, "closed": False}
        self._plan: dict[str, Any] = {}
        self._gaps: Message = {"kind": "gaps", "gaps": [], "well": None, "elsewhere": 0}

    def extend_imu(self, imu: ImuSamples) -> None:
        """Take samples as they were read."""
        self.tracker.extend_imu(imu)

    def thin(self, frame: Multiframe) -> None:
        """Leave a multiframe out, as the mapping has fallen behind; it is in the recording."""
        self._thinned += 1
        self._lately.append((frame.t_ns, True))

    def push(self, frame: Multiframe) -> list[Message]:
        """Map a multiframe.

        Returns:
            What to tell: always a ``pose``; ``points`` when there are new ones; about once a
            second ``plan``, ``gaps`` and ``loop``.
        """
        self._lately.append((frame.t_ns, False))
        broken_off = self.tracker.broken_off(frame)
        step = self.tracker.start_over(frame) if broken_off else self.tracker.push(frame)
        anew: list[Message] = []
        if self.tracker.anew:
            self._begin()
            self._preview.forget()
            anew = [{"kind": "path", "points": []}]
        step, lost = self._go_on(step) if broken_off else self._follow(frame, step)
        T_map_body = self.tracker.T_map_odom @ step.T_odom_body
        message = [self._pose(frame, step, T_map_body, lost=lost), *anew]
        if lost:
            return message
        self._go_to(T_map_body.t)
        message += self._add_points(frame, step)
        if frame.t_ns - self._summary_ns >= SUMMARY_EVERY_NS:
            self._summary_ns = frame.t_ns
            message += self._summary(frame, T_map_body, step)
        return message

    def snapshot(self) -> Snapshot:
        """All that was told and still holds."""
        chunk = self._preview.since(0) if len(self._preview) else None
        others = [*([self._plan] if self._plan else []), self._gaps, self._loop]
        return Snapshot(list(self._path), chunk, others)

    def _go_to(self, p_map: Array) -> None:
        self._here_m = p_map
        place = [round(float(v), 2) for v in p_map]
        if not self._path or np.linalg.norm(p_map - self._path[-1]) >= _PATH_STEP_M:
            self._path.append(place)

    def _go_on(self, step: OdometryStep) -> tuple[OdometryStep, bool]:
        """After a pause: probably where it began, but that has to be seen."""
        if not len(self._places):
            return step, False
        self._recovery = Recovery(self._places, self._here_m, expected=self.tracker.T_map_odom)
        self._lost, self._lost_steps = 1, 0
        return step, True

    def _follow(self, frame: Multiframe, step: OdometryStep) -> tuple[OdometryStep, bool]:
        """The step to go on with, and whether the body is lost.

        A few lost multiframes are forgiven: the odometry finds back by itself. After
        `_SEARCH_AFTER` it begins anew, and what it sees is searched for in the map so far; until
        it is found nothing is added to the map.
        """
        self._lost_steps = self._lost_steps + 1 if step.lost else 0
        self._lost = self._lost + 1 if step.lost or self._recovery else 0
        if self._lost_steps >= _SEARCH_AFTER:
            step = self.tracker.start_over(frame)
            self._lost_steps = 0
            if self._recovery is None and len(self._places):
                self._recovery = Recovery(self._places, self._here_m)
            return step, True
        if self._recovery is None or step.lost:
            return step, step.lost
        if self._lost % _SEARCH_AFTER:
            return step, True
        found = self._recovery.search(self._midpoints(frame), step.T_odom_body)
        if found is None:
            return step, True
        self.tracker.T_map_odom, self._recovery = found, None
        self._lost, self._relocated = 0, self._relocated + 1
        return step, False

    def _midpoints(self, frame: Multiframe) -> Array:
        segments = sample_segments(frame, self._rig, self._settings.segments)
        return (segments.a_body + segments.b_body) / 2

    def _pose(
        self, frame: Multiframe, step: OdometryStep, T_map_body: SE3, *, lost: bool
    ) -> Message:
        R = T_map_body.R
        return {
            "kind": "pose",
            "frame_id": frame.frame_id,
            "t_ns": frame.t_ns + frame.duration_ns,
            "p": [round(float(v), 3) for v in T_map_body.t],
            "yaw": round(float(np.arctan2(R[1, 0], R[0, 0])), 4),
            "lost": lost,
            "lost_frames": self._lost,
            "relocated": self._relocated,
            "error_m": figure(step.error_m),
            "match_ratio": figure(step.match_ratio),
            "degeneracy": figure(step.degeneracy),
            "prediction_offset_m": figure(self._worst_gap_m(frame.t_ns, step.prediction_offset_m)),
            "turn_rad_s": figure(_turn_rate(step)),
            "points": np.bincount(frame.sensor, minlength=len(self._rig.sensors)).tolist(),
            "thinned": self._thinned,
            "lately": self._counts_lately(frame.t_ns),
            "imu": self.tracker.with_imu,
            "remark": self.tracker.remark,
        }

    def _worst_gap_m(self, t_ns: int, prediction_offset_m: float) -> float:
        """Of the last seconds: one multiframe is too short for anybody to read of it."""
        self._gaps_m.append((t_ns, prediction_offset_m))
        while t_ns - self._gaps_m[0][0] > _GAP_SHOWN_NS:
            self._gaps_m.popleft()
        return max(prediction_offset_m for _, prediction_offset_m in self._gaps_m)

    def _counts_lately(self, now_ns: int) -> dict[str, int]:
        """Multiframes of the last 10 s, and how many of them were left out."""
        while now_ns - self._lately[0][0] > _LATELY_NS:
            self._lately.popleft()
        return {"frames": len(self._lately), "thinned": sum(out for _, out in self._lately)}

    def _add_points(self, frame: Multiframe, step: OdometryStep) -> list[Message]:
        rows = np.arange(0, len(frame), max(1, len(frame) // PREVIEW_POINTS))
        part = frame.take(rows)
        T_map_dense = self.tracker.T_map_odom @ step.T_dense
        t_s = (step.t_ns - frame.t_ns) * 1e-9
        p_map = place_points(
            t_s, T_map_dense.R, T_map_dense.t, part.dt_ns * 1e-9, _in_body(part, self._rig)
        )
        range_m = np.linalg.norm(part.xyz, axis=1).astype(np.float64)
        values = self._intensity.normalize(part.intensity, part.sensor, part.ring, range_m)
        every = max(1, len(p_map) // COVERAGE_RAYS)
        self._coverage.add(T_map_dense.t[-1], p_map[::every])
        chunk = self._preview.add(p_map, values)
        return [] if chunk is None else [points_message(chunk)]

    def _summary(self, frame: Multiframe, T_map_body: SE3, step: OdometryStep) -> list[Message]:
        segments = sample_segments(frame, self._rig, self._settings.segments)
        ends = np.concatenate([segments.a_body, segments.b_body])
        self._close_loop(self._midpoints(frame), T_map_body, step)
        self._places.keep(self.tracker.T_map_odom @ step.T_odom_body, ends)
        self._coverage.refresh()
        self._gaps = gaps_message(self._coverage)
        return [*self._new_plan(frame.t_ns), self._gaps, self._loop]

    def _new_plan(self, now_ns: int) -> list[Message]:
        """The plan, unless the last one was so large that it is not due."""
        if now_ns < self._plan_due_ns and self._coverage.floor == self._plan_floor:
            return []
        self._plan, self._plan_floor = plan_message(self._coverage), self._coverage.floor
        lasts_s = len(self._plan["seen"]) / _PLAN_BYTES_PER_S
        self._plan_due_ns = now_ns + round(1e9 * lasts_s)
        return [self._plan]

    def _close_loop(self, source: Array, T_map_body: SE3, step: OdometryStep) -> None:
        """Recognize a place left long ago; the map goes on from where it was."""
        start_m = np.array(self._path[0])
        place = self._places.revisited(
            T_map_body.t, within_m=_LOOP_WITHIN_M, walked_before_m=_LOOP_WALKED_M
        )
        found = None if place is None else self._places.locate(source, T_map_body, place)
        drifted = self._gate.judge(found, T_map_body)
        self._loop = {
            "kind": "loop",
            "near": place is not None,
            "closed": self._gate.closed,
            "drift_m": round(self._gate.drift_m, 3) if self._gate.closed else None,
            "walked_m": round(self._places.walked_m, 1),
            "start_m": round(float(np.linalg.norm(T_map_body.t - start_m)), 1),
        }
        if drifted and found is not None:
            self.tracker.move(found.T_target_source, step)


def _in_body(frame: Multiframe, rig: Rig) -> Array:
    T = rig.T_body_sensor[frame.sensor.astype(np.intp)]
    p: Array = np.einsum("nij,nj->ni", T.R, frame.xyz.astype(np.float64)) + T.t
    return p


def _turn_rate(step: OdometryStep) -> float:
    """Fastest turn within the frame [rad/s]."""
    if len(step.t_ns) < 2:
        return 0.0
    between = step.T_dense[:-1].inverse() @ step.T_dense[1:]
    seconds = np.maximum(np.diff(step.t_ns) * 1e-9, 1e-3)
    return float(np.max(between.angle() / seconds))
