"""Kernels of 2-D occupancy grids: beams into log-odds, and registration on their gradient."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def cast_scan(
    log_odds: NDArray[np.float32],
    seen: NDArray[np.int32],
    cells: NDArray[np.int32],
    number: int,
    update: NDArray[np.float32],
) -> None:
    """Enter the beams of a scan: cells with a return become more occupied, those before it freer.

    Each cell changes at most once per scan, and a return counts more than a beam that passes.

    Args:
        log_odds: Grid, (X, Y).
        seen: Number of the last scan that changed each cell, (X, Y); negative = a beam passed.
        cells: Cell of the laser, then those of the returns, (1 + P, 2), all inside the grid.
        number: Number of this scan, 1 or more.
        update: Change by a return, by a beam that passes, and largest magnitude, (3,).
    """
    for k in range(1, len(cells)):
        a, b = cells[k, 0], cells[k, 1]
        if seen[a, b] != number:
            seen[a, b] = number
            log_odds[a, b] = min(log_odds[a, b] + update[0], update[2])
    for k in range(1, len(cells)):
        _free(log_odds, seen, cells[0], cells[k], number, update)


@njit(cache=True, nogil=True, error_model="numpy")
def _free(
    log_odds: NDArray[np.float32],
    seen: NDArray[np.int32],
    start: NDArray[np.int32],
    end: NDArray[np.int32],
    number: int,
    update: NDArray[np.float32],
) -> None:
    """Enter the cells of a beam before its return (Bresenham)."""
    a, b = start[0], start[1]
    across, along = abs(end[0] - a), -abs(end[1] - b)
    step_a = 1 if a < end[0] else -1
    step_b = 1 if b < end[1] else -1
    error = across + along
    while a != end[0] or b != end[1]:
        if seen[a, b] != number and seen[a, b] != -number:
            seen[a, b] = -number
            log_odds[a, b] = max(log_odds[a, b] + update[1], -update[2])
        twice = 2 * error
        if twice >= along:
            error += along
            a += step_a
        if twice <= across:
            error += across
            b += step_b


@njit(cache=True, nogil=True, error_model="numpy")
def gradient_equations(
    log_odds: NDArray[np.float32],
    points: NDArray[np.float64],
    pose: NDArray[np.float64],
    frame: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Normal equations of ``1 - M(S(pose))`` over all returns (Kohlbrecher 2011, eqs. 9-12).

    Args:
        log_odds: Grid, (X, Y).
        points: Points in the frame of the laser [m], (P, 2).
        pose: x [m], y [m], yaw [rad], (3,).
        frame: Corner of the grid x, y [m] and edge of a cell [m], (3,).
        out: Receives H row by row (0..8), the gradient g (9..11) for yaw, x, y, the sum of squared
            residuals (12) and the number of returns inside the grid (13); (14,).
    """
    c, s = np.cos(pose[2]), np.sin(pose[2])
    cell_m = frame[2]
    jacobian = np.zeros(3)
    out[:] = 0.0
    for k in range(len(points)):
        px = c * points[k, 0] - s * points[k, 1]
        py = s * points[k, 0] + c * points[k, 1]
        # Probabilities stand at the middles of the cells.
        x = (px + pose[0] - frame[0]) / cell_m - 0.5
        y = (py + pose[1] - frame[1]) / cell_m - 0.5
        a, b = int(np.floor(x)), int(np.floor(y))
        if a < 0 or b < 0 or a + 1 >= log_odds.shape[0] or b + 1 >= log_odds.shape[1]:
            continue
        fx, fy = x - a, y - b
        p00 = 1.0 - 1.0 / (1.0 + np.exp(log_odds[a, b]))
        p10 = 1.0 - 1.0 / (1.0 + np.exp(log_odds[a + 1, b]))
        p01 = 1.0 - 1.0 / (1.0 + np.exp(log_odds[a, b + 1]))
        p11 = 1.0 - 1.0 / (1.0 + np.exp(log_odds[a + 1, b + 1]))
        value = (p00 * (1 - fx) + p10 * fx) * (1 - fy) + (p01 * (1 - fx) + p11 * fx) * fy
        gx = ((p10 - p00) * (1 - fy) + (p11 - p01) * fy) / cell_m
        gy = ((p01 - p00) * (1 - fx) + (p11 - p10) * fx) / cell_m
        residual = 1.0 - value
        jacobian[0] = -gx * py + gy * px
        jacobian[1], jacobian[2] = gx, gy
        for i in range(3):
            for j in range(3):
                out[3 * i + j] += jacobian[i] * jacobian[j]
            out[9 + i] += jacobian[i] * residual
        out[12] += residual * residual
        out[13] += 1.0


@njit(cache=True, nogil=True, error_model="numpy")
def crossing_beams(
    log_odds: NDArray[np.float32], cells: NDArray[np.int32], threshold: float, margin: int
) -> int:
    """Number of beams of a scan that cross occupied cells before their return.

    Args:
        log_odds: Grid, (X, Y).
        cells: Cell of the laser, then those of the returns, (1 + P, 2), all inside the grid.
        threshold: Cells with larger log-odds are occupied.
        margin: Cells this near to either end of a beam do not count.
    """
    count = 0
    for k in range(1, len(cells)):
        da, db = cells[k, 0] - cells[0, 0], cells[k, 1] - cells[0, 1]
        steps = max(abs(da), abs(db))
        for n in range(margin, steps - margin):
            a = cells[0, 0] + int(np.round(da * n / steps))
            b = cells[0, 1] + int(np.round(db * n / steps))
            if log_odds[a, b] > threshold:
                count += 1
                break
    return count
