"""Kernels of the plane map: moments of points in cubes of several sizes, distances to planes.

The ten sums of a cube (count, first and second moments) can be added and subtracted with
sufficient accuracy, so a multiframe can be removed from a map, for good or for a while.
Cubes of a level are twice as large as those of the one before: two of them make one along an axis.
A cube knows from where it was seen: a thin wall seen from the next room is another surface.
The tables are plain arrays. ``keys`` (C,) and ``rows`` (C,) find the row of a cube by its key and
are at most half full. The rows follow each other in the order in which the cubes were seen:
``sums`` (R, 15), ``fits`` (R, 10) and ``state`` (R,) have none that is free among those in use.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.cell_table import place_of
from recon4.kernels.eigen import eigen_sym3
from recon4.kernels.lanes import add_outer, add_row, add_scaled
from recon4.kernels.plane_tables import CUBE, EMPTY, STATE, SUMS

MIN_POINTS, MAX_SD, MIN_EXTENT, MAX_RATIO, MIN_BATCHES = range(5)
"""Rows of the array of criteria that a cube's points have to meet to count as a plane."""
_MIN_SIDE_M = 0.2
"""Nearer to a plane than this, the side from which it is seen is not certain [m]."""
_OFFSET = np.int64(1 << 19)
_MASK = np.int64((1 << 20) - 1)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _cell(x: float, size: float) -> np.int64:
    """Number of the cube of a size along one axis."""
    return np.int64(np.floor(x / size))


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _key(level: int, ix: np.int64, iy: np.int64, iz: np.int64) -> np.int64:
    """Key of a cube of a level, by its numbers along the axes."""
    x, y, z = (ix + _OFFSET) & _MASK, (iy + _OFFSET) & _MASK, (iz + _OFFSET) & _MASK
    return (np.int64(level) << 60) | (x << 40) | (y << 20) | z


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _slot(keys: NDArray[np.int64], key: np.int64) -> np.uint64:
    """Slot of a key, or the free one where it belongs.

    Of an unsigned index Numba does not ask whether it counts from the end.
    """
    mask = np.uint64(len(keys) - 1)
    slot = np.uint64(place_of(key, np.int64(mask)))
    while keys[slot] != key and keys[slot] != EMPTY:
        slot = (slot + np.uint64(1)) & mask
    return slot


@njit(cache=True, nogil=True, error_model="numpy")
def add_points(
    keys: NDArray[np.int64],
    rows: NDArray[np.int32],
    sums: NDArray[np.float64],
    state: NDArray[np.uint8],
    sizes: NDArray[np.float64],
    p: NDArray[np.float64],
    first: int,
    used: int,
    sign: float,
    batch: int,
    view: NDArray[np.float64],
) -> tuple[int, int]:
    """Add (``sign`` 1) or remove (-1) points, (N, 3), beginning with row ``first``.

    Points of one ``batch`` were seen from the same place ``view`` (3,), NaN = unknown; a cube
    counts its batches. Points that follow each other in one of the smallest cubes are added at
    once; the others take their moments, moved to their own centers.

    Stops early if the tables are half full. Returns the row to continue with and the number of
    cubes used.
    """
    levels, flat = len(sizes), sums.reshape(-1)
    # Neighboring runs mostly lie in one cube of a coarser level: its row is searched once.
    last_key, last_row = np.full(levels, EMPTY), np.zeros(levels, np.int64)
    k, nx, ny, nz = first, EMPTY, EMPTY, EMPTY
    if k < len(p):
        nx, ny, nz = _cell(p[k, 0], sizes[0]), _cell(p[k, 1], sizes[0]), _cell(p[k, 2], sizes[0])
    while k < len(p):
        if 2 * (used + levels) > len(keys):
            return k, used
        ix, iy, iz = nx, ny, nz
        # Moments about a cube's center are small numbers: removal stays accurate.
        cx, cy, cz = (ix + 0.5) * sizes[0], (iy + 0.5) * sizes[0], (iz + 0.5) * sizes[0]
        n = mx = my = mz = xx = xy = xz = yy = yz = zz = 0.0
        while nx == ix and ny == iy and nz == iz:
            x, y, z = p[k, 0] - cx, p[k, 1] - cy, p[k, 2] - cz
            wx, wy, wz = sign * x, sign * y, sign * z
            n, mx, my, mz = n + sign, mx + wx, my + wy, mz + wz
            xx, xy, xz = xx + wx * x, xy + wx * y, xz + wx * z
            yy, yz, zz = yy + wy * y, yz + wy * z, zz + wz * z
            k += 1
            if k == len(p):
                break
            nx, ny, nz = (
                _cell(p[k, 0], sizes[0]), _cell(p[k, 1], sizes[0]), _cell(p[k, 2], sizes[0]),
            )  # fmt: skip
        for level in range(levels):
            jx, jy, jz = ix >> level, iy >> level, iz >> level
            key = _key(level, jx, jy, jz)
            row = last_row[level]
            if key != last_key[level]:
                slot = _slot(keys, key)
                if keys[slot] == EMPTY:
                    keys[slot], rows[slot] = key, used
                    used += 1
                row = np.int64(rows[slot])
                last_key[level], last_row[level] = key, row
                if sums[row, CUBE.newest] != batch:
                    sums[row, CUBE.newest] = batch
                    sums[row, CUBE.batches] += 1.0
                state[row] = STATE.dirty
            dx = cx - (jx + 0.5) * sizes[level]
            dy = cy - (jy + 0.5) * sizes[level]
            dz = cz - (jz + 0.5) * sizes[level]
            sx, sy, sz = mx + n * dx, my + n * dy, mz + n * dz
            at = row * CUBE.sums
            add_row(flat, at, (n, sx, sy, sz))
            add_row(
                flat, at + 4,
                (xx + dx * (mx + sx), xy + dx * my + dy * sx, xz + dx * mz + dz * sx,
                 yy + dy * (my + sy)),
            )  # fmt: skip
            add_row(flat, at + 8, (yz + dy * mz + dz * sy, zz + dz * (mz + sz)))
            add_row(flat, at + CUBE.seen_from, (n * view[0], n * view[1], n * view[2]))
    return len(p), used


