"""Rides that the IMU feels and no LiDAR sees: a floor that moves with the body.

In the car of an elevator everything that a LiDAR sees stands still. The odometry stays where it is
or goes some way between what IMU and LiDAR say, sure of itself, and puts one storey onto another.
The accelerometer contradicts it: over knots ``dt`` apart the second difference of the heights of a
trajectory equals the vertical acceleration, weighted by a triangle of the same width,

    (z(t - dt) - 2 z(t) + z(t + dt)) / dt²  =  sum of w(s) (R f(s) - g) over abs(s - t) < dt

Half a second makes it blind to the steps of a walk. What is left is the bias, the same all along in
the axes of the body, and pushes that only the IMU felt. A ride is a push up and a later one down,
or the reverse. Where the difference stays large without that pattern, height and IMU contradict
each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.odometry_figures import HeightDoubt
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.motion import imu_in_body
from recon4.registration.tuning_motion import RIDES
from recon4.units import STANDARD_GRAVITY_M_S2


@dataclass(frozen=True, slots=True)
class UnseenRide:
    """A vertical motion that only the IMU measured."""

    start_s: float
    """After the first pose [s]."""
    end_s: float
    rise_m: float
    """Up is positive [m]; NaN = only its begin or its end was recorded."""
    speed_m_s: float
    """Change of the vertical speed at its begin."""

    @property
    def doubt(self) -> HeightDoubt:
        """What it makes of the heights; a ride without an end, or a begin, counts as a storey."""
        if np.isfinite(self.rise_m):
            return HeightDoubt(start_s=self.start_s, end_s=self.end_s, rise_m=self.rise_m)
        return HeightDoubt(
            start_s=self.start_s,
            end_s=self.end_s,
            rise_m=RIDES.unknown_ride_m,
            speed_m_s=self.speed_m_s,
        )


@dataclass(frozen=True, slots=True)
class HeightContradiction:
    """A stretch in which the IMU contradicts the heights of the trajectory."""

    start_s: float
    """After the first pose [s]."""
    end_s: float
    largest_m_s2: float
    usual_m_s2: float
    rise_m: float
    """Largest height that the IMU measures meanwhile and the trajectory has not [m]; up is
    positive."""

    @property
    def doubt(self) -> HeightDoubt:
        """What it makes of the heights."""
        return HeightDoubt(
            start_s=self.start_s,
            end_s=self.end_s,
            rise_m=self.rise_m,
            largest_m_s2=self.largest_m_s2,
            usual_m_s2=self.usual_m_s2,
        )


def unseen_rides(
    trajectory: Trajectory, imu: ImuSamples, rig: Rig, *, lost_ns: Times
) -> list[UnseenRide | HeightContradiction]:
    """Find rides, and other contradictions of the heights, in order of time.

    Args:
        trajectory: ``T_odom_body``, leveled.
        imu: Samples as they were used.
        rig: Where the IMU is.
        lost_ns: Middle of the multiframes that were lost, (K,).
    """
    knots_s, extra, upward = _contradiction(trajectory, imu, rig, lost_ns=lost_ns)
    known = np.isfinite(extra)
    if known.sum() < RIDES.min_knots:
        return []
    extra[known] -= _of_bias(extra[known], upward[known])
    extra[~known] = 0.0
    usual = 1.4826 * float(np.median(np.abs(extra[known])))
    rides: list[UnseenRide] = []
    if usual <= RIDES.reliable_m_s2:
        limit = max(RIDES.push_m_s2, RIDES.push_sigmas * usual)
        rides = _rides(knots_s, extra, limit=limit, least_m_s=RIDES.push_m_s)
        rides += _slow_rides(knots_s, extra, usual, trajectory=trajectory, others=rides)
    others = [
        stretch for stretch in _contradicted(knots_s, extra, usual)
        if not _overlaps(stretch, rides)
    ]  # fmt: skip
    return sorted([*rides, *others], key=lambda found: found.start_s)


def _overlaps(found: UnseenRide | HeightContradiction, rides: list[UnseenRide]) -> bool:
    """Whether a stretch overlaps one of the rides in time."""
    return any(r.start_s <= found.end_s and found.start_s <= r.end_s for r in rides)


def _of_bias(extra: Array, upward: Array) -> Array:
    """What the bias of the accelerometer makes of the vertical acceleration, (K,).

    A body that is tilted, or laid down, has another part of the bias along the vertical. Pushes
    are outliers of this fit.

    Args:
        extra: Vertical acceleration by the IMU less that of the trajectory, (K,).
        upward: The vertical in axes of the body, (K, 3).
    """
    level = float(np.median(extra))
    tilted = upward - np.median(upward, axis=0)
    bias: Array = np.zeros(3)
    for _ in range(RIDES.bias_rounds):
        r = extra - level - tilted @ bias
        weight = 1.0 / np.maximum(np.abs(r), RIDES.bias_noise_m_s2)
        H = (
            tilted * weight[:, None]
        ).T @ tilted + RIDES.bias_noise_m_s2 / RIDES.bias_sd_m_s2**2 * np.eye(3)
        bias = np.asarray(np.linalg.solve(H, tilted.T @ (weight * (extra - level))), np.float64)
        level = float(np.median(extra - tilted @ bias))
    return np.asarray(level + tilted @ bias)


def _slow_rides(
    knots_s: Array,
    extra: Array,
    usual: float,
    *,
    trajectory: Trajectory,
    others: list[UnseenRide],
) -> list[UnseenRide]:
    """Rides with weak pushes, as of a platform lift, in which the body stays in one place."""
    limit = max(RIDES.slow_push_m_s2, RIDES.slow_push_sigmas * usual)
    found = _rides(knots_s, extra, limit=limit, least_m_s=RIDES.slow_push_m_s)
    return [
        ride for ride in found
        if np.isfinite(ride.rise_m)
        and _stays(trajectory, ride.start_s, ride.end_s)
        and not _overlaps(ride, others)
    ]  # fmt: skip


def _stays(trajectory: Trajectory, start_s: float, end_s: float) -> bool:
    """Whether the body stays within the car of a lift, whatever its height."""
    since_s = (trajectory.t_ns - trajectory.t_ns[0]) * 1e-9
    place_m = trajectory.T_a_b.t[(since_s >= start_s) & (since_s <= end_s), :2]
    return bool(np.linalg.norm(place_m - np.median(place_m, axis=0), axis=1).max() < RIDES.car_m)


def _contradicted(knots_s: Array, extra: Array, usual: float) -> list[HeightContradiction]:
    """Stretches of `RIDES.contradiction_s` in which most differences are large, and sharp ones."""
    sharp_m_s2 = max(RIDES.sharp_m_s2, RIDES.sharp_sigmas * usual)
    rows = np.flatnonzero(np.abs(extra) > RIDES.contradiction_m_s2)
    if not len(rows):
        return []
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > RIDES.bridged_knots) + 1)
    spans: list[slice] = []
    for run in runs:
        if (
            len(run) * RIDES.knot_s < RIDES.contradiction_s
            and np.abs(extra[run]).max() < sharp_m_s2
        ):
            continue
        begin, end = int(run[0]), int(run[-1]) + 1
        if spans and (begin - spans[-1].stop) * RIDES.knot_s <= RIDES.same_ride_s:
            begin = spans.pop().start
        spans.append(slice(begin, end))
    return [
        HeightContradiction(
            float(knots_s[span.start]),
            float(knots_s[span.stop - 1]),
            float(np.abs(extra[span]).max()),
            usual,
            _rise_m(extra[span], in_motion=span.start == 0),
        )
        for span in spans
    ]


def _rise_m(extra: Array, *, in_motion: bool) -> float:
    """Largest height from one moment to a later one that a stretch leads to, from rest [m].

    A speed that is left at its end carries on until the LiDARs correct it. A recording that begins
    `in_motion`, in this stretch, has no rest before it: there the LiDARs give the speed at its end.
    """
    speed_m_s = np.cumsum(np.append(0.0, extra)) * RIDES.knot_s
    if in_motion:
        speed_m_s -= speed_m_s[-1]
    height_m = np.append(0.0, np.cumsum(speed_m_s) * RIDES.knot_s)
    reached_m = np.append(height_m, height_m[-1] + RIDES.same_ride_s * speed_m_s[-1])
    low, high = int(np.argmin(reached_m)), int(np.argmax(reached_m))
    return float(np.copysign(reached_m[high] - reached_m[low], high - low))


def _contradiction(
    trajectory: Trajectory, imu: ImuSamples, rig: Rig, *, lost_ns: Times
) -> tuple[Array, Array, Array]:
    """At knots: vertical acceleration by the IMU less that of the trajectory, NaN = unknown; the
    vertical in axes of the body.
    """
    first_ns = max(trajectory.t_ns[0], imu.t_ns[0])
    last_ns = min(trajectory.t_ns[-1], imu.t_ns[-1])
    count = int((last_ns - first_ns) * 1e-9 / RIDES.knot_s) if len(imu) > 1 else 0
    if count < RIDES.min_knots:
        return np.empty(0), np.empty(0), np.empty((0, 3))
    _, accel = imu_in_body(imu, rig)
    inside = (imu.t_ns >= first_ns) & (imu.t_ns <= last_ns)
    upward = trajectory.at(imu.t_ns[inside]).R[:, 2, :]
    force = np.einsum("ni,ni->n", upward, accel[inside]) - STANDARD_GRAVITY_M_S2
    slot = (imu.t_ns[inside] - first_ns) * 1e-9 / RIDES.knot_s
    measured, weight = np.zeros(count + 2), np.zeros(count + 2)
    left = np.minimum(slot.astype(np.intp), count)
    for rows, part in ((left, 1.0 - (slot - left)), (left + 1, slot - left)):
        np.add.at(measured, rows, part * force)
        np.add.at(weight, rows, part)
    knots_ns = first_ns + np.rint(np.arange(count + 1) * RIDES.knot_s * 1e9).astype(np.int64)
    height_m = trajectory.at(np.minimum(knots_ns, last_ns)).t[:, 2]
    seen = np.diff(height_m, 2) / RIDES.knot_s**2
    extra = measured[1:count] / np.maximum(weight[1:count], 1e-9) - seen
    extra[_near_gap(weight)[1:count]] = np.nan
    lost_at = (lost_ns - first_ns) * 1e-9 / RIDES.knot_s
    rows = np.arange(1, count)
    extra[np.isin(rows, np.rint(lost_at)[:, None] + [-1, 0, 1])] = np.nan
    up = trajectory.at(knots_ns[1:count]).R[:, 2, :]
    return rows * RIDES.knot_s + (first_ns - trajectory.t_ns[0]) * 1e-9, extra, up


def _near_gap(weight: Array) -> NDArray[np.bool_]:
    """Knots at or beside which samples are missing: half a step of a walk looks like a push."""
    gap = weight < RIDES.whole * np.median(weight[1:-2])
    gap[[0, -2, -1]] = False  # the ends, where there is one side only
    return gap | np.roll(gap, 1) | np.roll(gap, -1)


def _rides(knots_s: Array, extra: Array, *, limit: float, least_m_s: float) -> list[UnseenRide]:
    """Pair pushes with the opposite one that follows them."""
    pushes = _pushes(extra, limit, least_m_s=least_m_s)
    change = [float(extra[push].sum() * RIDES.knot_s) for push in pushes]
    found, k = [], 0
    while k < len(pushes):
        begin = pushes[k]
        if k + 1 < len(pushes) and _balanced(change[k], change[k + 1]):
            # A knot more on both sides: the first and the last of a push are below the limit.
            rows = np.arange(max(begin[0] - 1, 0), min(pushes[k + 1][-1] + 2, len(extra)))
            if len(rows) * RIDES.knot_s <= RIDES.longest_s:
                # At rest before and after it.
                steps = extra[rows] - extra[rows].mean()
                rise_m = float(np.cumsum(steps).sum() * RIDES.knot_s**2)
                start_s, end_s = float(knots_s[rows[0]]), float(knots_s[rows[-1]])
                found.append(UnseenRide(start_s, end_s, rise_m, change[k]))
                k += 2
                continue
        start_s, end_s = float(knots_s[begin[0]]), float(knots_s[begin[-1]])
        found.append(UnseenRide(start_s, end_s, float("nan"), change[k]))
        k += 1
    return found


def _balanced(first: float, second: float) -> bool:
    return first * second < 0.0 and abs(first + second) < RIDES.balance * max(
        abs(first), abs(second)
    )


def _pushes(extra: Array, limit: float, *, least_m_s: float) -> list[NDArray[np.intp]]:
    """Rows of each run above the limit, of one sign, that changes the speed enough."""
    sign = np.where(np.abs(extra) > limit, np.sign(extra), 0.0)
    edges = [0, *(np.flatnonzero(np.diff(sign)) + 1).tolist(), len(sign)]
    runs = [np.arange(a, b) for a, b in pairwise(edges) if sign[a]]
    return [run for run in runs if abs(extra[run].sum()) * RIDES.knot_s >= least_m_s]
