"""Maps of buildings and terrains whose every measure is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.mapping.map_notes import MapNotes
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.tile import FIELDS, STORED
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet

STEP_M = 0.02
TILE_M = 10.0
NOISE_M = 0.002


class Surfaces:
    """Points on rectangles with their normals."""

    def __init__(self, seed: int = 5) -> None:
        self.rng = np.random.default_rng(seed)
        self.p: list[np.ndarray] = []
        self.n: list[np.ndarray] = []
        self.bright: list[np.ndarray] = []

    def sheet(self, corner, u, v, normal, *, bright=40.0, step=STEP_M, holes=()):
        """A rectangle from a corner along two edges; ``holes``: (a0, a1, b0, b1) on them [m]."""
        u, v, normal = (np.asarray(x, float) for x in (u, v, normal))
        a = np.arange(step / 2, np.linalg.norm(u), step)
        b = np.arange(step / 2, np.linalg.norm(v), step)
        a, b = (x.ravel() for x in np.meshgrid(a, b))
        for a0, a1, b0, b1 in holes:
            keep = ~((a > a0) & (a < a1) & (b > b0) & (b < b1))
            a, b = a[keep], b[keep]
        p = np.asarray(corner, float) + np.outer(a, u / np.linalg.norm(u))
        p = p + np.outer(b, v / np.linalg.norm(v))
        self.p.append(p + np.outer(self.rng.normal(0.0, NOISE_M, len(p)), normal))
        self.n.append(np.tile(normal, (len(p), 1)))
        self.bright.append(np.full(len(p), bright))

    def add(self, p, n, *, bright=40.0):
        """Any points."""
        self.p.append(p)
        self.n.append(np.broadcast_to(n, p.shape))
        self.bright.append(np.full(len(p), bright))

    def write(self, folder: Path, path: np.ndarray) -> TileSet:
        """The map; walls are measured from the nearest place of a path, floors from any."""
        from scipy.spatial import cKDTree

        folder.mkdir()
        p, n, bright = (np.concatenate(x) for x in (self.p, self.n, self.bright))
        t_ns = np.arange(len(path), dtype=np.int64) * 100_000_000
        toward = cKDTree(path).query(p + n)[1]
        floor = n[:, 2] > 0.5  # of which something is seen from everywhere, through doors, too
        toward[floor] = self.rng.integers(0, len(path), int(floor.sum()))
        with TileWriter(
            folder, STORED, tile_m=TILE_M, paths=SensorPaths(t_ns, t_ns, path[None])
        ) as writer:
            writer.notes = MapNotes(voxel_m=STEP_M)
            ijk = np.floor(p / TILE_M).astype(np.int64)
            for key in np.unique(ijk, axis=0):
                rows = self.rng.permutation(np.flatnonzero(np.all(ijk == key, axis=1)))
                columns = {
                    name: np.zeros((len(rows), width) if width > 1 else len(rows), dtype)
                    for name, (dtype, width) in FIELDS.items()
                }
                columns["xyz"] = (p[rows] - key * TILE_M).astype(np.float32)
                columns["normal"] = n[rows].astype(np.float16)
                columns["intensity_normalized"] = bright[rows].astype(np.float32)
                columns["t_ns"] = t_ns[toward[rows]]
                writer.append(tuple(int(k) for k in key), columns)
        return TileSet.open(folder)


DOOR = (1.0, 1.9)
"""In the wall between the rooms, along y [m]."""
WINDOW = (2.0, 3.4)
"""In the southern wall of the western room, along x [m]."""
FLOOR_M, CEILING_M = -1.5, 1.2


def two_rooms(folder: Path, *, floor_m: float = FLOOR_M, scraps_m: float | None = None) -> TileSet:
    """Rooms of 5 m x 4 m beside each other; between them a wall of 12 cm with a door.

    A column of 0.4 m stands in the eastern one, a cupboard of 1.8 m in the western one, whose
    southern wall has a window with a pane 10 cm behind the face. ``scraps_m``: where along y stray
    points fill the wall between the rooms.
    """
    made = Surfaces()
    height = CEILING_M - FLOOR_M
    for west, east in ((0.0, 5.0), (5.12, 10.12)):
        floor = [west, 0.0, floor_m]
        wide, deep, up = [east - west, 0, 0], [0, 4.0, 0], [0, 0, height]
        made.sheet(floor, wide, deep, [0, 0, 1], bright=20.0)
        made.sheet([west, 0, floor_m + height], wide, deep, [0, 0, -1])
        holes = [(*WINDOW, 0.9, 2.1)] if west == 0.0 else []
        made.sheet(floor, wide, up, [0, 1, 0], holes=holes)
        made.sheet([west, 4.0, floor_m], wide, up, [0, -1, 0])
        inner = [(*DOOR, -0.1, 2.1)]
        made.sheet(floor, deep, up, [1, 0, 0], holes=inner if west else [])
        made.sheet([east, 0, floor_m], deep, up, [-1, 0, 0], holes=[] if west else inner)
    made.sheet([WINDOW[0], -0.1, floor_m + 0.9], [1.4, 0, 0], [0, 0, 1.2], [0, 1, 0], bright=5.0)
    for edge, inward in ((DOOR[0], 1.0), (DOOR[1], -1.0)):
        made.sheet([5.0, edge, floor_m], [0.12, 0, 0], [0, 0, 2.1], [0, inward, 0])
    if scraps_m is not None:
        made.sheet([4.96, scraps_m, floor_m], [0.2, 0, 0], [0, 0, height], [0, 1, 0])
    _block(made, (7.0, 2.0), (7.4, 2.4), (floor_m, floor_m + height))
    _block(made, (1.0, 3.4), (2.0, 4.0), (floor_m, floor_m + 1.8))
    return made.write(folder, _walk(floor_m))


def round_room(folder: Path, radius_m: float, *, door_rad: float = 0.0) -> TileSet:
    """A room with one curved wall around the origin, with a door of 2.1 m at the direction of x."""
    made, height = Surfaces(), CEILING_M - FLOOR_M
    x, y = (one.ravel() for one in np.mgrid[-radius_m:radius_m:0.03, -radius_m:radius_m:0.03])
    x, y = x[inside := np.hypot(x, y) < radius_m], y[inside]
    for z, up in ((FLOOR_M, 1.0), (CEILING_M, -1.0)):
        made.add(np.column_stack([x, y, np.full(len(x), z)]), np.array([0.0, 0.0, up]), bright=20.0)
    around, z = np.arange(-np.pi, np.pi, STEP_M / radius_m), np.arange(0.01, height, STEP_M)
    around, z = (one.ravel() for one in np.meshgrid(around, z))
    wall = (np.abs(around) > door_rad / 2.0) | (z > 2.1)
    around, z = around[wall], z[wall]
    n = -np.column_stack([np.cos(around), np.sin(around), np.zeros(len(around))])
    r = radius_m + made.rng.normal(0.0, NOISE_M, len(around))
    made.add(-n * r[:, None] + np.column_stack([0 * z, 0 * z, z + FLOOR_M]), n)
    turn = np.linspace(0.0, 2.0 * np.pi, 300)
    path = 0.5 * radius_m * np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])
    path[:, 2] = FLOOR_M + 1.5
    return made.write(folder, path)


def _block(made: Surfaces, low, high, z_m) -> None:
    (x0, y0), (x1, y1), up = low, high, [0, 0, z_m[1] - z_m[0]]
    made.sheet([x0, y0, z_m[0]], [x1 - x0, 0, 0], up, [0, -1, 0], bright=80.0)
    made.sheet([x0, y1, z_m[0]], [x1 - x0, 0, 0], up, [0, 1, 0], bright=80.0)
    made.sheet([x0, y0, z_m[0]], [0, y1 - y0, 0], up, [-1, 0, 0], bright=80.0)
    made.sheet([x1, y0, z_m[0]], [0, y1 - y0, 0], up, [1, 0, 0], bright=80.0)


def _walk(floor_m: float) -> np.ndarray:
    x = np.concatenate([np.linspace(0.8, 9.4, 150), np.linspace(9.4, 0.8, 150)])
    y = np.where(np.abs(x - 5.06) < 1.2, 1.45, 1.2)
    return np.column_stack([x, y, np.full(300, floor_m + 1.5)])


SLOPE = 0.05
MOUND_M = 1.0


def slope(folder: Path) -> TileSet:
    """A meadow of 30 m x 20 m that rises to the east, a mound of 4 m x 4 m x 1 m, a car, a tree."""
    made, rng = Surfaces(), np.random.default_rng(4)
    xy = rng.uniform([0.0, 0.0], [30.0, 20.0], (120_000, 2))
    z = SLOPE * xy[:, 0] + rng.normal(0.0, 0.005, len(xy))
    car = (np.abs(xy[:, 0] - 22.0) < 2.2) & (np.abs(xy[:, 1] - 6.0) < 0.9)
    z += np.where(car, 1.5, 0.0)
    mound = (np.abs(xy[:, 0] - 8.0) < 2.0) & (np.abs(xy[:, 1] - 10.0) < 2.0)
    z += np.where(mound, MOUND_M, 0.0)
    unseen = np.hypot(xy[:, 0] - 25.0, xy[:, 1] - 16.0) < 2.0
    p = np.column_stack([xy, z])[~unseen]
    made.add(p, np.array([0.0, 0.0, 1.0]))
    leaves = rng.normal([15.0, 15.0, 5.0], [1.0, 1.0, 0.8], (5000, 3))
    made.add(leaves, np.array([0.0, 0.0, 1.0]))
    path = np.column_stack([np.linspace(1.0, 29.0, 300), np.full(300, 3.0), np.full(300, 1.5)])
    return made.write(folder, path)
