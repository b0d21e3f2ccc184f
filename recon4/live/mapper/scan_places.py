"""Places along the path of a 2-D laser, for loop closures during a capture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se2 import between, compose, from_se3, inverse, transform, wrap
from recon4.geometry.se3 import Array
from recon4.live.mapper.tuning import SCAN_PLACES
from recon4.model.pose_graph import Edge
from recon4.settings import Settings
from recon4.settings.tuning import tuned
from recon4.slam2d.candidates import Candidate2d
from recon4.slam2d.keyframes import Keyframes
from recon4.slam2d.scan_points import ScanPoints
from recon4.slam2d.submaps import SubmapRegistrar
from recon4.slam2d.tuning import Loop2dTuning, Slam2dTuning


@dataclass(frozen=True, slots=True, eq=False)
class _Keyframe:
    pose: Array
    """``T_map_laser`` when it was stored: x [m], y [m], yaw [rad], (3,)."""
    points: NDArray[np.float32]
    """Its returns [m], (P, 2)."""
    weights: NDArray[np.float32]
    run: int
    """Number of the stretch without a restarted local map."""


@dataclass(frozen=True, slots=True, eq=False)
class PlaceMatch:
    """A place visited before, and the pose by it."""

    pose: Array
    """``T_map_laser`` by the registration: x [m], y [m], yaw [rad], (3,)."""
    accepted: bool
    """Whether it may be used: enough matches, no direction that is not observed."""


class ScanPlaces:
    """Keyframes of the path, and the registration of the newest ones to earlier ones."""

    def __init__(self, settings: Settings) -> None:
        self._slam = tuned(Slam2dTuning, settings.slam2d)
        self._loops = tuned(Loop2dTuning, settings.loops2d)
        self._keyframes: list[_Keyframe] = []
        self._at = np.zeros((64, 3))
        """x [m], y [m] and path length [m] of each keyframe; the last rows are spare."""
        self.walked_m = 0.0
        self._run = 0
        self._closed_m = 0.0
        """Path length at the last place that was recognized [m]."""
        self._unknown_m = 0.0
        """Motion since then that nothing observed [m]."""

    def __len__(self) -> int:
        return len(self._keyframes)

    def keep(self, pose: Array, seen: ScanPoints) -> None:
        """Store a keyframe.

        Args:
            pose: ``T_map_laser``.
            seen: Its returns.
        """
        count = len(self)
        if count == len(self._at):
            self._at = np.concatenate([self._at, np.zeros_like(self._at)])
        if count:
            self.walked_m += float(np.hypot(*(pose[:2] - self._at[count - 1, :2])))
        self._at[count] = [pose[0], pose[1], self.walked_m]
        step = max(1, len(seen.points) // SCAN_PLACES.most_returns)
        self._keyframes.append(
            _Keyframe(
                pose,
                seen.points[::step].astype(np.float32),
                (step * seen.weights[::step]).astype(np.float32),
                self._run,
            )
        )

    def restart(self, unknown_m: float) -> None:
        """The local map started again: the motion since then is known to this [m]."""
        self._run += 1
        self._unknown_m += unknown_m

    @property
    def newest(self) -> Array:
        """``T_map_laser`` of the newest keyframe, (3,)."""
        return self._keyframes[-1].pose

    def views(self) -> Iterator[tuple[Array, Array]]:
        """Pose and returns in the map of each keyframe, (3,) and (P, 2)."""
        for one in self._keyframes:
            yield one.pose, transform(one.pose, one.points.astype(np.float64))

    def correct(self, place: int, found: Array) -> None:
        """Move the keyframes so that the newest one gets the pose that was found.

        Those since the place bend, in proportion to the path; after a restart of the local map all
        since then move together.

        Args:
            place: The keyframe that was recognized.
            found: ``T_map_laser`` of the newest one by it, (3,).
        """
        newest = self._keyframes[-1]
        off = found - newest.pose
        off[2] = wrap(off[2])
        rigid = compose(found, inverse(newest.pose))
        joined = self._keyframes[place].run == newest.run
        span_m = max(self.walked_m - float(self._at[place, 2]), 1e-6)
        for row in range(place + 1, len(self)):
            one = self._keyframes[row]
            if joined:
                pose = one.pose + off * (self._at[row, 2] - self._at[place, 2]) / span_m
                pose[2] = wrap(pose[2])
            elif one.run == newest.run:
                pose = compose(rigid, one.pose)
            else:
                continue
            self._keyframes[row] = replace(one, pose=pose)
            self._at[row, :2] = pose[:2]

    def recognized(self) -> None:
        """The newest keyframe was placed in the map by an earlier one."""
        self._closed_m, self._unknown_m = self.walked_m, 0.0

    def revisited(self) -> int | None:
        """The nearest keyframe of an earlier visit; None = there is none."""
        if not len(self):
            return None
        loops, last = self._loops, len(self) - 1
        at = self._at[: last + 1]
        reach_m = loops.reach_m + self._drift_m
        away_m = np.hypot(at[:, 0] - at[last, 0], at[:, 1] - at[last, 1])
        earlier = at[last, 2] - at[:, 2] >= loops.min_path_m
        if self._unknown_m:
            earlier |= np.array([one.run != self._run for one in self._keyframes])
        near = np.flatnonzero(earlier & (away_m <= reach_m))
        return int(near[np.argmin(away_m[near])]) if len(near) else None

    def locate(self, place: int) -> PlaceMatch:
        """Register the newest keyframes to those around an earlier one."""
        loops, settings = self._loops, self._slam
        last = len(self) - 1
        of_place = range(max(place - loops.target_reach, 0), place + loops.target_reach + 1)
        of_place = range(of_place.start, min(of_place.stop, last))
        newest = range(max(last - loops.source_reach, of_place.stop), last + 1)
        rows = [*of_place, *newest]
        registrar = SubmapRegistrar(self._batch(rows), settings=settings, loops=loops)
        pair = Candidate2d(rows.index(place), len(rows) - 1, self._drift_m, self._drift_rad(place))
        T_map_place = self._keyframes[place].pose
        edge = registrar.register_pair(pair, between(T_map_place, self._keyframes[last].pose))
        return self._match(edge, T_map_place)

    def _match(self, edge: Edge, T_map_place: Array) -> PlaceMatch:
        return PlaceMatch(compose(T_map_place, from_se3(edge.T_i_j)), accepted=edge.in_graph)

    @property
    def _drift_m(self) -> float:
        """What the pose may be off since the last place that was recognized [m]."""
        path_m = self.walked_m - self._closed_m
        drift_m = self._loops.drift_ratio * path_m + self._unknown_m
        return float(np.clip(drift_m, SCAN_PLACES.least_drift_m, SCAN_PLACES.most_drift_m))

    def _drift_rad(self, place: int) -> float:
        path_m = self.walked_m - float(self._at[place, 2])
        drift_rad = self._loops.drift_rad_m * path_m + 0.1 * self._unknown_m
        return min(drift_rad, SCAN_PLACES.most_drift_rad)

    def _batch(self, rows: list[int]) -> Keyframes:
        chosen = [self._keyframes[row] for row in rows]
        return Keyframes(
            rows=np.array(rows, np.intp),
            t_ns=np.arange(len(rows), dtype=np.int64),
            pose=np.stack([one.pose for one in chosen]),
            information=np.zeros((len(rows), 3, 3)),
            scans=tuple(
                ScanPoints(one.points.astype(np.float64), one.weights.astype(np.float64))
                for one in chosen
            ),
            run=np.array([one.run for one in chosen], np.intp),
            path_m=self._at[rows, 2],
        )
