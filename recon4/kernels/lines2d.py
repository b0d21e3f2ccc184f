"""Kernels of 2-D registration: points summed in square cells, and distances to their lines.

The cells lie on a torus: cell (a, b) of the plane is entry (a mod S, b mod S). A map around a
moving laser never needs to be moved in memory, as long as it is narrower than S cells.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

SUMS = 6
"""Sums of a cell: count, x, y, xx, xy, yy."""


@njit(cache=True, nogil=True, error_model="numpy")
def add_points(
    sums: NDArray[np.float64], points: NDArray[np.float64], cell_m: float, sign: float
) -> None:
    """Add points to the sums of their cells, or remove them again.

    Args:
        sums: Sums of the cells, (S, S, 6).
        points: Points in the frame of the map [m], (P, 2).
        cell_m: Edge of a cell [m].
        sign: 1 adds, -1 removes; a cell without points is exactly zero again.
    """
    size = len(sums)
    for k in range(len(points)):
        x, y = points[k, 0], points[k, 1]
        cell = sums[int(np.floor(x / cell_m)) % size, int(np.floor(y / cell_m)) % size]
        cell[0] += sign
        if cell[0] < 0.5:
            cell[:] = 0.0
            continue
        cell[1] += sign * x
        cell[2] += sign * y
        cell[3] += sign * x * x
        cell[4] += sign * x * y
        cell[5] += sign * y * y


@njit(cache=True, nogil=True, error_model="numpy")
def line_at(
    sums: NDArray[np.float64], x: float, y: float, cell_m: float, line: NDArray[np.float64]
) -> bool:
    """Fit a line to the points around a place: its cell and the eight around it.

    Args:
        sums: Sums of the cells, (S, S, 6).
        x: Place [m].
        y: Place [m].
        cell_m: Edge of a cell [m].
        line: Receives center x, y [m], unit normal x, y and variance across the line [m²], (5,).

    Returns:
        Whether there are enough points and they lie along a line.
    """
    size = len(sums)
    row, column = int(np.floor(x / cell_m)), int(np.floor(y / cell_m))
    n = sx = sy = sxx = sxy = syy = 0.0
    for a in range(row - 1, row + 2):
        for b in range(column - 1, column + 2):
            cell = sums[a % size, b % size]
            n += cell[0]
            sx += cell[1]
            sy += cell[2]
            sxx += cell[3]
            sxy += cell[4]
            syy += cell[5]
    if n < 4.5:
        return False
    mx, my = sx / n, sy / n
    xx, xy, yy = sxx / n - mx * mx, sxy / n - mx * my, syy / n - my * my
    middle, half = 0.5 * (xx + yy), 0.5 * (xx - yy)
    root = np.sqrt(half * half + xy * xy)
    across, along = max(middle - root, 0.0), middle + root
    # A line must be longer than thick, and long enough for a normal: a fifth of a cell.
    if along < 4.0 * across or along < 0.04 * cell_m * cell_m:
        return False
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    line[0], line[1] = mx, my
    line[2], line[3] = -np.sin(angle), np.cos(angle)
    line[4] = across
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def line_equations(
    sums: NDArray[np.float64],
    coarse: NDArray[np.float64],
    points: NDArray[np.float64],
    weights: NDArray[np.float64],
    pose: NDArray[np.float64],
    scales: NDArray[np.float64],
    out: NDArray[np.float64],
) -> float:
    """Normal equations of the points' distances to the lines of the map.

    Args:
        sums: Sums of the cells, (S, S, 6).
        coarse: Sums of larger cells, for points whose cells have too few points, (C, C, 6).
        points: Points in the frame of the laser [m], (P, 2).
        weights: Weight of each point, (P,).
        pose: Pose of the laser in the map: x, y [m], yaw [rad], (3,).
        scales: Edge of a cell, edge of a coarse cell, standard deviation of a distance, largest
            distance [m]; (4,). Larger distances do not count; smaller ones lose weight
            (Geman-McClure).
        out: Receives H row by row (0..8), the gradient g (9..11) for yaw, x, y, the weighted
            sum of squared distances over variances (12) and the sum of weights (13); (14,).

    Returns:
        Sum of the weights of points within three standard deviations of a line.
    """
    sd_m, gate_m = scales[2], scales[3]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    line = np.zeros(5)
    jacobian = np.zeros(3)
    out[:] = 0.0
    inliers = 0.0
    for k in range(len(points)):
        px = c * points[k, 0] - s * points[k, 1]
        py = s * points[k, 0] + c * points[k, 1]
        x, y = px + pose[0], py + pose[1]
        if not line_at(sums, x, y, scales[0], line) and not line_at(coarse, x, y, scales[1], line):
            continue
        residual = line[2] * (x - line[0]) + line[3] * (y - line[1])
        variance = sd_m * sd_m + line[4]
        if residual * residual < 9.0 * variance:
            inliers += weights[k]
        if abs(residual) > gate_m:
            continue
        shape = 1.0 + residual * residual / (9.0 * variance)
        weight = weights[k] / (shape * shape * variance)
        jacobian[0] = -line[2] * py + line[3] * px
        jacobian[1], jacobian[2] = line[2], line[3]
        for a in range(3):
            for b in range(3):
                out[3 * a + b] += weight * jacobian[a] * jacobian[b]
            out[9 + a] += weight * jacobian[a] * residual
        out[12] += weight * residual * residual
        out[13] += weight * variance
    return inliers
