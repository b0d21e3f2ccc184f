"""Merge runs of records on disk, each thinned and in the order of its voxels."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from recon4.kernels.voxel_runs import FULL, MERGED, merge_runs
from recon4.mapping.grid import Grid
from recon4.mapping.records import RECORD, Records, Views
from recon4.mapping.tuning import VOXEL_RUNS


def merged_runs(path: Path, counts: Sequence[int], grid: Grid) -> Records:
    """All records of a file, thinned, in the order of their voxels.

    Memory depends on the result, not on the file.

    Args:
        path: The runs, one after the other.
        counts: Records of each.
        grid: The grid, which thins.
    """
    runs = len(counts)
    room = min(VOXEL_RUNS.buffer, max(VOXEL_RUNS.least, VOXEL_RUNS.together // max(1, runs)))
    left = np.array(counts, np.int64)
    at = np.cumsum(left) - left
    head = room * np.arange(runs)
    stop, keys, state = head.copy(), np.full(runs, -1), np.array([0, -1])
    buffer = np.empty(runs * room, RECORD)
    memory = buffer.view(np.uint8).data
    views, out = Views.of(buffer), np.empty(max(VOXEL_RUNS.buffer, int(left.max())), RECORD)
    cells = grid.voxel_m, grid.cell_voxels, grid.side_cells, grid.halo_cells
    with path.open("rb") as file:
        while True:
            into = Views.of(out)
            run = merge_runs(
                views.f4, views.i4, views.i2, views.u1, cells,
                head, stop, left, keys, into.i4, into.i2, into.u1, state,
            )  # fmt: skip
            if run == MERGED:
                break
            del into
            if run == FULL:
                # Large arrays grow without being copied.
                out.resize(len(out) + len(out) // 4, refcheck=False)
                continue
            count = min(room, int(left[run]))
            file.seek(int(at[run]) * RECORD.itemsize)
            head[run] = run * room
            stop[run] = head[run] + count
            file.readinto(memory[head[run] * RECORD.itemsize : stop[run] * RECORD.itemsize])
            at[run] += count
            left[run] -= count
    del into
    out.resize(int(state[0]), refcheck=False)
    return out
