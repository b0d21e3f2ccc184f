"""The volume of the carrier in the body: where points move with the sensors."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from recon4.classes.tuning import VOLUME
from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import Array
from recon4.kernels.free_space import VERDICT
from recon4.kernels.seen_through import points_in_body
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig


def near_points(frame: Multiframe, rig: Rig) -> tuple[NDArray[np.int64], Array]:
    """Points that may be of the carrier: their rows (M,) and they in the body [m], (M, 3)."""
    rows, p_body = np.empty(len(frame), np.int64), np.empty((len(frame), 3))
    mounts = rig.T_body_sensor
    R, t = np.ascontiguousarray(mounts.R), np.ascontiguousarray(mounts.t)
    limits = np.array([VOLUME.radius_m, VOLUME.low_m, VOLUME.high_m])
    count = points_in_body(frame.xyz, frame.sensor, R, t, limits, rows, p_body)
    return rows[:count], p_body[:count]


def _shape() -> tuple[int, int, int]:
    across = 2 * round(VOLUME.radius_m / VOLUME.cube_m)
    return across, across, round((VOLUME.high_m - VOLUME.low_m) / VOLUME.cube_m)


@dataclass(slots=True, eq=False)
class CarrierVolume:
    """Counts of points by cubes of the body, and which of the cubes the carrier fills.

    The carrier is there in most scans, and where his points are in the map other scans see through.
    A wall beside a corridor is there in most scans, too, but is met by others.
    """

    scans: int = 0
    occupied: NDArray[np.int64] = field(default_factory=lambda: np.zeros(_shape(), np.int64))
    """Scans with points in each cube, (I, J, K)."""
    through: NDArray[np.int64] = field(default_factory=lambda: np.zeros(_shape(), np.int64))
    met: NDArray[np.int64] = field(default_factory=lambda: np.zeros(_shape(), np.int64))
    """Points that other scans see through, and that they meet, (I, J, K)."""

    def learn(self, p_body: Array, verdict: NDArray[np.int8]) -> None:
        """Add the near points of a scan.

        Args:
            p_body: In the body [m], (N, 3).
            verdict: Of `seen_through.find_seen_through`, (N,).
        """
        self.scans += 1
        size, cube = self.occupied.size, _cubes(p_body)
        self.occupied.ravel()[distinct(cube)] += 1
        for counts, what in ((self.through, VERDICT.seen_through), (self.met, VERDICT.met)):
            counts.ravel()[:] += np.bincount(cube[verdict == what], minlength=size)

    def filled(self) -> CarrierCubes:
        """The cubes that the carrier fills, and those around them.

        Who walks along is beside the carrier in many scans, but at no place in nearly all of them.
        """
        from scipy.ndimage import binary_dilation, binary_propagation

        touching = np.ones((3, 3, 3))
        often = max(VOLUME.least_scans, VOLUME.occupied * self.scans)
        inner = (self.occupied >= often) & (self.through > self.met)
        always = inner & (self.occupied >= VOLUME.always * self.scans)
        inner = binary_propagation(always, touching, mask=inner)
        return CarrierCubes(inner, binary_dilation(inner, touching))


@dataclass(frozen=True, slots=True, eq=False)
class CarrierCubes:
    """The volume of the carrier."""

    inner: NDArray[np.bool_]
    """Cubes that he fills in many scans: nothing else can be there, (I, J, K)."""
    around: NDArray[np.bool_]
    """And those that touch them, into which he moves, (I, J, K)."""

    def surely(self, p_body: Array) -> NDArray[np.bool_]:
        """Which near points lie where nothing but the carrier can be, (N, 3) -> (N,)."""
        return np.asarray(self.inner.ravel()[_cubes(p_body)])

    def of(self, p_body: Array, verdict: NDArray[np.int8]) -> NDArray[np.bool_]:
        """Which near points are of the carrier, (N, 3) and (N,) -> (N,)."""
        cube = _cubes(p_body)
        inner, around = self.inner.ravel()[cube], self.around.ravel()[cube]
        return np.asarray(inner | (around & (verdict != VERDICT.met)))


def _cubes(p_body: Array) -> NDArray[np.intp]:
    """Number of the cube of each near point, (N,)."""
    low = np.array([-VOLUME.radius_m, -VOLUME.radius_m, VOLUME.low_m])
    cube = np.floor((p_body - low) / VOLUME.cube_m).astype(np.intp)
    return np.asarray(np.ravel_multi_index(tuple(cube.T), _shape(), mode="clip"))
