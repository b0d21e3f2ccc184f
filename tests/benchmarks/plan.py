"""Plans of simulated walks against the true walls of their worlds.

    python -m tests.benchmarks.plan WALK RECORDING [WALK RECORDING ...]

WALK is a project of ``recon4 process``, RECORDING the folder of ``recon4 simulate`` with its truth.
The map is laid on the true model as by `tests.benchmarks.delivered`: by the fit of its trajectory,
whose error is that of ATE, then by ICP. Along a corridor the trajectory alone leaves a turn open.
Seen is a stretch of a wall (of a building, but no door leaf, frame, pane or mirror) at the height
of the cut which three places of the path see, nearer than 20 m. Right is a stretch of it with a
drawn wall within 1 cm. Invented is a stretch of a drawn wall with nothing of a building, seen or
not, within 5 cm: walls of every material, columns, panes and mirrors.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.api.maps import open_map
from recon4.evaluation.reference_mesh import read_mesh
from recon4.evaluation.table import text_table
from recon4.geometry.mesh import SurfaceKind, WorldMesh
from recon4.geometry.raycast import Scene
from recon4.geometry.se3 import SE3, Array
from recon4.geometry.tuning import SURFACES
from recon4.products.floor_plan import FloorPlan, draw_plan
from recon4.products.storeys import find_storeys, level_surfaces
from recon4.recording.formats.poses import read_tum
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import World
from recon4.simulation.worlds import build_world
from tests.benchmarks.delivered import onto_truth

STEP_M = 0.02
CUT_M = 1.2
NO_WALLS = (MATERIAL.wood, MATERIAL.paper)
"""Leaves of doors, and frames."""
PANES = max(SURFACES.glass, SURFACES.clear, SURFACES.mirror)
HEAD = ("world", "storey", "seen m", "right %", "drawn m", "1 cm %", "invented %", "median mm",
        "95 % mm", "rms mm", "doors, windows")  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class TrueWalls:
    """Samples of the true walls at a height."""

    p: Array
    """(N, 2)."""
    n: Array
    """Normals of either sign, (N, 2)."""
    length_m: Array
    """Of wall that each sample stands for, (N,)."""


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folders", nargs="+", type=Path)
    folders = parser.parse_args().folders
    rows = [row for k in range(0, len(folders), 2) for row in figures(folders[k], folders[k + 1])]
    print(text_table(HEAD, rows))


def figures(walk: Path, recording: Path) -> list[tuple[str, ...]]:
    """One row for each storey."""
    world = build_world(json.loads((recording / "world.json").read_text())["world"])
    tiles = open_map(walk).tiles
    mesh = read_mesh(recording / "model.ply")
    T_world_map, error = onto_truth(tiles, mesh, walk, recording)
    tilt_deg = np.degrees(np.arctan2(np.hypot(*T_world_map.R[2, :2]), T_world_map.R[2, 2]))
    position = f"ATE {1e3 * error.position_m.rmse:.1f} mm"
    print(f"{walk.name}: {position}, off level by {tilt_deg:.3f}°", flush=True)
    path = T_world_map @ read_tum(walk / "trajectory.tum").T_a_b.t
    levels = level_surfaces(tiles)
    return [
        row(world, draw_plan(tiles, storey, levels), T_world_map, path=path)
        for storey in find_storeys(tiles, levels)
    ]


def row(world: World, plan: FloorPlan, T_world_map: SE3, *, path: Array) -> tuple[str, ...]:
    """Figures of a plan."""
    floor_m = float((T_world_map @ np.array([[0.0, 0.0, plan.storey.floor_m]]))[0, 2])
    cut_m = floor_m + CUT_M
    true = true_walls(world.mesh, cut_m, of_walls(world.mesh))
    real = true_walls(world.mesh, cut_m, of_buildings(world.mesh))
    storey = path[np.abs(path[:, 2] - floor_m - CUT_M) < 1.2]
    seen = seen_from(Scene(world.mesh), true, storey, cut_m)
    paths = [in_world(line, plan.storey.floor_m, T_world_map) for line in plan.walls]
    lines = [path[k : k + 2] for path in paths for k in range(len(path) - 1)]
    drawn = samples(lines)
    near = distance(true.p[seen], lines)
    right = true.length_m[seen][near < 0.01].sum() / true.length_m[seen].sum()
    from scipy.spatial import cKDTree

    away = off_walls(drawn, real, cKDTree(real.p))
    holes = [sum(hole.kind == kind for hole in plan.openings) for kind in ("door", "window")]
    widths = [hole.width_m for hole in plan.openings if hole.kind == "door"]
    width = f" ({1e3 * np.median(np.abs(np.array(widths) - 0.95)):.0f} mm)" if widths else ""
    return (
        world.name, plan.storey.name, f"{true.length_m[seen].sum():.1f}", f"{100 * right:.1f}",
        f"{plan.wall_length_m:.1f}", f"{100 * np.mean(away < 0.01):.1f}",
        f"{100 * np.mean(away > 0.05):.1f}", f"{1e3 * np.median(away):.1f}",
        f"{1e3 * np.percentile(away, 95):.1f}", f"{1e3 * plan.rms_m:.1f}",
        f"{holes[0]}{width}, {holes[1]}",
    )  # fmt: skip


def of_buildings(mesh: WorldMesh) -> np.ndarray:
    """Which triangles a plan may show as a wall: of a building, a pane or a mirror, (T,)."""
    return (mesh.kind == SurfaceKind.BUILDING) | (mesh.reflectivity <= np.float32(PANES))


def of_walls(mesh: WorldMesh) -> np.ndarray:
    """Which triangles are of a wall or a column, of any color, (T,)."""
    found = (mesh.kind == SurfaceKind.BUILDING) & (mesh.reflectivity > np.float32(PANES))
    return found & ~np.isin(mesh.reflectivity, np.float32(NO_WALLS))


def true_walls(mesh: WorldMesh, z_m: float, wall: np.ndarray) -> TrueWalls:
    """Cut some triangles (T,) of a world at a height."""
    corners = mesh.vertices_m[mesh.triangles[wall]].astype(np.float64)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    over = corners[:, :, 2] > z_m
    rows = (np.abs(normal[:, 2]) < 0.1) & over.any(axis=1) & ~over.all(axis=1)
    p, n, length = [], [], []
    for triangle, across in zip(corners[rows], normal[rows], strict=True):
        ends = []
        for a, b in ((0, 1), (1, 2), (2, 0)):
            low, high = triangle[a], triangle[b]
            if (low[2] > z_m) != (high[2] > z_m):
                ends.append(low + (z_m - low[2]) / (high[2] - low[2]) * (high - low))
        size = float(np.linalg.norm(ends[1] - ends[0]))
        if size < 1e-6:
            continue
        count = max(1, round(size / STEP_M))
        part = (np.arange(count) + 0.5) / count
        p.append(ends[0][:2] + part[:, None] * (ends[1] - ends[0])[:2])
        n.append(np.tile(across[:2] / np.linalg.norm(across[:2]), (count, 1)))
        length.append(np.full(count, size / count))
    return TrueWalls(np.concatenate(p), np.concatenate(n), np.concatenate(length))


def seen_from(scene: Scene, true: TrueWalls, path: Array, z_m: float) -> np.ndarray:
    """Which samples three places of the path see."""
    steps = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    places = path[np.unique(np.floor(steps / 0.5), return_index=True)[1]]
    seen = np.zeros(len(true.p), np.int64)
    target = np.column_stack([true.p, np.full(len(true.p), z_m)])
    for place in places:
        way = target - place
        range_m = np.linalg.norm(way, axis=1)
        facing = np.abs(np.einsum("ij,ij->i", way[:, :2], true.n)) / range_m
        rays = np.column_stack([np.tile(place, (len(way), 1)), way / range_m[:, None]])
        hit = scene.cast(rays.astype(np.float32)).range_m
        seen += (np.abs(hit - range_m) < 0.01) & (range_m < 20.0) & (facing > 0.15)
    return seen >= 3


def in_world(line: Array, z_m: float, T_world_map: SE3) -> Array:
    """A line of a plan in the world, (N, 2)."""
    return (T_world_map @ np.column_stack([line, np.full(len(line), z_m)]))[:, :2]


def samples(lines: list[Array]) -> Array:
    """Points along lines, `STEP_M` apart, with their normals, (M, 4)."""
    out = []
    for a, b in lines:
        count = max(1, round(float(np.linalg.norm(b - a)) / STEP_M))
        part = (np.arange(count) + 0.5) / count
        u = (b - a) / np.linalg.norm(b - a)
        out.append(
            np.column_stack([a + part[:, None] * (b - a), np.tile([u[1], -u[0]], (count, 1))])
        )
    return np.concatenate(out)


def distance(p: Array, lines: list[Array]) -> Array:
    """Distance of points to the nearest line [m], (N,)."""
    best = np.full(len(p), np.inf)
    for a, b in lines:
        step = b - a
        along = np.clip((p - a) @ step / (step @ step), 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(p - a - along[:, None] * step, axis=1))
    return best


def off_walls(drawn: Array, true: TrueWalls, tree: object) -> Array:
    """Distance of points on drawn walls to the nearest true wall of their direction [m], (M,)."""
    _, rows = tree.query(drawn[:, :2], k=16)  # type: ignore[attr-defined]
    off = drawn[:, None, :2] - true.p[rows]
    across = np.abs(np.einsum("ijk,ijk->ij", off, true.n[rows]))
    along = np.abs(off[:, :, 0] * true.n[rows][:, :, 1] - off[:, :, 1] * true.n[rows][:, :, 0])
    alike = np.abs(np.einsum("ik,ijk->ij", drawn[:, 2:], true.n[rows])) > 0.9
    return np.where(alike, np.hypot(across, np.maximum(along - STEP_M, 0.0)), np.inf).min(axis=1)


if __name__ == "__main__":
    main()
