"""Ray casting on triangle meshes: the only module that uses Open3D."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.mesh import WorldMesh
from recon4.geometry.se3 import Array
from recon4.geometry.tuning import RAYCASTING


@dataclass(frozen=True, slots=True, eq=False)
class Hits:
    """First hit of each ray."""

    range_m: NDArray[np.float32]
    """Distance along the unit direction [m], inf = nothing, (N,)."""
    triangle: NDArray[np.uint32]
    """Row of the triangle; meaningless without a hit, (N,)."""
    normal: NDArray[np.float32]
    """Unit normal of that triangle, of either sign, (N, 3)."""


class Scene:
    """A mesh prepared for ray casting."""

    def __init__(self, mesh: WorldMesh) -> None:
        self._scene = _scene(mesh)

    def cast(self, rays: NDArray[np.float32]) -> Hits:
        """First hits of rays, origin and unit direction in the map (N, 6)."""
        import open3d as o3d

        answer = self._scene.cast_rays(o3d.core.Tensor.from_numpy(rays))
        return Hits(
            answer["t_hit"].numpy(),
            answer["primitive_ids"].numpy(),
            answer["primitive_normals"].numpy(),
        )

    def distance(self, points: Array) -> Array:
        """Distance of points to the nearest triangle [m], (N, 3) -> (N,)."""
        import open3d as o3d

        out = np.empty(len(points))
        for start in range(0, len(points), RAYCASTING.nearest_batch):
            part = np.ascontiguousarray(
                points[start : start + RAYCASTING.nearest_batch], dtype=np.float32
            )
            distances = self._scene.compute_distance(o3d.core.Tensor.from_numpy(part))
            out[start : start + RAYCASTING.nearest_batch] = distances.numpy()
        return out

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Nearest points of the surface [m] and unit normals of their triangles, (N, 3) each."""
        import open3d as o3d

        foot, normal = np.empty((len(points), 3)), np.empty((len(points), 3))
        for start in range(0, len(points), RAYCASTING.nearest_batch):
            rows = slice(start, start + RAYCASTING.nearest_batch)
            part = np.ascontiguousarray(points[rows], dtype=np.float32)
            answer = self._scene.compute_closest_points(o3d.core.Tensor.from_numpy(part))
            foot[rows] = answer["points"].numpy()
            normal[rows] = answer["primitive_normals"].numpy()
        return foot, normal

    def nearest_triangle(self, points: Array) -> NDArray[np.uint32]:
        """Row of the nearest triangle of each point, (N, 3) -> (N,)."""
        import open3d as o3d

        out = np.empty(len(points), np.uint32)
        for start in range(0, len(points), RAYCASTING.nearest_batch):
            rows = slice(start, start + RAYCASTING.nearest_batch)
            part = np.ascontiguousarray(points[rows], dtype=np.float32)
            answer = self._scene.compute_closest_points(o3d.core.Tensor.from_numpy(part))
            out[rows] = answer["primitive_ids"].numpy()
        return out


def _scene(mesh: WorldMesh) -> Any:
    import open3d as o3d

    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor.from_numpy(np.ascontiguousarray(mesh.vertices_m)),
        o3d.core.Tensor.from_numpy(np.ascontiguousarray(mesh.triangles)),
    )
    # The first ray prepares the scene, which threads that cast at once would disturb.
    scene.cast_rays(o3d.core.Tensor.from_numpy(np.ones((1, 6), np.float32)))
    return scene
