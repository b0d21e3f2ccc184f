"""Places walked through, to be recognized: after tracking was lost, and when a loop closes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.live.plan_match import plan_guesses
from recon4.registration.plane_map import PlaneMap
from recon4.registration.planes import register_to_planes
from recon4.registration.result import Registration
from recon4.settings import Settings

KEEP_EVERY_M = 1.0
_SEGMENTS = 3000
"""Kept of a place; 72 kB. An hour of walking is 4000 places."""
_AROUND = 3
"""Places before and after one that make up its local map."""
_SURE_SHARE, _SURE_DEGENERACY = 0.5, 0.02
"""What a view must have to be found without a good guess."""
_LEVELS = 2
"""Cells of 0.2 and 0.4 m: guesses are that good, and coarser planes of few points mislead."""
_GUESSES = 3
_FLOOR_M, _CEILING_M = 0.9, 0.8
"""Between so far below and so far above the body there are walls."""


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
        self._planes = replace(settings.planes, levels=_LEVELS)
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
            planes=self._planes,
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

    def near(self, p_map: Array, *, most: int, apart_m: float = 0.0) -> list[int]:
        """The nearest places, so far apart from each other."""
        away = [float(np.linalg.norm(p.T_map_body.t - p_map)) for p in self._places]
        chosen: list[int] = []
        for k in np.argsort(away).tolist():
            here = self._places[k].T_map_body.t
            others = [np.linalg.norm(self._places[c].T_map_body.t - here) for c in chosen]
            if len(chosen) < most and min(others, default=np.inf) >= apart_m:
                chosen.append(int(k))
        return chosen

    def relocate(self, source: Array, R: Array, place: int) -> list[tuple[SE3, float]]:
        """Where a view may be near a place, whatever its heading: poses with the share that fits.

        Args:
            source: Midpoints of segments in the body [m], (N, 3).
            R: Attitude of the body, (3, 3); its roll and pitch are taken for true.
            place: Row of a place.
        """
        T = self._places[place].T_map_body
        level = SE3(R, np.zeros(3)) @ source
        target = np.concatenate([self._in_map(k) for k in self._around(place)]) - T.t
        found: list[Registration] = []
        for yaw, shift_m in plan_guesses(_walls(target), _walls(level), most=_GUESSES):
            guess = SE3(so3_exp([0.0, 0.0, yaw]) @ R, T.t + np.append(shift_m, 0.0))
            one = self.locate(source, guess, place)
            if one is not None and one.share >= _SURE_SHARE and one.degeneracy >= _SURE_DEGENERACY:
                found.append(one)
        return [(one.T_target_source, one.share) for one in found]

    def _nearest(self, rows: list[int], p_map: Array, within_m: float) -> int | None:
        if not rows:
            return None
        away = [float(np.linalg.norm(self._places[k].T_map_body.t - p_map)) for k in rows]
        best = int(np.argmin(away))
        return rows[best] if away[best] <= within_m else None

    def _local_map(self, place: int) -> PlaneMap:
        planes = PlaneMap(self._planes)
        for k in self._around(place):
            planes.add(self._in_map(k))
        return planes

    def _around(self, place: int) -> range:
        return range(max(place - _AROUND, 0), min(place + _AROUND + 1, len(self._places)))

    def _in_map(self, place: int) -> Array:
        one = self._places[place]
        return np.ascontiguousarray(one.T_map_body @ one.ends_body.astype(np.float64))


def _walls(p_m: Array) -> Array:
    """Points between floor and ceiling, in plan; heights count from the body."""
    return p_m[(p_m[:, 2] > -_FLOOR_M) & (p_m[:, 2] < _CEILING_M), :2]
