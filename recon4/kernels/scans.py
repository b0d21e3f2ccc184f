"""Kernels of the registration of two scans: normals, normal equations, ground plans."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from recon4.kernels.moments import smallest_eigenvector


@njit(cache=True, nogil=True, error_model="numpy")
def neighbor_normals(
    p: NDArray[np.float64], rows: NDArray[np.int64], normals: NDArray[np.float64]
) -> None:
    """Normal of the plane through the neighbors of each point; zeros if they lie on a line.

    Args:
        p: Points [m], (N, 3).
        rows: Rows of the neighbors of each, itself included, (N, K).
        normals: Receives unit normals, (N, 3).
    """
    count = rows.shape[1]
    for k in range(len(rows)):
        sx = sy = sz = xx = xy = xz = yy = yz = zz = 0.0
        for m in range(count):
            j = rows[k, m]
            x, y, z = p[j, 0] - p[k, 0], p[j, 1] - p[k, 1], p[j, 2] - p[k, 2]
            sx, sy, sz = sx + x, sy + y, sz + z
            xx, yy, zz = xx + x * x, yy + y * y, zz + z * z
            xy, xz, yz = xy + x * y, xz + x * z, yz + y * z
        n = 1.0 / count
        x, y, z, _, _, _ = smallest_eigenvector(
            xx * n - sx * sx * n * n,
            yy * n - sy * sy * n * n,
            zz * n - sz * sz * n * n,
            xy * n - sx * sy * n * n,
            xz * n - sx * sz * n * n,
            yz * n - sy * sz * n * n,
            1e-12,
        )
        normals[k, 0], normals[k, 1], normals[k, 2] = x, y, z


@njit(cache=True, nogil=True, error_model="numpy")
def accumulate_symmetric(
    q: NDArray[np.float64],
    n_q: NDArray[np.float64],
    nearest: NDArray[np.int64],
    p: NDArray[np.float64],
    n_p: NDArray[np.float64],
    center: NDArray[np.float64],
    kernel: float,
    inlier: float,
    H: NDArray[np.float64],
    g: NDArray[np.float64],
    normals: NDArray[np.float64],
) -> tuple[int, int, float, float, float]:
    """Normal equations of the symmetric distance ``(q - p) . (n_q + n_p) / |n_q + n_p|``.

    Rusinkiewicz 2019 (symmetric ICP), each match weighted by ``(n_q . n_p)²`` and a Cauchy kernel.

    Args:
        q: Points of the source, placed in the target [m], (N, 3).
        n_q: Their normals, also rotated, (N, 3).
        nearest: Row of the match of each in the target, M = none, (N,).
        p: Points of the target [m], (M, 3).
        n_p: Their normals, (M, 3).
        center: A correction rotates about this point [m], (3,).
        kernel: Scale of the Cauchy kernel [m].
        inlier: Distance below which a match with normals within 30° is an inlier [m].
        H: Receives the sum of w J^T J, rotation first, (6, 6).
        g: Receives the sum of w J^T r, (6,).
        normals: Receives the sum of w n n^T, (3, 3).

    Returns:
        Matches, inliers, sum of weights, sum of w |r| and of w r².
    """
    J = np.empty(6)
    matches = inliers = 0
    weights = total = squares = 0.0
    for k in range(len(q)):
        j = nearest[k]
        if j >= len(p):
            continue
        dot = n_q[k, 0] * n_p[j, 0] + n_q[k, 1] * n_p[j, 1] + n_q[k, 2] * n_p[j, 2]
        if dot == 0.0:
            continue
        sign = 1.0 if dot > 0.0 else -1.0
        nx = n_p[j, 0] + sign * n_q[k, 0]
        ny = n_p[j, 1] + sign * n_q[k, 1]
        nz = n_p[j, 2] + sign * n_q[k, 2]
        scale = 1.0 / np.sqrt(nx * nx + ny * ny + nz * nz)
        nx, ny, nz = nx * scale, ny * scale, nz * scale
        r = nx * (q[k, 0] - p[j, 0]) + ny * (q[k, 1] - p[j, 1]) + nz * (q[k, 2] - p[j, 2])
        w = dot * dot / (1.0 + (r / kernel) ** 2)
        x, y, z = q[k, 0] - center[0], q[k, 1] - center[1], q[k, 2] - center[2]
        J[0], J[1], J[2] = y * nz - z * ny, z * nx - x * nz, x * ny - y * nx
        J[3], J[4], J[5] = nx, ny, nz
        for a in range(6):
            g[a] += w * J[a] * r
            for b in range(6):
                H[a, b] += w * J[a] * J[b]
        for a in range(3):
            for b in range(3):
                normals[a, b] += w * J[3 + a] * J[3 + b]
        matches += 1
        if abs(r) < inlier and dot * dot > 0.75:
            inliers += 1
        weights += w
        total += w * abs(r)
        squares += w * r * r
    return matches, inliers, weights, total, squares


@njit(cache=True, nogil=True, error_model="numpy")
def count_from_above(
    xy: NDArray[np.float64],
    yaw: NDArray[np.float64],
    cell: float,
    most: float,
    out: NDArray[np.float32],
) -> None:
    """Count points in the cells of a ground plan, rotated by each of several angles.

    Args:
        xy: Points [m], (N, 2).
        yaw: Angles [rad], (Y,).
        cell: Edge of a cell [m].
        most: Limit of a count.
        out: Receives the counts, the origin in the middle, (Y, S, S).
    """
    size = out.shape[1]
    for m in range(len(yaw)):
        c, s = np.cos(yaw[m]), np.sin(yaw[m])
        for k in range(len(xy)):
            i = int(np.floor((c * xy[k, 0] - s * xy[k, 1]) / cell)) + size // 2
            j = int(np.floor((s * xy[k, 0] + c * xy[k, 1]) / cell)) + size // 2
            if 0 <= i < size and 0 <= j < size:
                out[m, i, j] = min(out[m, i, j] + 1.0, most)
