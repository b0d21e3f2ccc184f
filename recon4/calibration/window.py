"""A window of the walk for calibration: points, poses and IMU samples of a few seconds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.tuning_joint import WINDOWS
from recon4.geometry.se3 import Array
from recon4.kernels.calibration import PlacedPoints, place_with_velocity
from recon4.model.beams import beam_change
from recon4.model.frames import RecordedFrames
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.imu_saturation import saturated_samples

_KNOT_NS = round(1e9 * WINDOWS.knot_s)


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """Measurements of some consecutive multiframes and the trajectory meanwhile.

    Times are seconds after `start_ns` by the clocks of the recorded rig.
    """

    start_ns: int
    knot_ns: Times
    """Knots of the correction [ns], `WINDOWS.knot_s` apart, (K,)."""
    p_sensor: Array
    """Points in the frames of their sensors [m], (N, 3)."""
    sensor: NDArray[np.uint8]
    """Row of the sensor, (N,)."""
    ring: NDArray[np.uint8]
    """Beam, (N,)."""
    t_s: Array
    """Times, (N,)."""
    recorded_rig: Rig
    """The rig whose clock offsets are in the times."""
    imu: ImuSamples | None
    trajectory: Trajectory
    """``T_odom_body`` over the window, current estimate."""

    @property
    def knots(self) -> int:
        """Number of knots."""
        return len(self.knot_ns)

    def thinned(self, every: int) -> Window:
        """The same window with every so-many-th of its points, an odd number."""
        if every == 1:
            return self
        kept = np.arange(0, len(self.t_s), every)
        return replace(
            self, p_sensor=self.p_sensor[kept], sensor=self.sensor[kept],
            ring=self.ring[kept], t_s=self.t_s[kept],
        )  # fmt: skip


def cut_window(
    frames: RecordedFrames,
    trajectory: Trajectory,
    rows: range,
    *,
    points: int = WINDOWS.points_of_frame,
) -> Window:
    """Collect the measurements of the multiframes ``rows``, thinned evenly.

    Args:
        frames: The multiframes with their rig and IMU.
        trajectory: ``T_odom_body``, dense.
        rows: Consecutive multiframes.
        points: Largest number of points of one sensor in one multiframe.
    """
    parts = [_thinned(frames, row, points) for row in rows]
    start_ns, end_ns = _span(frames, rows, trajectory)
    p, sensor, ring, t_ns = (np.concatenate(column) for column in zip(*parts, strict=True))
    # Exactly so far apart: rows of the IMU count on it. Later points belong to the last knot.
    knot_ns = np.arange(start_ns, max(end_ns, start_ns + _KNOT_NS) + 1, _KNOT_NS, dtype=np.int64)
    first, last = np.searchsorted(trajectory.t_ns, [start_ns, end_ns])
    return Window(
        start_ns,
        knot_ns,
        p.astype(np.float64),
        sensor,
        ring,
        (t_ns - start_ns) * 1e-9,
        frames.rig,
        _samples(frames.imu, start_ns, end_ns),
        trajectory[slice(max(int(first) - 1, 0), int(last) + 2)],
    )


def few_points(windows: int) -> int:
    """Points of one sensor in one multiframe that lead near the solution: more of few windows."""
    return min(
        max(
            WINDOWS.points_of_frame * WINDOWS.enough_windows // max(windows, 1),
            WINDOWS.points_of_frame,
        ),
        WINDOWS.most,
    )


def thinning(windows: Sequence[Window], wanted: int) -> int:
    """The odd number of which every so-many-th point leaves about ``wanted`` of all windows.

    An odd one so that all beams are met.
    """
    total = sum(len(window.t_s) for window in windows)
    return max(0, total // max(wanted, 1) - 1) | 1


def place(window: Window, rig: Rig) -> PlacedPoints:
    """Place the points of a window with a rig that may differ from the recorded one."""
    t_s = window.t_s + _clock_change_s(window.recorded_rig, rig)[window.sensor]
    T = rig.T_body_sensor
    p_sensor = _corrected(window, rig)
    arm_body = np.einsum("nij,nj->ni", T.R[window.sensor], p_sensor)
    p_body = arm_body + T.t[window.sensor]
    part = window.trajectory
    dense_s = np.asarray((part.t_ns - window.start_ns) * 1e-9, np.float64)
    odom, R_odom_body, velocity_odom = place_with_velocity(
        dense_s, part.T_a_b.R, part.T_a_b.t, t_s, p_body, WINDOWS.velocity_s
    )
    at = t_s / WINDOWS.knot_s
    knot = np.clip(np.floor(at).astype(np.int64), 0, window.knots - 2)
    length = np.maximum(np.linalg.norm(arm_body, axis=1), WINDOWS.nearest_m)
    return PlacedPoints(
        odom=odom,
        arm_odom=np.einsum("nij,nj->ni", R_odom_body, p_body),
        R_odom_body=R_odom_body,
        p_sensor=p_sensor,
        beam_odom=np.einsum("nij,nj->ni", R_odom_body, arm_body / length[:, None]),
        sensor_arm_body=arm_body,
        velocity_odom=velocity_odom,
        knot=knot,
        fraction=np.clip(at - knot, 0.0, 1.0),
    )


def _corrected(window: Window, rig: Rig) -> Array:
    """Points with the corrections of beams of another rig, (N, 3)."""
    p_sensor = window.p_sensor
    for row, (old, new) in enumerate(zip(window.recorded_rig.sensors, rig.sensors, strict=True)):
        change = beam_change(old.beams, new.beams)
        if change is not None:
            mine = np.flatnonzero(window.sensor == row)
            p_sensor = p_sensor.copy() if p_sensor is window.p_sensor else p_sensor
            p_sensor[mine], _ = change.apply(p_sensor[mine], window.ring[mine])
    return p_sensor


def _clock_change_s(before: Rig, after: Rig) -> Array:
    """How the clock offset of each LiDAR differs between two rigs [s], (S,)."""
    pairs = zip(before.sensors, after.sensors, strict=True)
    return np.array([new.time_offset_s - old.time_offset_s for old, new in pairs])


def _thinned(
    frames: RecordedFrames, row: int, points: int
) -> tuple[NDArray[np.float32], NDArray[np.uint8], NDArray[np.uint8], NDArray[np.int64]]:
    frame = frames[row]
    kept = [
        _evenly(np.flatnonzero((frame.sensor == k) & (frame.echo == 0)), row, points)
        for k, sensor in enumerate(frames.rig.sensors)
        if sensor.enabled
    ]
    rows = np.concatenate(kept)
    t_ns = frame.t_ns + frame.dt_ns[rows].astype(np.int64)
    return frame.xyz[rows], frame.sensor[rows], frame.ring[rows], t_ns


def _evenly(rows: NDArray[np.intp], shift: int, points: int) -> NDArray[np.intp]:
    """Some rows, evenly spaced; an odd step so that all beams are met."""
    step = max(1, len(rows) // points) | 1
    return rows[shift % step :: step]


def _span(frames: RecordedFrames, rows: range, trajectory: Trajectory) -> tuple[int, int]:
    first, last = frames[rows[0]], frames[rows[-1]]
    start_ns = max(first.t_ns, int(trajectory.t_ns[0]))
    return start_ns, min(last.t_ns + last.duration_ns, int(trajectory.t_ns[-1]))


def _samples(imu: ImuSamples | None, start_ns: int, end_ns: int) -> ImuSamples | None:
    """The samples of a window; None where faster motions than the IMU measures are missing."""
    if imu is None:
        return None
    kept = (imu.t_ns >= start_ns - WINDOWS.margin_ns) & (imu.t_ns <= end_ns + WINDOWS.margin_ns)
    # Of all samples: the fastest turn of a window alone may look like the end of a range.
    if saturated_samples(imu)[kept].any():
        return None
    return ImuSamples(imu.t_ns[kept], imu.gyro_rad_s[kept], imu.accel_m_s2[kept])


def with_trajectory(window: Window, trajectory: Trajectory) -> Window:
    """The same measurements with another estimate of the trajectory."""
    return replace(window, trajectory=trajectory)
