"""Preview of the map: one point per voxel, in the order in which they were found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.live import EMPTY, add_voxels
from recon4.live.preview.tuning import PREVIEW_CLOUD


@dataclass(frozen=True, slots=True)
class Chunk:
    """A range of the preview points."""

    generation: int
    """Increases with the voxel size and at a reset; earlier points are void then."""
    start: int
    """Number of points of the generation before this chunk."""
    voxel_m: float
    voxels: NDArray[np.int16]
    """Integer voxel coordinates, (N, 3)."""
    values: NDArray[np.uint8]
    """Normalized intensity, (N,)."""


class PreviewCloud:
    """Keeps one point per voxel."""

    def __init__(
        self, voxel_m: float = PREVIEW_CLOUD.first_voxel_m, most: int = PREVIEW_CLOUD.max_points
    ) -> None:
        self.voxel_m, self._most = voxel_m, most
        self.generation = 0
        self._clear()

    def __len__(self) -> int:
        return self._count

    def add(self, p_map: Array, values: NDArray[np.uint8]) -> Chunk | None:
        """Add points; returns the new ones, or all if the voxel size was increased.

        Args:
            p_map: Points [m], (N, 3); those farther than 32767 voxels from the origin are left out.
            values: Normalized intensity, (N,).
        """
        start = self._count
        generation = self.generation
        voxels = np.floor(p_map / self.voxel_m).astype(np.int64)
        near = (np.abs(voxels) < PREVIEW_CLOUD.longest).all(axis=1)
        self._put(voxels[near], values[near])
        while self._count > self._most:
            self._coarsen()
        if self.generation != generation:
            return self.since(0)
        return self.since(start) if self._count > start else None

    def reset(self) -> None:
        """Remove all points and start a new generation."""
        self.generation += 1
        self._clear()

    def since(self, start: int) -> Chunk:
        """Points from an index on."""
        rows = slice(start, self._count)
        return Chunk(
            self.generation, start, self.voxel_m, self._voxels[rows].copy(),
            self._values[rows].copy(),
        )  # fmt: skip

    def _clear(self) -> None:
        self._table = np.full(1 << 16, EMPTY, dtype=np.int64)
        self._voxels = np.zeros((1 << 14, 3), dtype=np.int16)
        self._values = np.zeros(1 << 14, dtype=np.uint8)
        self._count = 0

    def _put(self, voxels: NDArray[np.int64], values: NDArray[np.uint8]) -> None:
        while 2 * (self._count + len(voxels)) > len(self._table):
            self._table = np.full(2 * len(self._table), EMPTY, dtype=np.int64)
            known = self._voxels[: self._count].astype(np.int64)
            add_voxels(self._table, known, np.zeros(self._count, dtype=np.bool_))
        fresh = np.zeros(len(voxels), dtype=np.bool_)
        added = add_voxels(self._table, voxels, fresh)
        end = self._count + added
        while end > len(self._values):
            self._voxels = np.concatenate([self._voxels, np.zeros_like(self._voxels)])
            self._values = np.concatenate([self._values, np.zeros_like(self._values)])
        self._voxels[self._count : end] = voxels[fresh]
        self._values[self._count : end] = values[fresh]
        self._count = end

    def _coarsen(self) -> None:
        voxels = self._voxels[: self._count].astype(np.int64) // 2
        values = self._values[: self._count].copy()
        self.voxel_m *= 2.0
        self.generation += 1
        self._clear()
        self._put(voxels, values)
