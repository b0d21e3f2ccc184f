"""Triangle meshes with a reflectivity per triangle, and shapes to build simulated worlds."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from recon4.geometry.se3 import Array

_BOX_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
_BOX_TRIANGLES = np.array(
    [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]
)  # fmt: skip


class SurfaceKind(IntEnum):
    """What a surface of a simulated world is of: the truth for classes of points."""

    THING = 0
    """Furniture, cars, poles, wires: all that is none of the others."""
    GROUND = 1
    """Earth, streets, floors, steps and landings, whatever side of them."""
    BUILDING = 2
    """Walls with what is in their openings, ceilings, roofs."""
    VEGETATION = 3


@dataclass(frozen=True, slots=True, eq=False)
class WorldMesh:
    """Triangle mesh of a simulated world."""

    vertices_m: NDArray[np.float32]
    """Corners in the map [m], (V, 3)."""
    triangles: NDArray[np.uint32]
    """Rows of ``vertices_m``, counter-clockwise from outside where there is one, (T, 3)."""
    reflectivity: NDArray[np.float32]
    """Diffuse reflectivity 0..1 of each triangle, (T,). Above 1: retro-reflective.
    Below `SURFACES.glass`: a pane that reflects only at nearly perpendicular incidence. Up to
    `SURFACES.clear`: a pane that one sees through; up to `SURFACES.mirror`: a mirror."""
    kind: NDArray[np.uint8]
    """`SurfaceKind` of each triangle, (T,)."""


@dataclass(slots=True)
class MeshBuilder:
    """Collects shapes and merges them to one mesh."""

    _vertices: list[Array] = field(default_factory=list)
    _triangles: list[NDArray[np.int64]] = field(default_factory=list)
    _reflectivity: list[Array] = field(default_factory=list)
    _kinds: list[NDArray[np.uint8]] = field(default_factory=list)
    _kind: SurfaceKind = SurfaceKind.THING
    _count: int = 0

    @contextmanager
    def of(self, kind: SurfaceKind) -> Iterator[None]:
        """All shapes that are added meanwhile are of a kind."""
        before, self._kind = self._kind, kind
        try:
            yield
        finally:
            self._kind = before

    def add(self, vertices_m: Array, triangles: NDArray[np.int64], reflectivity: ArrayLike) -> None:
        """Add triangles, (V, 3) and (T, 3), with one reflectivity or (T,)."""
        self._vertices.append(np.asarray(vertices_m, dtype=np.float64))
        self._triangles.append(np.asarray(triangles, dtype=np.int64) + self._count)
        self._reflectivity.append(np.broadcast_to(np.asarray(reflectivity, float), len(triangles)))
        self._kinds.append(np.full(len(triangles), self._kind, np.uint8))
        self._count += len(vertices_m)

    def place(self, other: MeshBuilder, shift_m: ArrayLike) -> None:
        """Add the shapes of another builder, moved by (3,) [m]."""
        mesh = other.mesh()
        moved = mesh.vertices_m.astype(np.float64) + np.asarray(shift_m, dtype=np.float64)
        self.add(moved, mesh.triangles.astype(np.int64), mesh.reflectivity)
        self._kinds[-1] = mesh.kind

    def mesh(self) -> WorldMesh:
        """Everything added so far."""
        return WorldMesh(
            np.concatenate(self._vertices).astype(np.float32),
            np.concatenate(self._triangles).astype(np.uint32),
            np.concatenate(self._reflectivity).astype(np.float32),
            np.concatenate(self._kinds),
        )

    def quad(self, corner: ArrayLike, u: ArrayLike, v: ArrayLike, *, reflectivity: float) -> None:
        """A parallelogram from a corner along two edges [m]."""
        c, u, v = (np.asarray(x, dtype=np.float64) for x in (corner, u, v))
        corners = np.stack([c, c + u, c + u + v, c + v])
        self.add(corners, np.array([[0, 1, 2], [0, 2, 3]]), reflectivity)

    def box(self, low: ArrayLike, high: ArrayLike, reflectivity: float) -> None:
        """An upright box between two corners [m]."""
        low, high = np.asarray(low, dtype=np.float64), np.asarray(high, dtype=np.float64)
        self.add(low + _BOX_CORNERS * (high - low), _BOX_TRIANGLES, reflectivity)

    def block(
        self, center: ArrayLike, size: ArrayLike, reflectivity: float, *, yaw_rad: float = 0.0
    ) -> None:
        """A box turned around the vertical; ``center`` is the middle of its bottom face [m]."""
        local = (_BOX_CORNERS - [0.5, 0.5, 0.0]) * np.asarray(size, dtype=np.float64)
        c, s = np.cos(yaw_rad), np.sin(yaw_rad)
        turned = local @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        self.add(np.asarray(center, dtype=np.float64) + turned, _BOX_TRIANGLES, reflectivity)

    def tube(
        self,
        start: ArrayLike,
        end: ArrayLike,
        radius_m: float | tuple[float, float],
        *,
        reflectivity: float,
        sides: int = 6,
    ) -> None:
        """A closed prism around an axis: pole, rail, wire; a trunk or cone has two radii [m]."""
        a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
        axis = (b - a) / np.linalg.norm(b - a)
        side = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.9 else [0.0, 1.0, 0.0])
        side /= np.linalg.norm(side)
        angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
        ring = np.outer(np.cos(angle), side) + np.outer(np.sin(angle), np.cross(axis, side))
        near_m, far_m = radius_m if isinstance(radius_m, tuple) else (radius_m, radius_m)
        corners = np.vstack([a + near_m * ring, b + far_m * ring, a, b])
        k = np.arange(sides)
        n = (k + 1) % sides
        low, high = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
        parts = [(k, n, n + sides), (k, n + sides, k + sides), (low, n, k)]
        parts += [(high, k + sides, n + sides)]
        self.add(corners, np.concatenate([np.stack(p, axis=1) for p in parts]), reflectivity)

    def ball(
        self,
        center: ArrayLike,
        radii: ArrayLike,
        reflectivity: float,
        *,
        bumps: Array | None = None,
    ) -> None:
        """An ellipsoid; ``bumps`` (rows, columns) scales its corners (tree crowns), else 7 x 12."""
        rows, columns = (7, 12) if bumps is None else bumps.shape
        polar = np.linspace(0.0, np.pi, rows)[:, None]
        azimuth = np.linspace(0.0, 2.0 * np.pi, columns, endpoint=False)[None, :]
        unit = np.stack(
            [
                np.sin(polar) * np.cos(azimuth),
                np.sin(polar) * np.sin(azimuth),
                np.cos(polar) + 0.0 * azimuth,
            ],
            axis=-1,
        )
        scale = np.ones((rows, columns)) if bumps is None else bumps
        corners = np.asarray(center) + (unit * scale[..., None] * np.asarray(radii)).reshape(-1, 3)
        self.add(corners, _grid_triangles(rows, columns, wrap=True), reflectivity)

    def terrain(self, x_m: Array, y_m: Array, z_m: Array, *, reflectivity: ArrayLike) -> None:
        """A height field: x (M,), y (N,), z (N, M) [m]; reflectivity: one, or (N-1, M-1) cells."""
        grid_x, grid_y = np.meshgrid(x_m, y_m)
        corners = np.stack([grid_x, grid_y, z_m], axis=-1).reshape(-1, 3)
        triangles = _grid_triangles(len(y_m), len(x_m), wrap=False)
        values = np.asarray(reflectivity, dtype=np.float64)
        self.add(corners, triangles, values if values.ndim == 0 else np.repeat(values.ravel(), 2))


def joined(a: WorldMesh, b: WorldMesh) -> WorldMesh:
    """One mesh of two; the triangles of ``a`` keep their rows."""
    return WorldMesh(
        np.concatenate([a.vertices_m, b.vertices_m]),
        np.concatenate([a.triangles, b.triangles + np.uint32(len(a.vertices_m))]),
        np.concatenate([a.reflectivity, b.reflectivity]),
        np.concatenate([a.kind, b.kind]),
    )


def _grid_triangles(rows: int, columns: int, *, wrap: bool) -> NDArray[np.int64]:
    """Two triangles per cell of a grid of corners, cell by cell."""
    r, c = np.mgrid[0 : rows - 1, 0 : columns if wrap else columns - 1]
    right = (c + 1) % columns
    a, b = r * columns + c, r * columns + right
    d, e = (r + 1) * columns + c, (r + 1) * columns + right
    return np.stack([np.stack([a, b, e], -1), np.stack([a, e, d], -1)], axis=2).reshape(-1, 3)


def write_ply(path: Path, mesh: WorldMesh) -> None:
    """Write a binary PLY with a ``reflectivity`` per face."""
    header = "\n".join(
        [
            "ply",
            "format binary_little_endian 1.0",
            f"element vertex {len(mesh.vertices_m)}",
            "property float x",
            "property float y",
            "property float z",
            f"element face {len(mesh.triangles)}",
            "property list uchar int vertex_indices",
            "property float reflectivity",
            "end_header\n",
        ]
    )
    faces = np.zeros(
        len(mesh.triangles), dtype=[("count", "u1"), ("corners", "<i4", 3), ("reflectivity", "<f4")]
    )
    faces["count"], faces["corners"] = 3, mesh.triangles
    faces["reflectivity"] = mesh.reflectivity
    vertices = np.ascontiguousarray(mesh.vertices_m, dtype="<f4")
    path.write_bytes(header.encode("ascii") + vertices.tobytes() + faces.tobytes())
