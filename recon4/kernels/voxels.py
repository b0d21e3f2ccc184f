"""Kernels of the map: distribute points to tiles, keep one point per voxel.

`recon4.mapping.records.RECORD` defines the record of 32 bytes per point; a kernel receives this
memory as arrays of several types, one row per record.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

PER_METER = 250.0
"""Vectors to the sensor are stored as int16 in steps of 4 mm, so 131 m at most."""
HALO = np.uint8(0x80)
"""Bit beside the echo: the record belongs to a neighboring tile, here for the surfaces only."""
MAX_RETURNS = 255
"""Largest count of returns of a voxel."""


class MarkBits(NamedTuple):
    """Bits beside that of the halo."""

    echo: int = 0x0F
    mark: int = 0x70
    """Of the mark of a record that the map leaves out; 0 = it is in the map."""
    shift: int = 4
    """Of the mark."""


BITS = MarkBits()


@njit(cache=True, nogil=True, error_model="numpy")
def choose(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    sensor: NDArray[np.uint8],
    enabled: NDArray[np.bool_],
    max_range_m: float,
    out: NDArray[np.bool_],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> int:
    """Choose the points of the map: enabled sensor, within the largest range.

    Args:
        xyz: Points [m], float64 (N, 3).
        origin: Positions of the sensor [m], float64 (N, 3).
        sensor: uint8 (N,).
        enabled: bool (S,).
        max_range_m: Farther points are excluded, and those that are not finite [m].
        out: Receives the choice, bool (N,).
        low: Receives the smallest coordinates of the chosen, float64 (3,).
        high: Receives their largest coordinates, float64 (3,).

    Returns:
        Number of chosen points.
    """
    count = 0
    low[:] = np.inf
    high[:] = -np.inf
    for n in range(len(xyz)):
        squared = 0.0
        for d in range(3):
            squared += (origin[n, d] - xyz[n, d]) ** 2
        out[n] = enabled[sensor[n]] and squared <= max_range_m * max_range_m
        if out[n]:
            count += 1
            for d in range(3):
                low[d] = min(low[d], xyz[n, d])
                high[d] = max(high[d], xyz[n, d])
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def tile_spread(x: float, tile_m: float, halo_m: float) -> tuple[np.int64, np.int64, np.int64]:
    """Tile of a coordinate, and the first and last tile whose halo it is in."""
    tile = np.int64(np.floor(x / tile_m))
    inside = x - tile * tile_m
    first = tile - 1 if inside < halo_m else tile
    last = tile + 1 if inside >= tile_m - halo_m else tile
    return tile, first, last


@njit(cache=True, nogil=True, error_model="numpy")
def count_tiles(
    xyz: NDArray[np.float64],
    chosen: NDArray[np.bool_],
    tile_m: float,
    halo_m: float,
    low: NDArray[np.int64],
    counts: NDArray[np.int64],
) -> None:
    """Add to ``counts (I, J, K)`` the number of records of each tile of a box."""
    for n in range(len(xyz)):
        if not chosen[n]:
            continue
        _, i0, i1 = tile_spread(xyz[n, 0], tile_m, halo_m)
        _, j0, j1 = tile_spread(xyz[n, 1], tile_m, halo_m)
        _, k0, k1 = tile_spread(xyz[n, 2], tile_m, halo_m)
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                for k in range(k0, k1 + 1):
                    counts[i - low[0], j - low[1], k - low[2]] += 1


@njit(cache=True, nogil=True, error_model="numpy")
def fill_tiles(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    chosen: NDArray[np.bool_],
    bytes_in: tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.uint8]],
    intensity: NDArray[np.uint16],
    dt_ns: NDArray[np.int32],
    frame: int,
    tile_m: float,
    halo_m: float,
    low: NDArray[np.int64],
    ends: NDArray[np.int64],
    f4: NDArray[np.float32],
    i4: NDArray[np.int32],
    i2: NDArray[np.int16],
    u1: NDArray[np.uint8],
) -> None:
    """Write the records, tile by tile.

    Args:
        xyz: Points in the map [m], float64 (N, 3).
        origin: Positions of the sensor [m], float64 (N, 3).
        chosen: Of `choose`, (N,).
        bytes_in: Ring, sensor, and echo with mark, three arrays uint8 (N,).
        intensity: uint16 (N,).
        dt_ns: int32 (N,).
        frame: Row of the multiframe.
        tile_m: Edge of a tile [m].
        halo_m: Points this near to a tile are also written to it, marked as halo [m].
        low: First tile of the box, (3,).
        ends: Row of the next record of each tile, int64 (I, J, K); incremented.
        f4: The records as float32, (M, 8).
        i4: The records as int32, (M, 8).
        i2: The records as int16, (M, 16).
        u1: The records as uint8, (M, 32).
    """
    for n in range(len(xyz)):
        if not chosen[n]:
            continue
        ti, i0, i1 = tile_spread(xyz[n, 0], tile_m, halo_m)
        tj, j0, j1 = tile_spread(xyz[n, 1], tile_m, halo_m)
        tk, k0, k1 = tile_spread(xyz[n, 2], tile_m, halo_m)
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                for k in range(k0, k1 + 1):
                    row = ends[i - low[0], j - low[1], k - low[2]]
                    ends[i - low[0], j - low[1], k - low[2]] = row + 1
                    f4[row, 0] = xyz[n, 0] - i * tile_m
                    f4[row, 1] = xyz[n, 1] - j * tile_m
                    f4[row, 2] = xyz[n, 2] - k * tile_m
                    i4[row, 3] = frame
                    i4[row, 4] = dt_ns[n]
                    for d in range(3):
                        i2[row, 10 + d] = np.rint(PER_METER * (origin[n, d] - xyz[n, d]))
                    i2[row, 13] = intensity[n]
                    for b in range(3):
                        u1[row, 28 + b] = bytes_in[b][n]
                    if not (i == ti and j == tj and k == tk):
                        u1[row, 30] |= HALO
                    u1[row, 31] = 1


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def voxel_at(
    f4: NDArray[np.float32], n: int, voxel_m: float, cell_voxels: int, side_cells: int, halo: int
) -> np.int64:
    """Number of the voxel of a record: cells in order, voxels in order within a cell."""
    cell: Any = np.int64(0)
    inside: Any = np.int64(0)
    for d in range(2, -1, -1):
        v: Any = np.int64(np.floor(f4[n, d] / voxel_m)) + halo * cell_voxels
        v = min(max(v, 0), side_cells * cell_voxels - 1)
        c = v // cell_voxels
        cell = cell * side_cells + c
        inside = inside * cell_voxels + (v - c * cell_voxels)
    return np.int64(cell * cell_voxels**3 + inside)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def voxel_rank(i2: NDArray[np.int16], u1: NDArray[np.uint8], n: int) -> np.int64:
    """What decides which record of a voxel is kept, the smallest: its squared range [steps²].

    One that the map leaves out comes after all others: feet do not replace the floor.
    """
    x, y, z = np.int64(i2[n, 10]), np.int64(i2[n, 11]), np.int64(i2[n, 12])
    marked = np.int64((u1[n, 30] & BITS.mark) != 0)
    return np.int64(x * x + y * y + z * z + (marked << 40))


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def joined_returns(rank, returns, other_rank, other):  # type: ignore[no-untyped-def]
    """Returns of a voxel of two groups, at most `MAX_RETURNS`.

    Those that the map leaves out count only where there are no others.
    """
    if rank >> 40 == other_rank >> 40:
        return min(returns + other, MAX_RETURNS)
    return returns if rank < other_rank else other


@njit(cache=True, nogil=True, error_model="numpy")
def voxel_keys(
    f4: NDArray[np.float32],
    i2: NDArray[np.int16],
    u1: NDArray[np.uint8],
    cells: tuple[float, int, int, int],
    shift: int,
    out: NDArray[np.int64],
    ranks: NDArray[np.int64],
) -> None:
    """Cell and voxel of each record, with its row in the lower ``shift`` bits, int64 (N,).

    Args:
        f4: The records as float32, (N, 8).
        i2: The records as int16, (N, 16).
        u1: The records as uint8, (N, 32).
        cells: Edge of a voxel [m], voxels along a cell, cells along tile and halo, of the halo.
        shift: Bits of the row.
        out: Receives the keys.
        ranks: Receives `voxel_rank`, with the returns in the lowest eight bits, int64 (N,).
    """
    voxel_m, cell_voxels, side_cells, halo_cells = cells
    # What each coordinate adds to the number of a voxel, as `voxel_at` counts: no divisions.
    along = np.empty((3, side_cells * cell_voxels), np.int64)
    for v in range(along.shape[1]):
        cell, inside = v // cell_voxels, v % cell_voxels
        for d in range(3):
            along[d, v] = cell * side_cells**d * cell_voxels**3 + inside * cell_voxels**d
    for n in range(len(f4)):
        voxel: Any = np.int64(0)
        for d in range(3):
            at: Any = np.int64(np.floor(f4[n, d] / voxel_m)) + halo_cells * cell_voxels
            voxel += along[d, min(max(at, 0), along.shape[1] - 1)]
        out[n] = (voxel << shift) | n
        ranks[n] = (voxel_rank(i2, u1, n) << 8) | u1[n, 31]


@njit(cache=True, nogil=True, error_model="numpy")
def nearest_in_voxels(
    order: NDArray[np.int64],
    shift: int,
    ranks: NDArray[np.int64],
    rows: NDArray[np.int64],
    returns: NDArray[np.uint8],
) -> int:
    """Row of the record with the least `voxel_rank` in each voxel; of equal ones the first.

    Args:
        order: Sorted result of `voxel_keys`, (N,).
        shift: As given to it.
        ranks: Of `voxel_keys`: the records themselves lie scattered over much more memory, (N,).
        rows: Receives the rows, voxel by voxel, int64 (N,); may be ``order`` itself.
        returns: Receives the returns of the voxel, at most `MAX_RETURNS`, uint8 (N,). The limited
            sum is the same however the records are grouped.

    Returns:
        Number of voxels.
    """
    mask = (np.int64(1) << shift) - 1
    count = -1
    best = np.int64(0)
    voxel = np.int64(-1)
    for n in range(len(order)):
        row = order[n] & mask
        rank, own = ranks[row] >> 8, ranks[row] & 0xFF
        if order[n] >> shift != voxel:
            voxel = order[n] >> shift
            count += 1
            best = rank
            rows[count] = row
            returns[count] = own
            continue
        returns[count] = joined_returns(best, np.int64(returns[count]), rank, own)
        if rank < best:
            best = rank
            rows[count] = row
    return count + 1


@njit(cache=True, nogil=True, error_model="numpy")
def seen_from_far(
    xyz: NDArray[np.float32],
    range_m: NDArray[np.float32],
    cell_m: float,
    ratio: float,
    keep: NDArray[np.bool_],
) -> None:
    """Clear ``keep`` where the range is over ``ratio`` times the shortest in a coarse cell.

    Args:
        xyz: Points from the tile's origin [m], 0 or more, float32 (N, 3).
        range_m: float32 (N,).
        cell_m: Edge of a coarse cell [m].
        ratio: Larger than 1.
        keep: bool (N,); points with False are ignored.
    """
    size: Any = 1
    for n in range(len(xyz)):
        for d in range(3):
            size = max(size, np.int64(xyz[n, d] / cell_m) + 1)
    nearest = np.full((size, size, size), np.inf, np.float32)
    for n in range(len(xyz)):
        if keep[n]:
            i, j, k = (
                np.int64(xyz[n, 0] / cell_m),
                np.int64(xyz[n, 1] / cell_m),
                np.int64(xyz[n, 2] / cell_m),
            )
            nearest[i, j, k] = min(nearest[i, j, k], range_m[n])
    for n in range(len(xyz)):
        if keep[n]:
            i, j, k = (
                np.int64(xyz[n, 0] / cell_m),
                np.int64(xyz[n, 1] / cell_m),
                np.int64(xyz[n, 2] / cell_m),
            )
            keep[n] = range_m[n] <= ratio * nearest[i, j, k]


@njit(cache=True, nogil=True, error_model="numpy")
def face_sensor(
    normals: NDArray[np.float32],
    to_sensor: NDArray[np.float32],
    range_m: NDArray[np.float32],
    incidence: NDArray[np.float32],
) -> None:
    """Flip normals towards the sensor, in place; compute range and incidence angle of each point.

    Args:
        normals: Unit normals or zeros, float32 (N, 3).
        to_sensor: From the point to the sensor [m], float32 (N, 3).
        range_m: Receives its length [m], float32 (N,).
        incidence: Receives the angle to the normal [rad], 0..pi/2; NaN without a normal, (N,).
    """
    for n in range(len(normals)):
        squared = np.float32(0.0)
        dot = np.float32(0.0)
        known = False
        for d in range(3):
            squared += to_sensor[n, d] * to_sensor[n, d]
            dot += normals[n, d] * to_sensor[n, d]
            known |= normals[n, d] != 0.0
        range_m[n] = np.sqrt(squared)
        incidence[n] = np.arccos(min(np.float32(1.0), abs(dot) / range_m[n])) if known else np.nan
        if dot < 0.0:
            for d in range(3):
                normals[n, d] = -normals[n, d]


@njit(cache=True, nogil=True, error_model="numpy")
def unpack(
    rows: NDArray[np.int64],
    f4: NDArray[np.float32],
    i4: NDArray[np.int32],
    i2: NDArray[np.int16],
    u1: NDArray[np.uint8],
    frame_ns: NDArray[np.int64],
    xyz: NDArray[np.float32],
    intensity: NDArray[np.uint16],
    small: tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.uint8]],
    frame: NDArray[np.uint32],
    t_ns: NDArray[np.int64],
    to_sensor: NDArray[np.float32],
) -> None:
    """Unpack records into columns.

    Args:
        rows: Rows of the records, in the order of the columns, (M,).
        f4: The records as float32, (N, 8).
        i4: The records as int32, (N, 8).
        i2: The records as int16, (N, 16).
        u1: The records as uint8, (N, 32).
        frame_ns: Start of each multiframe [ns], int64 (F,).
        xyz: float32 (M, 3).
        intensity: uint16 (M,).
        small: Ring, sensor, echo, three arrays uint8 (M,).
        frame: uint32 (M,).
        t_ns: int64 (M,).
        to_sensor: float32 (M, 3).
    """
    for m in range(len(rows)):
        n = rows[m]
        for d in range(3):
            xyz[m, d] = f4[n, d]
            to_sensor[m, d] = i2[n, 10 + d] * np.float32(1.0 / PER_METER)
            small[d][m] = u1[n, 28 + d]
        small[2][m] &= BITS.echo
        intensity[m] = i2[n, 13]
        frame[m] = i4[n, 3]
        t_ns[m] = frame_ns[i4[n, 3]] + i4[n, 4]
