"""Gaps of a recording in which the carrier did not move on: all clocks were set ahead.

A computer that finds its time server, or a LiDAR that locks to PTP, sets the times of everything
that is recorded. Nothing is missing then, but the times look like those of a gap. The scans tell:
after a gap of seconds nobody walks on from the same place at the same speed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.clock_jump import ClockJump
from recon4.model.frames import Frames
from recon4.model.trajectory import Times
from recon4.registration.bridge import SeenScan, sure_pose
from recon4.registration.scan_chain import body_points
from recon4.registration.scan_registration import make_scan, register_scans
from recon4.registration.tuning_motion import CLOCKS_SET


def clock_jumps(frames: Frames, starts_ns: Times) -> list[ClockJump]:
    """Find gaps in which the body went on as before, as if none of the time had passed.

    It must walk or turn before and after: where it stands, a pause of the recording looks the same.
    The first scan with enough points beyond the gap must fit one pose alone, no farther from the
    last one before it than the body goes from one multiframe to the next.

    Args:
        frames: Multiframes of a walk in order of time.
        starts_ns: Their starts [ns], (N,).
    """
    steps = np.diff(starts_ns.astype(np.int64)).astype(np.float64)
    if len(steps) < 2 * CLOCKS_SET.frames:
        return []
    rows = np.flatnonzero(steps > np.median(steps) + 1e9 * CLOCKS_SET.least_s)
    return [jump for row in rows[: CLOCKS_SET.most] for jump in _jump_after(frames, int(row))]


def _jump_after(frames: Frames, row: int) -> Iterator[ClockJump]:
    """The jump between a multiframe and the next one, if there is one."""
    # Those next to the gap may be parts of one revolution.
    before = range(row - CLOCKS_SET.frames, row)
    after = range(row + 2, row + 2 + CLOCKS_SET.frames)
    if before[0] < 0 or after[-1] >= len(frames):
        return
    jump = _ends_of(frames, row)
    # The nearest tell most: key scans meters apart may come near again beyond the next one.
    last = row if _has_enough(frames, row, beside=row - 1) else row - 1
    next_ = row + 1 if _has_enough(frames, row + 1, beside=row + 2) else row + 2
    across_s = 1e-9 * (frames[next_].t_mid_ns - jump.length_ns - frames[last].t_mid_ns)
    speeds = [_speed(frames, places) for places in (before, after)]
    if across_s <= 0.0 or not all(speed.goes_on for speed in speeds):
        return
    left, met = _seen(frames, last), _seen(frames, next_)
    found = sure_pose(left.scan, met, left, initial=[SE3.identity()])
    if found is None:
        return
    most_m = CLOCKS_SET.faster * across_s * max(speed.m_s for speed in speeds)
    most_rad = CLOCKS_SET.faster * across_s * max(speed.rad_s for speed in speeds)
    near = np.linalg.norm(found.t) < CLOCKS_SET.off_m + most_m
    if near and found.angle() < CLOCKS_SET.off_rad + most_rad:
        yield jump


def _has_enough(frames: Frames, row: int, *, beside: int) -> bool:
    """Whether a multiframe has points enough to tell its place."""
    return len(frames[row]) >= CLOCKS_SET.enough * len(frames[beside])


def _ends_of(frames: Frames, row: int) -> ClockJump:
    """From the last point before a gap to the first one after it; frames if points have no time."""
    before, after = frames[row], frames[row + 1]
    end_ns = before.t_ns + int(before.dt_ns.max(initial=0))
    start_ns = after.t_ns + int(after.dt_ns.min(initial=after.duration_ns))
    # A part of a revolution may be a single point.
    timed = all(np.ptp(frames[place].dt_ns) > 0 for place in (row - 1, row + 2))
    length_ns = start_ns - end_ns
    if not timed:
        length_ns = after.t_ns - before.t_ns - before.duration_ns
    return ClockJump(end_ns, length_ns)


def _seen(frames: Frames, place: int) -> SeenScan:
    points = body_points(frames[place], frames.rig)
    return SeenScan(make_scan(points), points)


class _Speed(NamedTuple):
    """Speed of a body; NaN = not known."""

    m_s: float
    """Over all multiframes [m/s]."""
    rad_s: float
    """Usual rate from one multiframe to the next [rad/s]."""

    @property
    def goes_on(self) -> bool:
        """Whether the body does not wait."""
        return self.m_s > CLOCKS_SET.moving_m_s or self.rad_s > CLOCKS_SET.turning_rad_s


def _speed(frames: Frames, places: Sequence[int]) -> _Speed:
    """How fast the body moves over some multiframes that follow each other."""
    T, whole, rates = SE3.identity(), SE3.identity(), []
    scans = [_seen(frames, place) for place in places]
    t_s = [1e-9 * frames[place].t_mid_ns for place in places]
    for k in range(1, len(scans)):
        found = register_scans(scans[k - 1].scan, scans[k].scan, initial=T)
        if found.match_ratio < CLOCKS_SET.least_ratio:
            return _Speed(float("nan"), float("nan"))
        T, whole = found.T_target_source, whole @ found.T_target_source
        rates.append(T.angle() / (t_s[k] - t_s[k - 1]))
    return _Speed(float(np.linalg.norm(whole.t)) / (t_s[-1] - t_s[0]), float(np.median(rates)))
