"""An elevator: a car that moves with the person in it, and a door that closes for the ride."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.mesh import WorldMesh
from recon4.geometry.raycast import Hits, Scene
from recon4.geometry.se3 import Array


@dataclass(frozen=True, slots=True, eq=False)
class ElevatorCar:
    """The car of an elevator as it stands at height 0."""

    shell: WorldMesh
    """Floor, walls and ceiling; open where the door is."""
    door: WorldMesh
    """Its closed door, only there during a ride."""

    @property
    def reflectivity(self) -> NDArray[np.float32]:
        """Of the triangles of both."""
        return np.concatenate([self.shell.reflectivity, self.door.reflectivity])


@dataclass(frozen=True, slots=True, eq=False)
class Ride:
    """Where a car is during a walk."""

    step_s: float
    """Between two of the heights [s]."""
    height_m: Array
    """Of the floor of the car, (K,)."""
    closed: NDArray[np.bool_]
    """Whether its door is closed, (K,)."""

    def at(self, t_s: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Height [m] and whether the door is closed at some times, (N,) each."""
        slot = np.asarray(t_s) / self.step_s
        height_m = np.interp(slot, np.arange(len(self.height_m)), self.height_m)
        nearest = np.clip(np.rint(slot).astype(np.intp), 0, len(self.closed) - 1)
        return height_m, self.closed[nearest]


class CarScene:
    """A car prepared for ray casting."""

    def __init__(self, car: ElevatorCar) -> None:
        self._shell, self._door = Scene(car.shell), Scene(car.door)
        self._first_of_door = len(car.shell.triangles)

    def hide(
        self, hits: Hits, rays: NDArray[np.float32], *, ride: Ride, t_s: Array, surface: int
    ) -> Hits:
        """Hits after those that meet the car first are replaced.

        Args:
            hits: Of the standing world.
            rays: Origins and unit directions, (N, 6).
            ride: Where the car is.
            t_s: Time of each ray [s], (N,).
            surface: Row of the car's first triangle among all surfaces.
        """
        height_m, closed = ride.at(t_s)
        moved = rays.copy()
        moved[:, 2] -= height_m.astype(np.float32)
        every = np.arange(len(rays))
        out = Hits(hits.range_m.copy(), hits.triangle.copy(), hits.normal.copy())
        parts = [(self._shell, every, 0), (self._door, every[closed], self._first_of_door)]
        for scene, rows, first in parts:
            met = scene.cast(np.ascontiguousarray(moved[rows]))
            nearer = met.range_m < out.range_m[rows]
            out.range_m[rows[nearer]] = met.range_m[nearer]
            out.triangle[rows[nearer]] = met.triangle[nearer] + np.uint32(surface + first)
            out.normal[rows[nearer]] = met.normal[nearer]
        return out
