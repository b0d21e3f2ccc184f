"""Places walked through, to be recognized: after tracking was lost, and when a loop closes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.live.mapper.plan_match import plan_hypotheses
from recon4.live.mapper.spill_file import SpillFile
from recon4.registration.plane_map import PlaneMap
from recon4.registration.planes import register_to_planes
from recon4.registration.result import Registration
from recon4.settings import Settings

KEEP_EVERY_M = 1.0
_SEGMENTS = 3000
"""Kept of a place, up to twice as many; 72 to 144 kB. An hour of walking is 4000 places: they
wait in a file."""
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
class _StoredPlace:
    T_map_body: SE3
    ends_body: slice
    """Its ends of segments in the body [m], on the shelf."""


class PlaceIndex:
    """Submaps along the way, and the registration of a new view to one of them."""

    def __init__(self, settings: Settings, *, scratch: Path | None = None) -> None:
        """Begin without any.

        Args:
            settings: How views are registered.
            scratch: Folder of the file; None = the system's.
        """
        self._settings = settings
        self._planes = replace(settings.planes, levels=_LEVELS)
        self._shelf = SpillFile(scratch)
        self._places: list[_StoredPlace] = []
        self._at = np.zeros((64, 4))
        """Position [m] and length of the way until there [m] of each place, and room for more."""
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
        kept = self._shelf.put(ends_body[::step].astype(np.float32))
        if len(self) == len(self._at):
            self._at = np.concatenate([self._at, np.zeros_like(self._at)])
        self._at[len(self)] = [*here, self._walked_m]
        self._places.append(_StoredPlace(T_map_body, kept))

    def revisited(self, p_map: Array, *, within_m: float, walked_before_m: float) -> int | None:
        """The nearest place that was left at least so much of the way ago; None = none near."""
        # The way only grows: the old ones come first.
        old = int(np.count_nonzero(self._path_length_m <= self._walked_m - walked_before_m))
        if not old:
            return None
        away_m = self._away_m(p_map)[:old]
        best = int(np.argmin(away_m))
        return best if away_m[best] <= within_m else None

    def locate(self, source: Array, initial: SE3, place: int) -> Registration | None:
        """Register a view to a place; None if it does not fit.

        Args:
            source: Midpoints of segments in the body [m], (N, 3).
            initial: First ``T_map_body``.
            place: Of `revisited`.

        Returns:
            With ``T_target_source`` = ``T_map_body``.
        """
        found = register_to_planes(
            self._local_map(place),
            source,
            initial=initial,
            planes=self._planes,
            settings=self._settings.registration,
        )
        g = self._settings.graph
        range_m = float(np.median(np.linalg.norm(source, axis=1))) if len(source) else 0.0
        fits = (
            found.converged
            and found.error_m <= range_m * g.error_relative + g.error_absolute_m
            and found.match_ratio >= g.min_match_ratio
            and found.degeneracy >= g.min_degeneracy
        )
        return found if fits else None

    def near(self, p_map: Array, *, most: int, apart_m: float = 0.0) -> list[int]:
        """The nearest places, so far apart from each other."""
        at_m = self._at[: len(self), :3]
        chosen: list[int] = []
        for k in np.argsort(self._away_m(p_map), kind="stable").tolist():
            others = np.linalg.norm(at_m[chosen] - at_m[k], axis=1)
            if others.min(initial=np.inf) >= apart_m:
                chosen.append(k)
            if len(chosen) == most:
                break
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
        for yaw, shift_m in plan_hypotheses(_walls(target), _walls(level), most=_GUESSES):
            initial = SE3(so3_exp([0.0, 0.0, yaw]) @ R, T.t + np.append(shift_m, 0.0))
            one = self.locate(source, initial, place)
            if (
                one is not None
                and one.match_ratio >= _SURE_SHARE
                and one.degeneracy >= _SURE_DEGENERACY
            ):
                found.append(one)
        return [(one.T_target_source, one.match_ratio) for one in found]

    @property
    def _path_length_m(self) -> Array:
        return self._at[: len(self), 3]

    def _away_m(self, p_map: Array) -> Array:
        away_m: Array = np.linalg.norm(self._at[: len(self), :3] - p_map, axis=1)
        return away_m

    def _local_map(self, place: int) -> PlaneMap:
        planes = PlaneMap(self._planes)
        for k in self._around(place):
            planes.add(self._in_map(k))
        return planes

    def _around(self, place: int) -> range:
        return range(max(place - _AROUND, 0), min(place + _AROUND + 1, len(self._places)))

    def _in_map(self, place: int) -> Array:
        one = self._places[place]
        ends_body = self._shelf.get(one.ends_body).astype(np.float64)
        return np.ascontiguousarray(one.T_map_body @ ends_body)


def _walls(p_m: Array) -> Array:
    """Points between floor and ceiling, in plan; heights count from the body."""
    return p_m[(p_m[:, 2] > -_FLOOR_M) & (p_m[:, 2] < _CEILING_M), :2]
