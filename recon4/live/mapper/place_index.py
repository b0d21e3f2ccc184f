"""Place index: sub-maps along the path, for relocalization and loop closures."""

from __future__ import annotations

import os
import tempfile
import weakref
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from msgspec import structs
from numpy.typing import NDArray
from scipy import ndimage

from recon4.errors import NoSpace
from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.live.mapper.tuning import PLACE_INDEX, PLAN_MATCH
from recon4.locales.coded import CodedText
from recon4.pose_graph.tuning import graph_tuning
from recon4.registration.overlap import make_range_image, seen_through
from recon4.registration.plane_map import PlaneMap
from recon4.registration.planes import register_to_planes
from recon4.registration.result import Registration
from recon4.registration.tuning import PLANES
from recon4.settings import Settings


@dataclass(frozen=True, slots=True, eq=False)
class _StoredPlace:
    T_map_body: SE3
    ends_body: slice
    """Rows of its segment ends in the body frame [m], in the spill file."""


class PlaceIndex:
    """Sub-maps along the path, and the registration of a new view to one of them."""

    def __init__(self, settings: Settings, *, scratch: Path | None = None) -> None:
        """Create an empty index.

        Args:
            settings: Settings of the registration.
            scratch: Folder of the spill file; None = the system's temporary folder.
        """
        self._settings = settings
        self._planes = structs.replace(PLANES, levels=PLACE_INDEX.levels)
        self._spill = SpillFile(scratch)
        self._places: list[_StoredPlace] = []
        self._at = np.zeros((64, 4))
        """Position [m] and path length [m] of each place; the last rows are spare."""
        self._walked_m = 0.0
        self._last_m: Array | None = None

    def __len__(self) -> int:
        return len(self._places)

    @property
    def walked_m(self) -> float:
        """Path length [m]."""
        return self._walked_m

    def keep(self, T_map_body: SE3, ends_body: Array) -> None:
        """Add a place if the last one is at least `PLACE_INDEX.keep_every_m` away.

        Args:
            T_map_body: Pose of the body.
            ends_body: Segment ends in the body frame [m], (N, 3).
        """
        here = T_map_body.t
        if self._last_m is not None:
            step_m = float(np.linalg.norm(here - self._last_m))
            if step_m < PLACE_INDEX.keep_every_m:
                return
            self._walked_m += step_m
        self._last_m = here
        step = max(1, len(ends_body) // (2 * PLACE_INDEX.segments))
        kept = self._spill.put(ends_body[::step].astype(np.float32))
        if len(self) == len(self._at):
            self._at = np.concatenate([self._at, np.zeros_like(self._at)])
        self._at[len(self)] = [*here, self._walked_m]
        self._places.append(_StoredPlace(T_map_body, kept))

    def revisited(self, p_map: Array, *, within_m: float, walked_before_m: float) -> int | None:
        """The nearest place within ``within_m`` that lies ``walked_before_m`` or more of path back.

        None if there is none.
        """
        # The path length only grows, so the old places come first.
        old = int(np.count_nonzero(self._path_length_m <= self._walked_m - walked_before_m))
        if not old:
            return None
        away_m = self._away_m(p_map)[:old]
        best = int(np.argmin(away_m))
        return best if away_m[best] <= within_m else None

    def locate(self, source: Array, initial: SE3, place: int) -> Registration | None:
        """Register a view to a place; None if the registration is rejected.

        Args:
            source: Segment midpoints in the body frame [m], (N, 3).
            initial: Initial ``T_map_body``.
            place: Row of a place, as from `revisited`.

        Returns:
            Registration with ``T_target_source`` = ``T_map_body``.
        """
        found = register_to_planes(
            self._local_map(place),
            source,
            initial=initial,
            settings=self._settings.registration,
        )
        g = graph_tuning(self._settings.graph)
        range_m = float(np.median(np.linalg.norm(source, axis=1))) if len(source) else 0.0
        fits = (
            found.converged
            and found.error_m <= range_m * g.error_relative + g.error_absolute_m
            and found.match_ratio >= g.min_match_ratio
            and found.degeneracy >= g.min_degeneracy
        )
        return found if fits else None

    def seen_through(self, source: Array, T_map_body: SE3) -> float:
        """Fraction of a view in the free space of the nearest place, or the reverse, 0..1.

        The larger of both; where a view belongs, hardly any: no ray passes through a wall.

        Args:
            source: Segment midpoints in the body frame [m], (N, 3).
            T_map_body: Pose of the view.
        """
        nearest = self._places[self.near(T_map_body.t, most=1)[0]]
        ends_body = np.ascontiguousarray(self._spill.get(nearest.ends_body), dtype=np.float64)
        view, place = make_range_image(source), make_range_image(ends_body)
        return seen_through(view, place, T_map_body.inverse() @ nearest.T_map_body)

    def near(self, p_map: Array, *, most: int, apart_m: float = 0.0) -> list[int]:
        """Rows of the nearest places that are at least ``apart_m`` from each other."""
        at_m = self._at[: len(self), :3]
        chosen: list[int] = []
        for k in np.argsort(self._away_m(p_map), kind="stable").tolist():
            others = np.linalg.norm(at_m[chosen] - at_m[k], axis=1)
            if others.min(initial=np.inf) >= apart_m:
                chosen.append(k)
            if len(chosen) == most:
                break
        return chosen

    def relocate(
        self, source: Array, R: Array, place: int, *, heading: tuple[float, float] | None = None
    ) -> list[tuple[SE3, float]]:
        """Find possible poses of a view near a place, each with its match ratio.

        Args:
            source: Segment midpoints in the body frame [m], (N, 3).
            R: Attitude of the body, (3, 3); roll and pitch are taken from it.
            place: Row of a place.
            heading: Turn of ``R`` in the map and how far it can be from that [rad]; None = any.
        """
        T = self._places[place].T_map_body
        level = SE3(R, np.zeros(3)) @ source
        target = np.concatenate([self._in_map(k) for k in self._around(place)]) - T.t
        found: list[Registration] = []
        for yaw, shift_m in plan_hypotheses(
            _walls(target), _walls(level), most=PLACE_INDEX.hypotheses, heading=heading
        ):
            initial = SE3(so3_exp([0.0, 0.0, yaw]) @ R, T.t + np.append(shift_m, 0.0))
            one = self.locate(source, initial, place)
            if (
                one is not None
                and one.match_ratio >= PLACE_INDEX.sure_match_ratio
                and one.degeneracy >= PLACE_INDEX.sure_degeneracy
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
        return range(
            max(place - PLACE_INDEX.around, 0),
            min(place + PLACE_INDEX.around + 1, len(self._places)),
        )

    def _in_map(self, place: int) -> Array:
        one = self._places[place]
        ends_body = self._spill.get(one.ends_body).astype(np.float64)
        return np.ascontiguousarray(one.T_map_body @ ends_body)


def _walls(p_m: Array) -> Array:
    """Horizontal coordinates of the points between floor and ceiling; heights are body-relative."""
    return p_m[(p_m[:, 2] > -PLACE_INDEX.floor_m) & (p_m[:, 2] < PLACE_INDEX.ceiling_m), :2]


def plan_hypotheses(
    target_m: Array,
    source_m: Array,
    *,
    most: int,
    heading: tuple[float, float] | None = None,
) -> list[tuple[float, Array]]:
    """Rotations and shifts that align most walls of a view with walls of the map, best first.

    The number of points of the view on walls of the map is, for one rotation and all shifts, the
    cross-correlation of the two plans; it is computed by FFT.

    Args:
        target_m: Horizontal wall points of the map relative to the place [m], (N, 2).
        source_m: Horizontal wall points of the view relative to the sensor [m], (M, 2).
        most: Number of hypotheses.
        heading: Yaw and how far the true one can be from it [rad]; None = any.

    Returns:
        Yaw [rad] and shift [m] (2,) that map the view onto the map, up to 5 m away.
    """
    source_m = source_m[np.linalg.norm(source_m, axis=1) < PLAN_MATCH.reach_m]
    if not len(source_m) or not len(target_m):
        return []
    walls = ndimage.gaussian_filter(np.minimum(_raster(target_m), 1.0), 1.0)
    spectrum = np.fft.rfft2(walls)
    yaws = _yaws(heading)
    reach = round(PLAN_MATCH.shift_m / PLAN_MATCH.cell_m)
    shifts = np.arange(-reach, reach + 1)
    scores = np.stack([_scores(spectrum, source_m, yaw)[np.ix_(shifts, shifts)] for yaw in yaws])
    found = []
    for _ in range(most):
        k, i, j = np.unravel_index(int(np.argmax(scores)), scores.shape)
        found.append((float(yaws[k]), np.array([shifts[i], shifts[j]]) * PLAN_MATCH.cell_m))
        _suppress(scores, yaws, (int(k), int(i), int(j)))
    return found


def _yaws(heading: tuple[float, float] | None) -> Array:
    """The yaws that are tried [rad]."""
    center, reach = heading or (np.pi, np.pi)
    steps = int(min(reach, np.pi) / PLAN_MATCH.yaw_step_rad)
    yaws: Array = center + PLAN_MATCH.yaw_step_rad * np.arange(-steps, steps + 1.0)
    return yaws


def _scores(spectrum: NDArray[np.complex128], source_m: Array, yaw: float) -> Array:
    c, s = np.cos(yaw), np.sin(yaw)
    plan = np.minimum(_raster(source_m @ np.array([[c, s], [-s, c]])), 3.0)
    scores: Array = np.fft.irfft2(spectrum * np.conj(np.fft.rfft2(plan)), s=plan.shape)
    return scores


def _raster(p_m: Array) -> Array:
    cells = np.floor(p_m / PLAN_MATCH.cell_m + 0.5).astype(np.int64) + PLAN_MATCH.cells // 2
    cells = cells[((cells >= 0) & (cells < PLAN_MATCH.cells)).all(axis=1)]
    counts = np.bincount(
        cells[:, 0] * PLAN_MATCH.cells + cells[:, 1], minlength=PLAN_MATCH.cells**2
    )
    return counts.reshape(PLAN_MATCH.cells, PLAN_MATCH.cells).astype(np.float64)


def _suppress(scores: Array, yaws: Array, at: tuple[int, int, int]) -> None:
    """Exclude the neighborhood of a maximum, which belongs to the same hypothesis."""
    turned = np.abs(np.angle(np.exp(1j * (yaws - yaws[at[0]]))))
    rows = np.flatnonzero(turned < PLAN_MATCH.apart_rad)
    near = round(PLAN_MATCH.apart_m / PLAN_MATCH.cell_m)
    a, b = max(at[1] - near, 0), max(at[2] - near, 0)
    scores[rows, a : at[1] + near + 1, b : at[2] + near + 1] = -np.inf


class SpillFile:
    """An unnamed temporary file that disappears with the process."""

    def __init__(self, folder: Path | None = None) -> None:
        """Create the file.

        Args:
            folder: Its folder; None = the system's temporary folder.
        """
        self._file, name = tempfile.mkstemp(dir=folder)
        os.unlink(name)
        weakref.finalize(self, os.close, self._file)
        self._end = 0

    def put(self, points: NDArray[np.float32]) -> slice:
        """Append points (N, 3); returns the byte range to read them with `get`.

        Raises:
            NoSpace, OSError: If the disk is full.
        """
        data = np.ascontiguousarray(points).tobytes()
        if os.pwrite(self._file, data, self._end) < len(data):
            raise NoSpace(CodedText("disk-full"))
        where = slice(self._end, self._end + len(data))
        self._end = where.stop
        return where

    def get(self, where: slice) -> NDArray[np.float32]:
        """Read the points of a byte range, (N, 3)."""
        data = os.pread(self._file, where.stop - where.start, where.start)
        return np.frombuffer(data, np.float32).reshape(-1, 3)