@njit(cache=True, nogil=True, error_model="numpy")
def empty_beyond(
    keys: NDArray[np.int64],
    rows: NDArray[np.int32],
    sums: NDArray[np.float64],
    sizes: NDArray[np.float64],
    center: NDArray[np.float64],
    radius: float,
) -> None:
    """Empty the cubes whose center is farther from ``center`` than ``radius``."""
    for slot in range(len(keys)):
        key = keys[slot]
        if key == EMPTY:
            continue
        size = sizes[key >> 60]
        dx = (((key >> 40) & _MASK) - _OFFSET + 0.5) * size - center[0]
        dy = (((key >> 20) & _MASK) - _OFFSET + 0.5) * size - center[1]
        dz = ((key & _MASK) - _OFFSET + 0.5) * size - center[2]
        if dx * dx + dy * dy + dz * dz > radius * radius:
            sums[rows[slot]] = 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def rehash(
    keys: NDArray[np.int64], rows: NDArray[np.int32], moved: NDArray[np.int32], capacity: int
) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Slots of another number (a power of two), of the cubes that `compact` left."""
    new_keys = np.full(capacity, EMPTY, np.int64)
    new_rows = np.zeros(capacity, np.int32)
    for slot in range(len(keys)):
        if keys[slot] != EMPTY and moved[rows[slot]] != EMPTY:
            to = _slot(new_keys, keys[slot])
            new_keys[to], new_rows[to] = keys[slot], moved[rows[slot]]
    return new_keys, new_rows


@njit(cache=True, nogil=True, error_model="numpy")
def _fit(
    key: np.int64,
    s: NDArray[np.float64],
    size: float,
    criteria: NDArray[np.float64],
    f: NDArray[np.float64],
    work: NDArray[np.float64],
) -> np.uint8:
    """Fit the plane of one cube into ``f``: center, normal, variances across and along, count and
    mean distance of the views, negative behind the plane.
    """
    n = s[0]
    if n < criteria[MIN_POINTS] or s[CUBE.batches] < criteria[MIN_BATCHES]:
        return STATE.no_plane
    mx, my, mz = s[1] / n, s[2] / n, s[3] / n
    a, vecs, vals = work[0:3], work[3:6], work[6]
    a[0, 0] = s[4] / n - mx * mx
    a[0, 1] = s[5] / n - mx * my
    a[0, 2] = s[6] / n - mx * mz
    a[1, 1] = s[7] / n - my * my
    a[1, 2] = s[8] / n - my * mz
    a[2, 2] = s[9] / n - mz * mz
    a[1, 0], a[2, 0], a[2, 1] = a[0, 1], a[0, 2], a[1, 2]
    eigen_sym3(a, vals, vecs)
    across, along = max(vals[0], 0.0), max(vals[1], 1e-12)
    min_sd = max(0.1 * size, criteria[MIN_EXTENT])
    if across > criteria[MAX_SD] ** 2 or along < min_sd * min_sd:
        return STATE.no_plane
    if across > criteria[MAX_RATIO] * along:
        return STATE.no_plane
    ix = ((key >> 40) & _MASK) - _OFFSET
    iy = ((key >> 20) & _MASK) - _OFFSET
    iz = (key & _MASK) - _OFFSET
    f[0] = (ix + 0.5) * size + mx
    f[1] = (iy + 0.5) * size + my
    f[2] = (iz + 0.5) * size + mz
    f[3], f[4], f[5] = vecs[0, 0], vecs[1, 0], vecs[2, 0]
    f[6], f[7], f[8] = across, along, n
    f[9] = 0.0
    for axis in range(3):
        f[9] += f[3 + axis] * (s[CUBE.seen_from + axis] / n - f[axis])
    return STATE.plane


@njit(cache=True, nogil=True, error_model="numpy")
def fit_all(
    keys: NDArray[np.int64],
    rows: NDArray[np.int32],
    sums: NDArray[np.float64],
    fits: NDArray[np.float64],
    state: NDArray[np.uint8],
    sizes: NDArray[np.float64],
    criteria: NDArray[np.float64],
) -> None:
    """Fit the planes of all cubes, so that several threads can match without writing."""
    work = np.empty((7, 3))
    for slot in range(len(keys)):
        key, row = keys[slot], rows[slot]
        if key != EMPTY and state[row] == STATE.dirty:
            state[row] = _fit(key, sums[row], sizes[key >> 60], criteria, fits[row], work)


@njit(cache=True, nogil=True, error_model="numpy")
def _finest_planes(
    keys: NDArray[np.int64],
    rows: NDArray[np.int32],
    sums: NDArray[np.float64],
    fits: NDArray[np.float64],
    state: NDArray[np.uint8],
    sizes: NDArray[np.float64],
    criteria: NDArray[np.float64],
    q: NDArray[np.float64],
    finest: int,
) -> NDArray[np.int64]:
    """Row of the finest cube with a plane around each point (N, 3), `EMPTY` = none, (N,).

    Cubes that changed since they were fitted are fitted first. All points at once: a call for each
    would count references to six arrays, which takes as long as the search.
    """
    work = np.empty((7, 3))
    found = np.full(len(q), EMPTY, np.int64)
    # Neighboring points mostly lie in one cube: it is searched once.
    last = EMPTY
    for k in range(len(q)):
        ix, iy, iz = _cell(q[k, 0], sizes[0]), _cell(q[k, 1], sizes[0]), _cell(q[k, 2], sizes[0])
        inside = _key(finest, ix >> finest, iy >> finest, iz >> finest)
        if inside == last:
            found[k] = found[k - 1]
            continue
        last = inside
        for level in range(finest, len(sizes)):
            key = _key(level, ix >> level, iy >> level, iz >> level)
            slot = _slot(keys, key)
            if keys[slot] == EMPTY:
                continue
            row = np.uint32(rows[slot])
            if state[row] == STATE.dirty:
                state[row] = _fit(key, sums[row], sizes[level], criteria, fits[row], work)
            if state[row] == STATE.plane:
                found[k] = row
                break
    return found


@njit(cache=True, nogil=True, error_model="numpy")
def normals(
    keys: NDArray[np.int64],
    rows: NDArray[np.int32],
    sums: NDArray[np.float64],
    fits: NDArray[np.float64],
    state: NDArray[np.uint8],
    sizes: NDArray[np.float64],
    q: NDArray[np.float64],
    gate: float,
    criteria: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Normals of the finest planes at points (N, 3), and variances across, to ``out`` (N, 4)."""
    found = _finest_planes(keys, rows, sums, fits, state, sizes, criteria, q, 0)
    for k in range(len(q)):
        if found[k] == EMPTY:
            continue
        f = fits[found[k]]
        r = f[3] * (q[k, 0] - f[0]) + f[4] * (q[k, 1] - f[1]) + f[5] * (q[k, 2] - f[2])
        if abs(r) <= gate:
            out[k, 0], out[k, 1], out[k, 2], out[k, 3] = f[3], f[4], f[5], f[6]


