"""Places walked through, to be recognized: after tracking was lost, and when a loop closes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.registration.plane_map import PlaneMap
from recon4.registration.planes import register_to_planes
from recon4.registration.result import Registration
from recon4.settings import Settings

KEEP_EVERY_M = 1.0
_SEGMENTS = 3000
"""Kept of a place; 72 kB. An hour of walking is 4000 places."""
_AROUND = 3
"""Places before and after one that make up its local map."""
_YAWS_RAD = np.deg2rad([0.0, 45.0, -45.0, 90.0, -90.0, 135.0, -135.0, 180.0])


@dataclass(frozen=True, slots=True, eq=False)
class _Place:
    T_map_body: SE3
    ends_body: NDArray[np.float32]
    """Ends of segments [m], (2 M, 3)."""
    walked_m: float


class Places:
    """Submaps along the way, and the registration of a new view to one of them."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._places: list[_Place] = []
        self._walked_m = 0.0
        self._last_m: Array | None = None

    def __len__(self) -> int:
        return len(self._places)

    @property
    def walked_m(self) -> float:
        """Length of the way [m]."""
        return self._walked_m

    def keep(self, T_map_body: SE3, ends_body: Array) -> None:
        """Remember this place if the last one is far enough away.

        Args:
            T_map_body: Pose of the body.
            ends_body: Ends of segments in the body [m], (N, 3).
        """
        here = T_map_body.t
        if self._last_m is not None:
            step_m = float(np.linalg.norm(here - self._last_m))
            if step_m < KEEP_EVERY_M:
                return
            self._walked_m += step_m
        self._last_m = here
        step = max(1, len(ends_body) // (2 * _SEGMENTS))
        kept = ends_body[::step].astype(np.float32)
        self._places.append(_Place(T_map_body, kept, self._walked_m))

    def revisited(self, p_map: Array, *, within_m: float, walked_before_m: float) -> int | None:
        """The nearest place that was left at least so much of the way ago; None = none near."""
        old = [
            k for k, p in enumerate(self._places) if self._walked_m - p.walked_m >= walked_before_m
        ]
        return self._nearest(old, p_map, within_m)

    def locate(self, source: Array, guess: SE3, place: int) -> Registration | None:
        """Register a view to a place; None if it does not fit.

        Args:
            source: Midpoints of segments in the body [m], (N, 3).
            guess: First ``T_map_body``.
            place: Of `revisited`.

        Returns:
            With ``T_target_source`` = ``T_map_body``.
        """
        found = register_to_planes(
            self._local_map(place),
            source,
            guess=guess,
            planes=self._settings.planes,
            settings=self._settings.registration,
        )
        g = self._settings.graph
        range_m = float(np.median(np.linalg.norm(source, axis=1))) if len(source) else 0.0
        fits = (
            found.converged
            and found.error_m <= range_m * g.error_relative + g.error_absolute_m
            and found.share >= g.min_share
            and found.degeneracy >= g.min_degeneracy
        )
        return found if fits else None

    def relocate(self, source: Array, T_map_body: SE3) -> SE3 | None:
        """Where a view is after tracking was lost: near the last pose believed, any heading.

        Args:
            source: Midpoints of segments in the body [m], (N, 3).
            T_map_body: The pose believed; its roll and pitch are taken for true.
        """
        best: Registration | None = None
        for place in self._candidates(T_map_body.t):
            for yaw in _YAWS_RAD:
                R = so3_exp([0.0, 0.0, yaw]) @ T_map_body.R
                found = self.locate(source, SE3(R, self._places[place].T_map_body.t), place)
                if found is not None and (best is None or found.share > best.share):
                    best = found
            if best is not None:
                return best.T_target_source
        return None

    def _candidates(self, p_map: Array) -> list[int]:
        """The last places first, then the nearest ones."""
        count = len(self._places)
        away = [float(np.linalg.norm(p.T_map_body.t - p_map)) for p in self._places]
        near = [int(k) for k in np.argsort(away)[:3]]
        return list(dict.fromkeys([*range(count - 1, max(count - 4, -1), -2), *near]))

    def _nearest(self, rows: list[int], p_map: Array, within_m: float) -> int | None:
        if not rows:
            return None
        away = [float(np.linalg.norm(self._places[k].T_map_body.t - p_map)) for k in rows]
        best = int(np.argmin(away))
        return rows[best] if away[best] <= within_m else None

    def _local_map(self, place: int) -> PlaneMap:
        planes = PlaneMap(self._settings.planes)
        for k in range(max(place - _AROUND, 0), min(place + _AROUND + 1, len(self._places))):
            one = self._places[k]
            planes.add(np.ascontiguousarray(one.T_map_body @ one.ends_body.astype(np.float64)))
        return planes
