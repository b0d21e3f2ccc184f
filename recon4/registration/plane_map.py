"""Local map of planes: distance of points from the plane at their position."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels import planes
from recon4.kernels.plane_tables import CUBE, EMPTY, compact
from recon4.registration.tuning import PLANES, PlaneTuning
from recon4.registration.tuning_matching import PLANE_MAP


@dataclass(frozen=True, eq=False)
class Match:
    """Normal equations of one round; see `recon4.kernels.planes.accumulate`."""

    H: Array
    """Sum of w J^T J over start and end correction, (12, 12)."""
    g: Array
    """Sum of w J^T r, (12,)."""
    residual_m: Array
    """Distance of each point from its plane [m], NaN = no plane, (N,)."""
    matches: int
    mean_m: float
    """Mean absolute distance [m]; NaN without a match."""
    chi2: float
    normals: Array = field(default_factory=lambda: np.zeros((3, 3)))
    """Mean of n n^T over the matches, map axes, (3, 3)."""

    @cached_property
    def _directions(self) -> tuple[Array, Array]:
        """Eigenvalues of `normals`, increasing, (3,), and their directions in columns, (3, 3)."""
        values, vectors = np.linalg.eigh(self.normals)
        return values, vectors

    @property
    def degeneracy(self) -> float:
        """Smallest eigenvalue of `normals`: 0 = unobservable direction, 1/3 = isotropic."""
        return float(self._directions[0][0])

    @property
    def weak_direction(self) -> Array:
        """Unit direction least constrained by the planes, map axes, (3,); NaN without a match."""
        if not self.matches:
            return np.full(3, np.nan)
        return self._directions[1][:, 0]

    def weak_directions(self, max_eigenvalue: float) -> Array:
        """Unit directions in which `normals` has an eigenvalue below a bound, (M, 3), M ≤ 3."""
        values, vectors = self._directions
        return vectors[:, values < max_eigenvalue].T

    @property
    def match_ratio(self) -> float:
        """Part of the points that found a plane, 0..1."""
        return self.matches / max(len(self.residual_m), 1)


class PlaneMap:
    """Planes fitted to the points in cubes of several sizes; points can be removed again."""

    def __init__(
        self,
        settings: PlaneTuning = PLANES,
        *,
        min_extent_m: float = 0.0,
        max_variance_ratio: float = 0.1,
        min_viewpoints: int = 1,
    ) -> None:
        """An empty map.

        Args:
            settings: Sizes of the cubes, and what a plane is.
            min_extent_m: Smallest standard deviation along a plane in its narrower direction [m].
            max_variance_ratio: Largest ratio of the variance across a plane to that along it.
            min_viewpoints: A cube to which `add` added points less often has no plane.
        """
        self._settings = settings
        self._criteria = np.array(
            [
                settings.min_points, settings.max_sd_m, min_extent_m, max_variance_ratio,
                min_viewpoints,
            ],
            np.float64,
        )  # fmt: skip
        self._sizes: Array = settings.finest_m * np.exp2(np.arange(settings.levels))
        self._keys = np.full(PLANE_MAP.first_capacity, EMPTY, np.int64)
        self._rows = np.zeros(PLANE_MAP.first_capacity, np.int32)
        self._sums: Array = np.zeros((PLANE_MAP.first_capacity // 2, CUBE.sums))
        self._batch = 0
        self._used = 0
        self._make_room_for_fits()

    def __len__(self) -> int:
        """Number of cubes, of all sizes."""
        return self._used

    @property
    def levels(self) -> int:
        """Number of sizes of cubes."""
        return self._settings.levels

    def add(self, p_map: Array, seen_from: Array | None = None) -> None:
        """Add points [m], (N, 3), that were seen from one place, (3,), None = not known.

        A surface whose place is known is not matched by points that see it from its other side.
        """
        self._batch += 1
        self._sum(p_map, 1.0, seen_from)

    def remove(self, p_map: Array, seen_from: Array | None = None) -> None:
        """Remove points that were added before, with exactly the same coordinates."""
        self._sum(p_map, -1.0, seen_from)

    def clear(self) -> None:
        """Remove all points; the memory stays allocated."""
        self._keys.fill(EMPTY)
        self._sums[: self._used] = 0.0  # not those that were never used: they take no memory yet
        self._state.fill(0)
        self._used = 0

    def forget_beyond(self, radius_m: float, center: Array) -> None:
        """Forget all cubes farther from ``center`` (3,) than ``radius_m``."""
        planes.empty_beyond(self._keys, self._rows, self._sums, self._sizes, center, radius_m)
        self._rehash(len(self._keys))

    def fit(self) -> None:
        """Fit all planes now, so that several threads may call `match` at once."""
        planes.fit_all(
            self._keys, self._rows, self._sums, self._fits, self._state, self._sizes,
            self._criteria,
        )  # fmt: skip

    def _sum(self, p_map: Array, sign: float, seen_from: Array | None) -> None:
        row, view = 0, np.full(3, np.nan) if seen_from is None else seen_from
        while True:
            row, self._used = planes.add_points(
                self._keys, self._rows, self._sums, self._state, self._sizes, p_map, row,
                self._used, sign, self._batch, view,
            )  # fmt: skip
            if row == len(p_map):
                return
            self._grow()

    def _grow(self) -> None:
        """Drop cubes that became empty; double the tables if that is not enough."""
        alive = int(np.count_nonzero(self._sums[: self._used, 0] > 0.5))
        self._rehash(len(self._keys) * (2 if 4 * alive > len(self._keys) else 1))

    def _rehash(self, capacity: int) -> None:
        """Drop empty cubes; give the tables room for half as many cubes as ``capacity``."""
        self._fits = np.empty((0, CUBE.fits))  # made again: not beside two tables of sums
        moved, self._used = compact(self._sums, self._used)
        if capacity > len(self._keys):
            longer = np.zeros((capacity // 2, CUBE.sums))  # takes memory where it is written to
            longer[: self._used] = self._sums[: self._used]
            self._sums = longer
        self._keys, self._rows = planes.rehash(self._keys, self._rows, moved, capacity)
        self._make_room_for_fits()

    def _make_room_for_fits(self) -> None:
        self._fits = np.empty((len(self._sums), CUBE.fits))
        self._state = np.zeros(len(self._sums), np.uint8)

    def normals(self, p_map: Array, gate_m: float) -> tuple[Array, Array]:
        """Normal of the finest plane at each point, (N, 3), and how much the plane scatters.

        Both are zero where there is none; the latter is the standard deviation of the points of
        the plane across it [m], (N,).
        """
        out = np.zeros((len(p_map), 4))
        planes.normals(
            self._keys, self._rows, self._sums, self._fits, self._state, self._sizes, p_map,
            gate_m, self._criteria, out,
        )  # fmt: skip
        return out[:, :3], np.sqrt(out[:, 3])

    def match(
        self,
        p_map: Array,
        fraction: Array,
        *,
        center: Array,
        finest: int,
        gate_m: float,
    ) -> Match:
        """Match points to the finest plane at their position.

        Args:
            p_map: Points [m], (N, 3).
            fraction: Time of each within its frame, 0..1, (N,).
            center: Point about which a correction rotates [m], (3,).
            finest: Level to begin with, 0 = smallest cubes.
            gate_m: Points farther from their plane do not match [m].
        """
        s = self._settings
        H, g = np.zeros((12, 12)), np.zeros(12)
        residual_m: NDArray[np.float64] = np.empty(len(p_map))
        matches, total, chi2, normals = planes.accumulate(
            self._keys, self._rows, self._sums, self._fits, self._state, self._sizes,
            p_map, fraction, center, finest, gate_m, s.kernel_m, s.point_sd_m**2,
            self._criteria, H, g, residual_m,
        )  # fmt: skip
        mean_m = total / matches if matches else float("nan")
        return Match(H, g, residual_m, int(matches), mean_m, float(chi2), normals / max(matches, 1))
