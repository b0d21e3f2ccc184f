"""A map of 20 million points, written by the real writer.

``python -m tests.benchmarks.large_map OUT``: two storeys of rooms of 5 m, scanned evenly with
15 mm of noise; OUT is a finished project.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from recon4.mapping.map_notes import MapNotes
from recon4.mapping.tile import FIELDS, STORED
from recon4.mapping.tile_order import progressive
from recon4.mapping.tile_writer import TileWriter
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.project import Project
from recon4.store.stage import Input, Stage, StageContext, StageRunner
from tests.project_builder import BEGAN_NS, _level, _odometry, _verification, loop_walk

ROOM_M = 5.0
STOREY_M = 3.0
ROOMS = (8, 6, 2)
NOISE_M = 0.015
TILE_M = 5.0


def build_large_project(root: Path, *, points: int = 20_000_000) -> None:
    """Make a finished project in an empty folder; needs some 20 bytes a point on disk."""
    build_with_map(root, _map, points=Input(f"large {points}", points))


def build_with_map(root: Path, map_: Callable[..., None], **inputs: Input) -> None:
    """Make a finished project with a map that the function of its stage writes."""
    with Project.open(root) as project:
        project.describe(preset="indoor", rig="4RECON")
        runner = StageRunner(project, Settings(), Silent())
        walk = Input("walk", loop_walk())
        for name, function in (
            ("odometry", _odometry),
            ("verification", _verification),
            ("level", _level),
        ):
            runner.run(Stage(name, 1, ReadsNothing, function), walk=walk)
        runner.run(Stage("map", 1, ReadsNothing, map_), **inputs)


def write_large_map(out: Path, *, points: int) -> None:
    """The artifact of the stage ``map`` alone."""
    rng = np.random.default_rng(20)
    cells = [(i, j, k) for k in range(ROOMS[2]) for j in range(ROOMS[1]) for i in range(ROOMS[0])]
    share = np.diff(np.linspace(0, points, len(cells) + 1).astype(int))
    with TileWriter(out, STORED, tile_m=TILE_M) as writer:
        writer.notes = MapNotes(voxel_m=0.01, sensors=("V1", "V2"))
        rooms: dict[tuple[int, int, int], list[np.ndarray]] = {}
        for (i, j, k), count in zip(cells, share, strict=True):
            xyz, normal = _room(rng, int(count))
            xyz += np.array([i * ROOM_M, j * ROOM_M, k * STOREY_M])
            ijk = np.floor(xyz / TILE_M).astype(np.int64)
            for key in np.unique(ijk, axis=0):
                mine = np.all(ijk == key, axis=1)
                rooms.setdefault(tuple(key.tolist()), []).append(
                    np.hstack([xyz[mine] - key * TILE_M, normal[mine]])
                )
        for tile in sorted(rooms):
            rows = np.concatenate(rooms.pop(tile))
            order = np.lexsort(np.floor(rows[:, :3] / 0.5).T)
            writer.append(tile, _columns(rows[order][progressive(np.arange(len(rows)))], rng))


def _map(context: StageContext, *, points: int) -> None:
    write_large_map(context.out, points=points)


def _room(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Points on the six sides of a room and their normals into it."""
    size = np.array([ROOM_M - 0.2, ROOM_M - 0.2, STOREY_M - 0.3])
    area = np.array([size[1] * size[2], size[0] * size[2], size[0] * size[1]])
    face = rng.choice(6, size=count, p=np.repeat(area, 2) / area.sum() / 2)
    axis, high = face // 2, face % 2
    rows = np.arange(count)
    p = rng.uniform(size=(count, 3)) * size
    p[rows, axis] = high * size[axis] + NOISE_M * rng.standard_normal(count)
    normal = np.zeros((count, 3))
    normal[rows, axis] = 1.0 - 2.0 * high
    return p + 0.1, normal


def _columns(rows: np.ndarray, rng: np.random.Generator) -> dict[str, np.ndarray]:
    n, xyz = len(rows), rows[:, :3]
    bright = 0.5 + 0.4 * np.sin(2.0 * xyz[:, 0]) * np.sin(2.0 * xyz[:, 1])
    frame = rng.integers(0, 600, n)
    known = {
        "xyz": xyz,
        "intensity": 10.0 + 80.0 * bright * rng.uniform(0.3, 1.0, n),
        "intensity_normalized": 40.0 * bright,
        "ring": rng.integers(0, 16, n),
        "sensor": rng.integers(0, 2, n),
        "frame_id": frame,
        "t_ns": BEGAN_NS + frame.astype(np.int64) * 100_000_000,
        "normal": rows[:, 3:],
        "range_m": np.linalg.norm(xyz - TILE_M / 2.0, axis=1),
    }
    empty = {
        name: np.zeros((n, width) if width > 1 else n, dtype)
        for name, (dtype, width) in FIELDS.items()
    }
    return empty | {name: values.astype(FIELDS[name][0]) for name, values in known.items()}


if __name__ == "__main__":
    build_large_project(Path(sys.argv[1]))
