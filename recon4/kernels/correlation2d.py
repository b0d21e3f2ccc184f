"""Kernels of correlative scan matching: likelihood fields and branch and bound.

Olson 2009 (multi-resolution correlation), Hess 2016 (branch and bound over the whole window).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def likelihood_field(
    points: NDArray[np.float64],
    origin: NDArray[np.float64],
    shape: tuple[int, int],
    cell_m: float,
    stamp: NDArray[np.uint8],
) -> NDArray[np.uint8]:
    """Likelihood of a return in each cell, 0 to 255: the largest stamp of all points.

    Args:
        points: Points of the map [m], (P, 2).
        origin: Corner of cell (0, 0) [m], (2,).
        shape: Cells along x and y.
        cell_m: Edge of a cell [m].
        stamp: Likelihood around a point, odd and square, (2 R + 1, 2 R + 1).
    """
    field = np.zeros(shape, np.uint8)
    reach = len(stamp) // 2
    for k in range(len(points)):
        row = int(np.floor((points[k, 0] - origin[0]) / cell_m))
        column = int(np.floor((points[k, 1] - origin[1]) / cell_m))
        for a in range(max(row - reach, 0), min(row + reach + 1, shape[0])):
            for b in range(max(column - reach, 0), min(column + reach + 1, shape[1])):
                value = stamp[a - row + reach, b - column + reach]
                if value > field[a, b]:
                    field[a, b] = value
    return field


@njit(cache=True, nogil=True, error_model="numpy")
def max_filter(field: NDArray[np.uint8], levels: int) -> NDArray[np.uint8]:
    """Largest values of squares of 2^h cells, for h = 0 … levels.

    Args:
        field: Likelihoods, (X, Y).
        levels: Largest h.

    Returns:
        ``out[h, a + 2^levels, b + 2^levels]`` is the largest value of cells a … a + 2^h - 1 and
        b … b + 2^h - 1; squares that begin before the field are included, hence the offset.
    """
    margin = 1 << levels
    rows, columns = field.shape[0] + 2 * margin, field.shape[1] + 2 * margin
    out = np.zeros((levels + 1, rows, columns), np.uint8)
    out[0, margin : margin + field.shape[0], margin : margin + field.shape[1]] = field
    for h in range(1, levels + 1):
        half = 1 << (h - 1)
        before, now = out[h - 1], out[h]
        for a in range(rows):
            c = min(a + half, rows - 1)
            for b in range(columns):
                d = min(b + half, columns - 1)
                now[a, b] = max(max(before[a, b], before[c, b]), max(before[a, d], before[c, d]))
    return out


@njit(cache=True, nogil=True, error_model="numpy")
def _bound(
    level: NDArray[np.uint8], cells: NDArray[np.int32], dx: int, dy: int, margin: int
) -> float:
    """Mean value at cells moved by (dx, dy), 0 to 1; outside of the array it is 0."""
    total = 0
    rows, columns = level.shape
    for k in range(len(cells)):
        a, b = cells[k, 0] + dx + margin, cells[k, 1] + dy + margin
        if 0 <= a < rows and 0 <= b < columns:
            total += level[a, b]
    return total / (255.0 * max(len(cells), 1))


@njit(cache=True, nogil=True, error_model="numpy")
def branch_and_bound(
    pyramid: NDArray[np.uint8],
    cells: NDArray[np.int32],
    window: int,
    min_score: float,
) -> tuple[float, int, int, int]:
    """Find the rotation and shift with the largest mean likelihood in a window.

    Args:
        pyramid: Of `max_filter`, (levels + 1, X, Y).
        cells: Cells of the points for each rotation, (A, P, 2).
        window: Largest shift along x and y [cells].
        min_score: Smaller scores are not searched for.

    Returns:
        Score (``min_score`` = nothing better was found), row of the rotation, shift x, y [cells].
    """
    levels = len(pyramid) - 1
    margin, stride = 1 << levels, 1 << levels
    across = (2 * window) // stride + 1
    first = np.zeros((len(cells) * across * across, 4))
    count = 0
    for r in range(len(cells)):
        for a in range(across):
            for b in range(across):
                dx, dy = a * stride - window, b * stride - window
                first[count, 0] = _bound(pyramid[levels], cells[r], dx, dy, margin)
                first[count, 1], first[count, 2], first[count, 3] = r, dx, dy
                count += 1
    order = np.argsort(-first[:, 0])
    best, at_r, at_x, at_y = min_score, 0, 0, 0
    stack = np.zeros((4 * levels + 8, 5))
    for k in order:
        if first[k, 0] <= best:
            break
        stack[0, :4], stack[0, 4] = first[k], levels
        filled = 1
        while filled:
            filled -= 1
            bound, r = stack[filled, 0], int(stack[filled, 1])
            dx, dy = int(stack[filled, 2]), int(stack[filled, 3])
            h = int(stack[filled, 4])
            if bound <= best:
                continue
            if h == 0:
                best, at_r, at_x, at_y = bound, r, dx, dy
                continue
            filled = _push_children(pyramid, cells[r], stack, filled, window)
    return best, at_r, at_x, at_y


@njit(cache=True, nogil=True, error_model="numpy")
def _push_children(
    pyramid: NDArray[np.uint8],
    cells: NDArray[np.int32],
    stack: NDArray[np.float64],
    filled: int,
    window: int,
) -> int:
    """Replace the entry at ``filled`` by its four quarters, the best one last."""
    r, dx, dy = stack[filled, 1], int(stack[filled, 2]), int(stack[filled, 3])
    h = int(stack[filled, 4]) - 1
    margin, half = 1 << (len(pyramid) - 1), 1 << h
    start = filled
    for quarter in range(4):
        x, y = dx + half * (quarter // 2), dy + half * (quarter % 2)
        if x > window or y > window:
            continue
        bound = _bound(pyramid[h], cells, x, y, margin)
        at = filled
        while at > start and stack[at - 1, 0] > bound:
            stack[at] = stack[at - 1]
            at -= 1
        stack[at, 0], stack[at, 1], stack[at, 2], stack[at, 3] = bound, r, x, y
        stack[at, 4] = h
        filled += 1
    return filled
