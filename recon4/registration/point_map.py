"""Single points where segments observe too little: far walls, the reveals of doors.

A collar line segment needs two neighboring rings on one surface. The wall at the end of a long
corridor is hit by one ring, and of a door's reveal, a few centimeters deep, hardly a segment is
drawn; yet along the corridor nothing else observes the motion. So where the segments leave a
direction weak, single points are registered too: only those on surfaces that face this direction,
against planes that are remembered much longer than the keyframes of the segments.

Surfaces that face a weak direction often lie a few centimeters behind each other: the door in the
end of a corridor, set back from its wall, or the reveals of doors. Each of them draws the points to
itself, from half the distance between them. A prediction by scans is wrong by more than that now
and then, and the nearest place may be the one where few points lie on anything.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, TRANSLATION, Array
from recon4.kernels.imu import place_points
from recon4.kernels.selection import thin_near
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.registration.in_body import in_body
from recon4.registration.motion import Prediction
from recon4.registration.plane_map import Match, PlaneMap
from recon4.registration.state_vector import END_POSE, START
from recon4.registration.tuning import PLANES, PlaneTuning
from recon4.registration.tuning_matching import FRAME_FIT, POINT_MAP, WEAK_PLACES


@dataclass(frozen=True, slots=True, eq=False)
class FramePoints:
    """Points of a multiframe."""

    body: Array
    """In the body frame of their own time [m], (N, 3)."""
    s: Array
    """Time of each after the start of the frame [s], (N,)."""

    def __len__(self) -> int:
        return len(self.s)

    def __getitem__(self, rows: NDArray[np.intp] | slice) -> FramePoints:
        return FramePoints(self.body[rows], self.s[rows])

    @staticmethod
    def of_all(parts: Sequence[FramePoints]) -> FramePoints:
        """The points of all parts; those of several count once, in the order of their time."""
        body, s = (np.concatenate([getattr(one, name) for one in parts]) for name in ("body", "s"))
        rows = np.unique(np.column_stack([s, body]), axis=0, return_index=True)[1]
        return FramePoints(body[rows], s[rows])

    def placed(self, t_s: Array, T_odom_body: SE3) -> Array:
        """The points in odom [m], (N, 3), by the poses (K,) of the body at the times ``t_s``."""
        return place_points(t_s, T_odom_body.R, T_odom_body.t, self.s, self.body)


def frame_points(frame: Multiframe, rig: Rig, *, by_ring: bool = False) -> FramePoints:
    """Points of all enabled sensors; of the near ones, every fourth.

    They come in the order of their time, or ``by_ring``: to add these takes a third of the time.
    """
    body, s = [np.empty((0, 3))], [np.empty(0)]
    for number, sensor in enumerate(rig.sensors):
        if sensor.enabled:
            rows = thin_near(
                frame.xyz, frame.ring, frame.sensor, number, POINT_MAP.near_m,
                POINT_MAP.near_stride, by_ring,
            )  # fmt: skip
            body.append(in_body(sensor, frame.xyz[rows]))
            s.append(frame.dt_ns[rows].astype(np.float64) * 1e-9)
    return FramePoints(np.concatenate(body), np.concatenate(s))


Distances = Callable[[float], Array]
"""Distance of each point from its plane with the body shifted by a distance [m], (N,); NaN = no
plane there."""


def better_place_m(distances: Distances, *, shifted_m: float) -> float:
    """Shift along a weak direction to where clearly more of the points lie on planes [m].

    The cost of a shift is that of the points, with the Cauchy kernel of the planes, and that of the
    prediction::

        c(s) = scale k² / (2 σ²) Σ log(1 + (r(s) / k)²) + (s + s₀)² / (2 σ_e²)

    A point without a plane counts as one at the gate. The least of it is the place if the minimum
    that is reached downhill from no shift costs more by `WEAK_PLACES.clear`.

    Args:
        distances: Of the points, by a shift.
        shifted_m: Distance of the body from the predicted place already [m], s₀.

    Returns:
        0.0 if the place is that of the next minimum.
    """
    reach, step_m = WEAK_PLACES.steps, WEAK_PLACES.step_m
    shifts_m = step_m * np.arange(-reach, reach + 1)
    cost = np.array([_cost(distances(float(shift_m))) for shift_m in shifts_m])
    cost += 0.5 * ((shifts_m + shifted_m) / FRAME_FIT.expected_sd[1]) ** 2
    best = int(cost.argmin())
    if cost[best] > cost[_downhill(cost, reach)] - WEAK_PLACES.clear:
        return 0.0
    return float(shifts_m[best])


def _cost(distance_m: Array) -> float:
    """Half the sum of what the points cost, (N,) [m]; NaN = no plane."""
    far = np.where(np.isnan(distance_m), POINT_MAP.gate_m, distance_m) / PLANES.kernel_m
    weight = 0.5 * POINT_MAP.scale * (PLANES.kernel_m / PLANES.point_sd_m) ** 2
    return weight * float(np.log1p(far**2).sum())


def _downhill(cost: Array, row: int) -> int:
    """Row of the minimum that is reached from a row."""
    while True:
        near = slice(max(row - 1, 0), row + 2)
        lowest = near.start + int(cost[near].argmin())
        if cost[lowest] >= cost[row]:
            return row
        row = lowest


class PointMap:
    """Planes of the points of all keyframes within `POINT_MAP.radius_m`."""

    def __init__(self, settings: PlaneTuning = PLANES) -> None:
        self._planes = PlaneMap(
            settings,
            min_extent_m=POINT_MAP.min_extent_m,
            max_variance_ratio=POINT_MAP.max_variance_ratio,
            min_viewpoints=POINT_MAP.min_viewpoints,
        )
        self._keyframes = 0

    def add(self, points: FramePoints, t_s: Array, T_odom_body: SE3) -> None:
        """Add the points of a keyframe; its poses ``T_odom_body`` (K,) are at ``t_s`` (K,)."""
        self._planes.add(points.placed(t_s, T_odom_body), T_odom_body.t[-1].copy())
        self._keyframes += 1
        if self._keyframes % POINT_MAP.forget_every == 0:
            self._forget_far(T_odom_body.t[-1])

    def _forget_far(self, center: Array) -> None:
        radius_m = POINT_MAP.radius_m
        self._planes.forget_beyond(radius_m, center)
        while len(self._planes) > POINT_MAP.max_cubes:
            radius_m /= 2
            self._planes.forget_beyond(radius_m, center)

    def clear(self) -> None:
        """Forget all keyframes."""
        self._planes.clear()
        self._keyframes = 0

    def choose(
        self, points: FramePoints, t_s: Array, T_odom_body: SE3, *, weak: Array
    ) -> FramePoints:
        """Points on surfaces that face a weak direction.

        Args:
            points: All points of a frame.
            t_s: Times of the poses after the start of the frame [s], (K,).
            T_odom_body: Poses of the body, (K,).
            weak: Unit vectors of the weak directions in odom, (M, 3).
        """
        if not self._keyframes:
            return points[:0]
        p_odom = points.placed(t_s, T_odom_body)
        n, scatter_m = self._planes.normals(p_odom, POINT_MAP.gate_m)
        sight = p_odom - T_odom_body.t[-1]
        incidence = np.abs(np.sum(n * sight, axis=1)) / np.linalg.norm(sight, axis=1)
        expected_m = np.hypot(POINT_MAP.range_sd_m * incidence, POINT_MAP.across_sd_m)
        rows = np.flatnonzero(
            (incidence > POINT_MAP.min_incidence)
            & (np.linalg.norm(n @ weak.T, axis=1) > POINT_MAP.min_facing)
            & (scatter_m < POINT_MAP.most_sds * expected_m)
        )
        return points[rows[:: -(-len(rows) // POINT_MAP.max_points) or 1]]

    def match(
        self, points: FramePoints, t_s: Array, T_odom_body: SE3, *, center: Array, gate_m: float
    ) -> Match:
        """Match points that were chosen; see `PlaneMap.match`."""
        return self._planes.match(
            points.placed(t_s, T_odom_body),
            points.s / t_s[-1],
            center=center,
            finest=0,
            gate_m=gate_m,
        )


class WeakDirections:
    """Adds points to the segments of one frame in directions that these observe weakly."""

    _CHOSEN_IN = (1, 3)
    """Rounds in which points are chosen: by the prediction, and once more when it is corrected."""

    def __init__(
        self,
        point_map: PointMap,
        points: Callable[[], FramePoints],
        prediction: Prediction,
        *,
        max_eigenvalue: float,
    ) -> None:
        self._map, self._points, self._max_eigenvalue = point_map, points, max_eigenvalue
        self._t_s, self._center = prediction.t_s, prediction.T_odom_body.t[-1]
        self._by_scans = prediction.expected is not None
        self._begun: Array | None = None
        """Where the body was in the first round, (3,)."""
        self._weak: Array = np.empty((0, 3))
        self._chosen: FramePoints | None = None

    def pull(
        self, segments: Match, rounds: int, gate_m: float, *, T_odom_body: SE3
    ) -> tuple[Array, Array]:
        """Information (12, 12) and gradient (12,) of the points of a round, as in `Match`.

        Args:
            segments: Match of the segments in this round.
            rounds: Number of the round, from 1.
            gate_m: Points farther from their plane do not match [m].
            T_odom_body: Poses of the body at the times of the prediction, (K,).
        """
        shift = np.zeros(3)
        if self._begun is None:
            self._begun = T_odom_body.t[-1].copy()
        if rounds in self._CHOSEN_IN:
            self._weak = segments.weak_directions(self._max_eigenvalue)
            if rounds == self._CHOSEN_IN[-1] and self._by_scans and len(self._weak) == 1:
                shift = self._to_better_place(T_odom_body, self._begun)
            self._chosen = self._choose(_shifted(T_odom_body, shift)) if len(self._weak) else None
        if self._chosen is None or not len(self._chosen):
            return np.zeros((12, 12)), np.zeros(12)
        match = self._match(self._chosen, _shifted(T_odom_body, shift), gate_m)
        only = _along(self._weak)
        H, g = only @ match.H @ only, only @ match.g
        g = g - H @ _shift_of_both(shift)  # as it is without the shift: a step leads there
        return POINT_MAP.scale * H, POINT_MAP.scale * g

    def _choose(self, T_odom_body: SE3) -> FramePoints:
        return self._map.choose(self._points(), self._t_s, T_odom_body, weak=self._weak)

    def _match(self, points: FramePoints, T_odom_body: SE3, gate_m: float) -> Match:
        return self._map.match(points, self._t_s, T_odom_body, center=self._center, gate_m=gate_m)

    def _to_better_place(self, T_odom_body: SE3, begun: Array) -> Array:
        """Shift to where clearly more points lie on planes, (3,); see `better_place_m`.

        Only a prediction by scans can be beside the place by the depth of a door: an IMU knows the
        motion of a frame to millimeters.
        """
        direction = self._weak[0]
        aside = WEAK_PLACES.aside_m * direction
        chosen = FramePoints.of_all(
            [self._choose(_shifted(T_odom_body, n * aside)) for n in (-1, 0, 1)]
        )
        points = chosen[:: -(-len(chosen) // WEAK_PLACES.max_points) or 1]

        def distances(shift_m: float) -> Array:
            T = _shifted(T_odom_body, shift_m * direction)
            return self._match(points, T, POINT_MAP.gate_m).residual_m

        shifted_m = float(direction @ (T_odom_body.t[-1] - begun))
        return better_place_m(distances, shifted_m=shifted_m) * direction


def _shifted(T_odom_body: SE3, shift: Array) -> SE3:
    """Poses moved by the same shift, (3,)."""
    return SE3(T_odom_body.R, T_odom_body.t + shift)


def _shift_of_both(shift: Array) -> Array:
    """A correction of the poses at start and end by the same shift (3,), (12,)."""
    return np.tile(np.concatenate([np.zeros(3), shift]), 2)


def _along(directions: Array) -> Array:
    """Projection of the poses at start and end on shifts along unit directions (M, 3), (12, 12).

    Points must not turn the body: the segments observe its rotation better, and a map that is
    remembered for long would hold on to an old error of the heading.
    """
    out = np.zeros((12, 12))
    for pose in (START, END_POSE):
        first = pose.start + TRANSLATION.start
        out[first : first + 3, first : first + 3] = directions.T @ directions
    return out
