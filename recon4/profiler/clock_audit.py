"""Whether the clocks of IMU, 2-D laser and profiler agree.

IMU and 2-D laser both measure the heading. The profiler is compared with the trajectory of both: at
the right time its points lie on the fewest places.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.cubes import count_cubes
from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.fusion import PlanarPoses
from recon4.profiler.samples import TimedPoints, all_lines, joined
from recon4.profiler.tuning_audits import CLOCK_AUDIT
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True)
class ClockLag:
    """How far the clock of the IMU is ahead of that of the 2-D laser."""

    ahead_s: float
    """Time to subtract from the stamps of the IMU [s]."""
    error_rad: float
    """What is left of the difference of the headings, standard deviation [rad]."""
    blur_s: float = 0.0
    """How far the time of a planar pose is not known [s]."""

    @property
    def is_wrong(self) -> bool:
        """Whether a person should look at the clocks."""
        return abs(self.ahead_s) > CLOCK_AUDIT.said_s + self.blur_s


def clock_lag(poses: PlanarPoses, attitude: Trajectory, *, blur_s: float = 0.0) -> ClockLag | None:
    """Find the difference of the clocks for which the headings agree best.

    Args:
        poses: By 2-D SLAM.
        attitude: ``R_map_body`` by the IMU alone; its drift is left out.
        blur_s: Half the duration of a scan if its beams were not undistorted.

    Returns:
        None if the walk turns too little, or no difference makes the headings agree better.
    """
    used = _steady(poses, attitude)
    if len(used.t_ns) < CLOCK_AUDIT.min_poses:
        return None
    laser = _unwrapped(used.T_map_laser.R)
    if np.std(_without_drift(laser, used.t_ns)) < CLOCK_AUDIT.min_swing_rad:
        return None
    shifts = np.arange(
        -CLOCK_AUDIT.most_s, CLOCK_AUDIT.most_s + 0.5 * CLOCK_AUDIT.step_s, CLOCK_AUDIT.step_s
    )
    spread = np.array([_spread(laser, used, attitude, shift_s=s) for s in shifts])
    best = int(np.argmin(spread))
    if best in (0, len(shifts) - 1):
        return None
    now = float(spread[len(shifts) // 2])
    ahead_s = float(shifts[best]) + CLOCK_AUDIT.step_s * _vertex(spread[best - 1 : best + 2] ** 2)
    if abs(ahead_s) > CLOCK_AUDIT.said_s and spread[best] > CLOCK_AUDIT.same_ratio * now:
        return None
    return ClockLag(ahead_s, float(spread[best]), blur_s)


def profiler_ahead_s(points: TimedPoints, trajectory: Trajectory) -> float:
    """How far the clock of the profiler is ahead of that of the trajectory [s]; 0 = not clearly.

    Args:
        points: Some of all line scans, in the body.
        trajectory: ``T_map_body`` by IMU and 2-D laser.
    """
    shifts = np.arange(
        -CLOCK_AUDIT.line_most_s,
        CLOCK_AUDIT.line_most_s + 0.5 * CLOCK_AUDIT.line_step_s,
        CLOCK_AUDIT.line_step_s,
    )
    inside_ns = round(1e9 * (CLOCK_AUDIT.line_most_s + CLOCK_AUDIT.line_step_s))
    used = points.between(trajectory.t_ns[0] + inside_ns, trajectory.t_ns[-1] - inside_ns)
    if not len(used):
        return 0.0
    places = np.array([_places(used, trajectory, shift_s=s) for s in shifts], dtype=np.float64)
    best = int(np.argmin(places))
    if (
        best in (0, len(shifts) - 1)
        or places[best] > CLOCK_AUDIT.clear_ratio * places[len(shifts) // 2]
    ):
        return 0.0
    return float(shifts[best]) + CLOCK_AUDIT.line_step_s * _vertex(places[best - 1 : best + 2])


def some_points(frames: FrameStore, *, min_range_m: float) -> TimedPoints:
    """Points of the whole walk, few enough to be placed many times."""
    every = max(1, frames.points // CLOCK_AUDIT.line_points)
    return joined(list(all_lines(frames, every=every, min_range_m=min_range_m)))


def _places(points: TimedPoints, trajectory: Trajectory, *, shift_s: float) -> int:
    """Cubes with a point, if the points were measured that much earlier than stamped."""
    shifted = TimedPoints(points.t_ns - round(1e9 * shift_s), points.p_body)
    return count_cubes(shifted.placed(trajectory), CLOCK_AUDIT.place_m)


def _steady(poses: PlanarPoses, attitude: Trajectory) -> PlanarPoses:
    """Poses that the IMU covers for every difference of the clocks."""
    margin_ns = round(1e9 * (CLOCK_AUDIT.most_s + CLOCK_AUDIT.step_s))
    first_ns, last_ns = attitude.t_ns[0] + margin_ns, attitude.t_ns[-1] - margin_ns
    rows = np.flatnonzero((poses.t_ns > first_ns) & (poses.t_ns < last_ns))
    return replace(
        poses, t_ns=poses.t_ns[rows], T_map_laser=poses.T_map_laser[rows], cov=poses.cov[rows]
    )


def _spread(laser: Array, poses: PlanarPoses, attitude: Trajectory, *, shift_s: float) -> float:
    """Standard deviation of the difference of the headings [rad]."""
    R = attitude.at(poses.t_ns + round(1e9 * shift_s)).R @ poses.T_body_laser.R
    return float(np.std(_without_drift(laser - _unwrapped(R), poses.t_ns)))


def _without_drift(angle: Array, t_ns: Times) -> Array:
    """What changes within a second, outliers clipped."""
    rate_hz = 1e9 / float(np.median(np.diff(t_ns)))
    width = max(3, 2 * round(0.5 * CLOCK_AUDIT.smooth_s * rate_hz) + 1)
    mean = np.convolve(angle, np.full(width, 1.0 / width), mode="valid")
    fast = angle[width // 2 : width // 2 + len(mean)] - mean
    limit = 5.0 * float(np.median(np.abs(fast))) + 1e-6
    return np.asarray(np.clip(fast, -limit, limit), dtype=np.float64)


def _unwrapped(R: Array) -> Array:
    return np.asarray(np.unwrap(np.arctan2(R[:, 1, 0], R[:, 0, 0])), dtype=np.float64)


def _vertex(y: Array) -> float:
    """Place of the vertex of a parabola through values at -1, 0 and 1."""
    bend = float(y[0] - 2.0 * y[1] + y[2])
    return 0.5 * float(y[0] - y[2]) / bend if bend > 0.0 else 0.0
