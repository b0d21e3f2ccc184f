"""Positions of surveyed points in the map, and the directions in which they were measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.slices.tuning import MEASURED


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredPosition:
    """Where a surveyed point was found.

    A point on a surface is measured across the surface only: along it, any other point of the
    surface would be as good. A point identified in a slice is measured in the plane of the slice.
    """

    xyz_m: Array
    """Position [m], (3,)."""
    along: Array
    """Measured directions, orthonormal rows, (1..3, 3)."""

    @staticmethod
    def full(xyz_m: Array) -> MeasuredPosition:
        """A position measured in all three directions."""
        return MeasuredPosition(np.asarray(xyz_m, dtype=np.float64), np.eye(3))

    @property
    def axes(self) -> tuple[bool, bool, bool]:
        """Whether east, north and up are measured."""
        east, north, up = (np.linalg.norm(self.along, axis=0) >= MEASURED.in_span).tolist()
        return east, north, up

    def offset(self, surveyed_m: Array) -> Array:
        """Map minus survey in the measured directions [m], (3,); zero in the others."""
        d: Array = (self.xyz_m - surveyed_m) @ self.along.T @ self.along
        return d

    def turned(self, R_b_a: Array, xyz_b_m: Array) -> MeasuredPosition:
        """The same position with coordinates in another frame ``b``; ``R_b_a`` (3, 3)."""
        return MeasuredPosition(xyz_b_m, orthonormal(self.along @ R_b_a.T))


def orthonormal(directions: Array | Sequence[Sequence[float]]) -> Array:
    """Orthonormal rows that span the given directions, (1..3, 3).

    Raises:
        ConfigError: If there is no direction.
    """
    rows = np.asarray(directions, dtype=np.float64).reshape(-1, 3)
    length = np.linalg.norm(rows, axis=1)
    rows = rows[length > 1e-9] / length[length > 1e-9, None]
    _, size, Vt = np.linalg.svd(rows, full_matrices=False)
    found: Array = Vt[size > 1e-3]
    if not len(found):
        raise ConfigError(CodedText("measured-directions"))
    return found
