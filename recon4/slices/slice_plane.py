"""Cuts through the map: horizontal, vertical and free planes with a thickness."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.slices.tuning_files import SLICE_PLANES

Kind = Literal["horizontal", "vertical", "free"]
Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class PlanePosition:
    """Where a plane lies, in the numbers by which people name it."""

    kind: Kind
    normal: Vector
    """Unit vector in the map."""
    offset_m: float
    """``normal · p`` of its points [m]: the height of a horizontal plane."""
    azimuth_deg: float
    """Direction of the line of a vertical plane, clockwise from y [°]; 0 of other planes."""

    @property
    def text(self) -> str:
        """It in English: ``z = 1.200 m``."""
        if self.kind == "horizontal":
            return f"z = {self.offset_m:.3f} m"
        if self.kind == "vertical":
            return f"azimuth {self.azimuth_deg:.1f}°, offset {self.offset_m:.3f} m"
        n = ", ".join(f"{x:.3f}" for x in self.normal)
        return f"normal ({n}), offset {self.offset_m:.3f} m"


@dataclass(frozen=True, slots=True)
class SlicePlane:
    """A slab of the map and the axes of its image.

    ``u`` points to the right, ``v`` up, and the viewer looks against ``u × v``. A horizontal slice
    has the map's own x and y; a vertical one the distance along its line, and the map's z.

    >>> section = api.SlicePlane.vertical((0.0, 0.0), (0.0, 5.0), thickness_m=0.05)
    >>> section.name, section.to_plane([[0.01, 2.0, 1.5]]).tolist()
    ('azimuth 0.0°, offset 0.000 m', [[2.0, 1.5, 0.01]])
    >>> [plane.name for plane in api.SlicePlane.horizontal(0.5).repeated(2, spacing_m=0.5)]
    ['z = 0.500 m', 'z = 1.000 m']
    """

    kind: Kind
    origin_m: Vector
    """Point of the map where u, v and the distance from the plane are 0 [m]."""
    u: Vector
    v: Vector
    thickness_m: float = SLICE_PLANES.looking_thickness_m

    def __post_init__(self) -> None:
        numbers = np.array([*self.origin_m, *self.u, *self.v, self.thickness_m])
        if not np.isfinite(numbers).all() or np.abs(numbers).max() > 1e8:
            raise ConfigError(CodedText("slice-finite", numbers=str(numbers.tolist())))
        if not 0.0 < self.thickness_m <= SLICE_PLANES.max_thickness_m:
            raise ConfigError(
                CodedText(
                    "slice-thickness",
                    max_thickness_m=SLICE_PLANES.max_thickness_m,
                    thickness_m=self.thickness_m,
                )
            )

    @staticmethod
    def horizontal(
        z_m: float, *, thickness_m: float = SLICE_PLANES.looking_thickness_m
    ) -> SlicePlane:
        """A floor plan at a height of the map."""
        return SlicePlane(
            "horizontal", (0.0, 0.0, z_m), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), thickness_m
        )

    @staticmethod
    def vertical(
        a_m: tuple[float, float],
        b_m: tuple[float, float],
        *,
        thickness_m: float = SLICE_PLANES.looking_thickness_m,
    ) -> SlicePlane:
        """A section through two points seen from above; u counts from the first.

        Raises:
            ConfigError: If the points are less than 1 mm apart.
        """
        along = np.array(b_m, dtype=np.float64) - a_m
        length_m = float(np.linalg.norm(along))
        if not length_m >= 0.001:
            raise ConfigError(CodedText("slice-line-short"))
        u = (*(along / length_m).tolist(), 0.0)
        origin = (float(a_m[0]), float(a_m[1]), 0.0)
        return SlicePlane("vertical", origin, u, (0.0, 0.0, 1.0), thickness_m)

    @staticmethod
    def free(
        origin_m: Vector, normal: Vector, *, thickness_m: float = SLICE_PLANES.looking_thickness_m
    ) -> SlicePlane:
        """Any plane. v is as near to the map's z as it can be (to y, if the plane is level).

        Raises:
            ConfigError: If the normal has no direction.
        """
        length = float(np.linalg.norm(normal))
        if not (np.isfinite(length) and length > 1e-9):
            raise ConfigError(CodedText("slice-normal", normal=str(normal)))
        n = np.array(normal) / length
        up = np.array([0.0, 0.0, 1.0]) if abs(n[2]) < 0.999 else np.array([0.0, 1.0, 0.0])
        u = np.cross(up, n)
        u /= np.linalg.norm(u)
        return SlicePlane("free", origin_m, _vector(u), _vector(np.cross(n, u)), thickness_m)

    @property
    def axes(self) -> Array:
        """Unit vectors u, v and normal in the map, rows of (3, 3)."""
        return np.array([self.u, self.v, np.cross(self.u, self.v)])

    @property
    def normal(self) -> Array:
        """Unit normal ``u × v``, (3,)."""
        return self.axes[2]

    @property
    def offset_m(self) -> float:
        """``normal · p`` of the points of the plane [m]."""
        return float(self.normal @ np.array(self.origin_m))

    def to_plane(self, p_map: Array) -> Array:
        """u, v and distance from the plane of points of the map [m], (N, 3) -> (N, 3)."""
        out: Array = (np.asarray(p_map, dtype=np.float64) - self.origin_m) @ self.axes.T
        return out

    def to_map(self, uvd: Array) -> Array:
        """Points of the map at u, v and distance from the plane [m], (N, 3) -> (N, 3)."""
        out: Array = np.asarray(uvd, dtype=np.float64) @ self.axes + self.origin_m
        return out

    def moved(self, distance_m: float) -> SlicePlane:
        """The same slice farther along its normal."""
        origin = np.array(self.origin_m) + distance_m * self.normal
        return replace(self, origin_m=_vector(origin))

    def repeated(self, count: int, *, spacing_m: float) -> tuple[SlicePlane, ...]:
        """This slice and those behind it along the normal, at equal distances.

        Raises:
            ConfigError: If there are none or too many, or they do not move.
        """
        if not 1 <= count <= SLICE_PLANES.max_slices:
            raise ConfigError(
                CodedText("slice-count", max_slices=SLICE_PLANES.max_slices, count=count)
            )
        if count > 1 and not 0.001 <= abs(spacing_m) <= 1000.0:
            raise ConfigError(CodedText("slice-spacing", spacing_m=spacing_m))
        return tuple(self.moved(k * spacing_m) for k in range(count))

    @property
    def position(self) -> PlanePosition:
        """Where it lies, in the numbers by which people name it."""
        azimuth_deg = 0.0
        if self.kind == "vertical":
            azimuth_deg = float(np.rad2deg(np.arctan2(self.u[0], self.u[1])) % 360.0)
        return PlanePosition(self.kind, _vector(self.normal), self.offset_m, azimuth_deg)

    @property
    def name(self) -> str:
        """Text of the position: ``z = 1.200 m``."""
        return self.position.text


def _vector(values: Array) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
