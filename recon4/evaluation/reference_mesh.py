"""The reference model: a triangle mesh, and the alignment of a map with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, RecordingError
from recon4.evaluation.tuning import MESH_ALIGNMENT
from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.geometry.raycast import Scene


@dataclass(frozen=True, slots=True, eq=False)
class TriangleMesh:
    """Triangles in a frame of their own (``model``)."""

    vertices_m: Array
    """Corners [m], (V, 3)."""
    triangles: NDArray[np.int64]
    """Rows of ``vertices_m``, (T, 3)."""

    @property
    def corners(self) -> Array:
        """Corners of every triangle [m], (T, 3, 3)."""
        return self.vertices_m[self.triangles]

    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest coordinates of the triangles [m], (3,) each."""
        used = self.vertices_m[distinct(self.triangles)]
        return used.min(axis=0), used.max(axis=0)


def read_mesh(path: Path) -> TriangleMesh:
    """Read a triangle mesh (PLY, OBJ, STL).

    Raises:
        RecordingError: If the file cannot be opened.
        CorruptFile: If it holds no triangles or is damaged.
    """
    from recon4.evaluation.mesh_files import read_triangles

    if not path.is_file():
        raise RecordingError(CodedText("model-none", file=path.name))
    vertices, triangles = read_triangles(path)
    if not len(triangles):
        raise CorruptFile(CodedText("model-empty", file=path.name))
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise CorruptFile(
            CodedText(
                "model-corners",
                file=path.name,
                most=len(vertices) - 1,
                low=str(triangles.min()),
                high=str(triangles.max()),
            )
        )
    if not np.isfinite(vertices).all():
        raise CorruptFile(CodedText("model-not-finite", file=path.name))
    return TriangleMesh(vertices, triangles)


def distance_to(mesh: TriangleMesh) -> Callable[[Array], Array]:
    """A function giving the distance of points (N, 3) to the nearest triangle [m], (N,)."""
    return scene_of(mesh).distance


def scene_of(mesh: TriangleMesh) -> Scene:
    """The mesh prepared for distances and nearest points."""
    from recon4.geometry.mesh import WorldMesh as RayMesh
    from recon4.geometry.raycast import Scene

    return Scene(
        RayMesh(
            mesh.vertices_m.astype(np.float32),
            mesh.triangles.astype(np.uint32),
            np.ones(len(mesh.triangles), dtype=np.float32),
            np.zeros(len(mesh.triangles), dtype=np.uint8),
        )
    )


class SurfacePoints(NamedTuple):
    """Points on a surface."""

    p: Array
    """Positions [m], (N, 3)."""
    normals: Array
    """Unit normals of either sign, (N, 3)."""


def sample_mesh(mesh: TriangleMesh, *, spacing_m: float, rng: np.random.Generator) -> SurfacePoints:
    """Points spread evenly at random over the triangles, with their normals.

    Args:
        mesh: The model.
        spacing_m: One point in a square of this size on average [m]; coarser for big models.
        rng: Source of randomness.
    """
    a, b, c = np.moveaxis(mesh.corners, 1, 0)
    cross = np.cross(b - a, c - a)
    double_area = np.linalg.norm(cross, axis=1)
    count = int(np.clip(double_area.sum() / 2.0 / spacing_m**2, 1000, MESH_ALIGNMENT.max_samples))
    which = rng.choice(len(a), size=count, p=double_area / double_area.sum())
    u, v = rng.random(count), rng.random(count)
    over = u + v > 1.0
    u[over], v[over] = 1.0 - u[over], 1.0 - v[over]
    u, v = u[:, None], v[:, None]
    points = a[which] + u * (b - a)[which] + v * (c - a)[which]
    return SurfacePoints(points, cross[which] / double_area[which, None])


def align_to_mesh(
    p_map: Array,
    mesh: TriangleMesh,
    *,
    T_model_map: SE3,
    rng: np.random.Generator,
) -> SE3:
    """Align map points with the model: point-to-plane ICP against points sampled from it.

    Args:
        p_map: A few ten thousand points of the map [m], (N, 3).
        mesh: The model.
        T_model_map: Where to start, within some decimeters and degrees.
        rng: Source of randomness.

    Returns:
        ``T_model_map``; the start itself where fewer than 100 points match.
    """
    surface = sample_mesh(mesh, spacing_m=0.05, rng=rng)
    return fit_planes(p_map, surface, T_model_map=T_model_map).T_model_map


@dataclass(frozen=True, slots=True, eq=False)
class PlaneFit:
    """Result of point-to-plane ICP."""

    T_model_map: SE3
    distance_m: Array
    """Distance of each matched point from the plane of its partner [m], (M,)."""
    converged: bool
    """Whether the last step was below the convergence limit."""


def fit_planes(
    p_map: Array,
    surface: SurfacePoints,
    *,
    T_model_map: SE3,
    rounds: int = 30,
    max_distance_m: float = 0.5,
) -> PlaneFit:
    """As `align_to_mesh`, onto points of the model.

    Args:
        p_map: Points of the map [m], (N, 3).
        surface: Points of the model.
        T_model_map: Where to start.
        rounds: Upper bound on rounds of matching.
        max_distance_m: Farther points are not matched [m]. Fewer than 100 points that match are
            not used: then nothing moves any more.
    """
    from scipy.spatial import cKDTree  # slow to import, and readers of meshes need none

    tree = cKDTree(surface.p)
    residual, length = np.empty(0), np.inf
    for _ in range(rounds):
        p = T_model_map @ p_map
        distance, nearest = tree.query(p, distance_upper_bound=max_distance_m)
        near = np.isfinite(distance)
        rows = nearest[near]
        p, partner, normal = p[near], surface.p[rows], surface.normals[rows]
        residual = np.abs(np.einsum("ni,ni->n", normal, p - partner))
        if len(p) < 100:
            length = np.inf
            break
        step = _point_to_plane_step(p, partner, normal)
        T_model_map = step @ T_model_map
        length = float(np.linalg.norm(step.log()))
        if length < 1e-7:
            break
    return PlaneFit(T_model_map, residual, length < MESH_ALIGNMENT.still)


def _point_to_plane_step(p: Array, q: Array, normals: Array) -> SE3:
    """One Gauss-Newton step on the distances ``n · (p - q)``, Cauchy weights (Chen 1992)."""
    center = p.mean(axis=0)
    residual = np.einsum("ni,ni->n", normals, p - q)
    J = np.concatenate([np.cross(p - center, normals), normals], axis=1)
    weight = 1.0 / (1.0 + (residual / MESH_ALIGNMENT.kernel_m) ** 2)
    H = (J * weight[:, None]).T @ J
    xi = -np.linalg.lstsq(H, J.T @ (weight * residual), rcond=1e-9)[0]
    to_center, back = SE3(np.eye(3), -center), SE3(np.eye(3), center)
    return back @ SE3.exp(xi) @ to_center
