"""A project whose map has survey targets: plates and boards on a wall, a sphere before it."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.store.project import read_artifacts
from tests.project_builder import build_project
from tests.unit.slices.room_map import write_map

SITE = SE3.from_rpy(0.0, 0.0, 2.1, t=[51_000.0, 8_000.0, 200.0])
RADIUS_M = 0.1
TRUE = {
    "P1": np.array([0.0, 1.0, 1.2]),
    "P2": np.array([0.0, 4.6, 1.6]),
    "B1": np.array([0.0, 3.2, 1.3]),
    "S1": np.array([0.8, 2.1, 1.1]),
}
"""Two plates, a board and a sphere in the map [m]."""


def build_targets(root: Path) -> None:
    """The finished project ``office`` with such a map."""
    build_project(root / "office", points=2_000)
    folder = read_artifacts(root / "office")["map"]
    shutil.rmtree(folder / "tiles")
    (folder / "tiles.json").unlink()
    rng = np.random.default_rng(5)
    y, z = np.meshgrid(np.arange(0.5, 4.95, 0.012), np.arange(0.5, 2.0, 0.012))
    p = np.column_stack([np.zeros(y.size), y.ravel(), z.ravel()])
    p += rng.normal(0.0, 0.003, p.shape)
    value = np.full(len(p), 50.0)
    for name in ("P1", "P2"):
        value[np.abs(p - TRUE[name])[:, 1:].max(axis=1) <= 0.075] = 200.0
    d = (p - TRUE["B1"])[:, 1:]
    board = np.abs(d).max(axis=1) <= 0.15
    value[board] = np.where(d[board, 0] * d[board, 1] > 0.0, 85.0, 8.0)
    n = rng.normal(size=(1200, 3))
    n /= np.linalg.norm(n, axis=1)[:, None]
    n[:, 0] = np.abs(n[:, 0])
    sphere = TRUE["S1"] + RADIUS_M * n + rng.normal(0.0, 0.004, n.shape)
    value = np.r_[value, np.full(len(n), 60.0)] * rng.normal(1.0, 0.06, len(p) + len(n))
    normal = np.vstack([np.tile([1.0, 0.0, 0.0], (len(p), 1)), n])
    write_map(
        folder,
        np.vstack([p, sphere]),
        intensity_normalized=value.astype(np.float32),
        intensity=np.clip(value, 0, 255).astype(np.uint16),
        normal=normal,
    )
