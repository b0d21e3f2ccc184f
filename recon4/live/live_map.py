"""Mapping while walking: multiframes in, what the operator should see out. No clocks, no wires.

What comes out are messages, plain JSON values (``docs/live.md`` lists them); arrays are base64.
"""

from __future__ import annotations

import base64
import zlib
from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.imu import place_points
from recon4.live.coverage import CELL_M, Coverage
from recon4.live.live_intensity import LiveIntensity
from recon4.live.loops import LoopGate
from recon4.live.places import Places
from recon4.live.preview import Chunk, Preview
from recon4.live.recovery import Recovery
from recon4.live.tracker import Tracker
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.odometry import OdometryStep
from recon4.registration.segments import sample_segments
from recon4.settings import Settings

Message = dict[str, Any]

PREVIEW_POINTS = 6000
"""Taken of a multiframe for the preview …"""
COVERAGE_RAYS = 1500
"""… and for the plan."""
SUMMARY_EVERY_NS = 1_000_000_000
_SEARCH_AFTER = 5
"""After so many lost multiframes in a row the place is searched, now and then after as many."""
_LOOP_WITHIN_M = 4.0
_LOOP_WALKED_M = 20.0
_MOST_PATH = 20_000


class LiveMap:
    """One walk as it goes on."""

    def __init__(self, rig: Rig, settings: Settings) -> None:
        self._rig, self._settings = rig, settings
        self.tracker = Tracker(rig, settings)
        self._preview, self._coverage = Preview(), Coverage()
        self._places = Places(settings)
        self._intensity = LiveIntensity(len(rig.sensors))
        self._path: deque[list[float]] = deque(maxlen=_MOST_PATH)
        self._lost, self._thinned, self._relocated = 0, 0, 0
        self._lost_steps = 0
        self._recovery: Recovery | None = None
        self._summary_ns = 0
        self._gate = LoopGate()
        self._loop: Message = {"kind": "loop", "near": False, "closed": False}
        self._plan: dict[str, Any] = {}
        self._gaps: Message = {"kind": "gaps", "gaps": [], "well": None}

    def extend_imu(self, imu: ImuSamples) -> None:
        """Take samples as they were read."""
        self.tracker.extend_imu(imu)

    def thin(self) -> None:
        """A multiframe was left out, as the mapping fell behind; it is in the recording."""
        self._thinned += 1

    def push(self, frame: Multiframe) -> list[Message]:
        """Map a multiframe.

        Returns:
            What to tell: always a ``pose``; ``points`` when there are new ones; about once a
            second ``plan``, ``gaps`` and ``loop``.
        """
        step = self.tracker.push(frame)
        step, lost = self._follow(frame, step)
        T_map_body = self.tracker.T_map_odom @ step.T_odom_body
        told = [self._pose(frame, step, T_map_body, lost=lost)]
        if lost:
            return told
        self._path.append([round(float(v), 2) for v in T_map_body.t])
        told += self._add_points(frame, step)
        if frame.t_ns - self._summary_ns >= SUMMARY_EVERY_NS:
            self._summary_ns = frame.t_ns
            told += self._summary(frame, T_map_body, step)
        return told

    def everything(self) -> list[Message]:
        """All that was told and still holds, for a listener that comes late."""
        told: list[Message] = [{"kind": "path", "points": list(self._path)}]
        if len(self._preview):
            told.append(_points(self._preview.since(0)))
        return [*told, *([self._plan] if self._plan else []), self._gaps, self._loop]

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
                self._recovery = Recovery(self._places, np.array(self._path[-1]))
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
            "error_m": _figure(step.error_m),
            "share": _figure(step.share),
            "degeneracy": _figure(step.degeneracy),
            "gap_m": _figure(step.gap_m),
            "turn_rad_s": _figure(_turn_rate(step)),
            "points": np.bincount(frame.sensor, minlength=len(self._rig.sensors)).tolist(),
            "thinned": self._thinned,
            "imu": self.tracker.with_imu,
            "remark": self.tracker.remark,
        }

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
        return [] if chunk is None else [_points(chunk)]

    def _summary(self, frame: Multiframe, T_map_body: SE3, step: OdometryStep) -> list[Message]:
        segments = sample_segments(frame, self._rig, self._settings.segments)
        ends = np.concatenate([segments.a_body, segments.b_body])
        self._close_loop(self._midpoints(frame), T_map_body, step)
        self._places.keep(self.tracker.T_map_odom @ step.T_odom_body, ends)
        self._plan = _plan(self._coverage)
        well = self._coverage.share_well()
        gaps = [
            {"p": list(gap.p_map), "width_m": gap.width_m, "away_m": round(gap.away_m, 2)}
            for gap in self._coverage.gaps()[:50]
        ]
        self._gaps = {"kind": "gaps", "gaps": gaps, "well": _figure(well)}
        return [self._plan, self._gaps, self._loop]

    def _close_loop(self, source: Array, T_map_body: SE3, step: OdometryStep) -> None:
        """Recognize a place left long ago; the map goes on from where it was."""
        start_m = np.array(self._path[0]) if self._path else T_map_body.t
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


def _points(chunk: Chunk) -> Message:
    return {
        "kind": "points",
        "generation": chunk.generation,
        "start": chunk.start,
        "count": len(chunk.values),
        "voxel_m": chunk.voxel_m,
        "voxels": _base64(chunk.voxels),
        "values": _base64(chunk.values),
    }


def _plan(coverage: Coverage) -> Message:
    seen = coverage.seen()
    return {
        "kind": "plan",
        "cell_m": CELL_M,
        "first_cell": coverage.first_cell.tolist(),
        "shape": list(seen.shape),
        "seen": _base64(np.frombuffer(zlib.compress(seen.tobytes(), 1), np.uint8)),
    }


def _base64(values: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")


def _figure(value: float) -> float | None:
    return float(f"{value:.4g}") if np.isfinite(value) else None