@njit(cache=True, nogil=True, error_model="numpy")
def accumulate(
    keys: NDArray[np.int64],
    rows: NDArray[np.int32],
    sums: NDArray[np.float64],
    fits: NDArray[np.float64],
    state: NDArray[np.uint8],
    sizes: NDArray[np.float64],
    q: NDArray[np.float64],
    fraction: NDArray[np.float64],
    center: NDArray[np.float64],
    finest: int,
    gate: float,
    kernel: float,
    point_var: float,
    criteria: NDArray[np.float64],
    H: NDArray[np.float64],
    g: NDArray[np.float64],
    residual: NDArray[np.float64],
) -> tuple[int, float, float, NDArray[np.float64]]:
    """Normal equations of points to the planes of the finest cube that has one.

    A correction is a rotation about ``center`` and a shift, one at the start and one at the end of
    the frame. A point at ``fraction`` s of the frame moves by (1 - s) times the first and s times
    the second. Cauchy weights on the distance, scaled by the variances of point and plane. Points
    seen from ``center`` do not match a plane that was seen from its other side.

    Args:
        q: Points in the map frame [m], (N, 3).
        fraction: 0 at the start of the frame, 1 at its end, (N,).
        H: Receives the sum of w J^T J, (12, 12): rotation, shift at the start, then at the end.
        g: Receives the sum of w J^T r, (12,).
        residual: Receives the distance of each point [m], NaN without a plane, (N,).

    Returns:
        Number of matches, sum of absolute distances, sum of w r², and the sum of n n^T (3, 3).
    """
    found = _finest_planes(keys, rows, sums, fits, state, sizes, criteria, q, finest)
    a = np.zeros(SUMS.all)
    matches, total, chi2 = 0, 0.0, 0.0
    for k in range(len(q)):
        residual[k] = np.nan
        if found[k] == EMPTY:
            continue
        f = fits[found[k]]
        dx, dy, dz = q[k, 0] - f[0], q[k, 1] - f[1], q[k, 2] - f[2]
        r = f[3] * dx + f[4] * dy + f[5] * dz
        if abs(r) > gate:
            continue
        side = f[3] * (center[0] - f[0]) + f[4] * (center[1] - f[1]) + f[5] * (center[2] - f[2])
        if side * f[9] < 0.0 and min(abs(side), abs(f[9])) > _MIN_SIDE_M:
            continue
        inplane_sq = dx * dx + dy * dy + dz * dz - r * r
        var = point_var + f[6] / f[8] * (1.0 + inplane_sq / f[7])
        w = 1.0 / (var * (1.0 + (r / kernel) ** 2))
        bx, by, bz = q[k, 0] - center[0], q[k, 1] - center[1], q[k, 2] - center[2]
        J = (
            by * f[5] - bz * f[4], bz * f[3] - bx * f[5], bx * f[4] - by * f[3], f[3], f[4], f[5],
        )  # fmt: skip
        s = fraction[k]
        add_outer(a, SUMS.start, w * (1.0 - s) * (1.0 - s), J)
        add_scaled(a, SUMS.g_start, w * (1.0 - s), J, r)
        if s != 0.0:
            add_outer(a, SUMS.cross, w * s * (1.0 - s), J)
            add_outer(a, SUMS.end, w * s * s, J)
            add_scaled(a, SUMS.g_end, w * s, J, r)
        add_outer(a, SUMS.normals, 1.0, (f[3], f[4], f[5]))
        residual[k] = r
        matches += 1
        total += abs(r)
        chi2 += w * r * r
    normals = np.empty((3, 3))
    for i in range(6):
        g[i] += a[SUMS.g_start + i]
        g[6 + i] += a[SUMS.g_end + i]
        for j in range(6):
            at = 8 * min(i, j) + max(i, j)
            H[i, j] += a[SUMS.start + at]
            H[6 + i, j] += a[SUMS.cross + at]
            H[i, 6 + j] += a[SUMS.cross + at]
            H[6 + i, 6 + j] += a[SUMS.end + at]
    for i in range(3):
        for j in range(3):
            normals[i, j] = a[SUMS.normals + 4 * min(i, j) + max(i, j)]
    return matches, total, chi2, normals
