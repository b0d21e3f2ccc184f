"""Kernel of calibration: normal equations of points on planes, the planes eliminated later."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def accumulate_point_rows(
    columns: NDArray[np.int64],
    values: NDArray[np.float64],
    weight: NDArray[np.float64],
    residual: NDArray[np.float64],
    plane: NDArray[np.int64],
    plane_values: NDArray[np.float64],
    H: NDArray[np.float64],
    g: NDArray[np.float64],
    B: NDArray[np.float64],
    C: NDArray[np.float64],
    c: NDArray[np.float64],
) -> None:
    """Add the rows of points to the normal equations of parameters and planes.

    Args:
        columns: Parameters that a point depends on; -1 = none, (N, K).
        values: Derivatives of its residual by them, (N, K).
        weight: Of each point, (N,).
        residual: Distances from the plane [m], (N,).
        plane: Row of each point's plane, (N,).
        plane_values: Derivatives by the three parameters of the plane, (N, 3).
        H: Upper triangle of ``J^T W J`` of the parameters, (P, P), added to.
        g: ``J^T W r``, (P,), added to.
        B: Mixed terms ``J^T W J_plane``, (V, 3, P), added to.
        C: ``J_plane^T W J_plane``, (V, 3, 3), added to.
        c: ``J_plane^T W r``, (V, 3), added to.
    """
    for n in range(len(weight)):
        w, r, v = weight[n], residual[n], plane[n]
        for i in range(3):
            c[v, i] += w * plane_values[n, i] * r
            for j in range(3):
                C[v, i, j] += w * plane_values[n, i] * plane_values[n, j]
        for a in range(columns.shape[1]):
            row = columns[n, a]
            if row < 0:
                continue
            scaled = w * values[n, a]
            g[row] += scaled * r
            for i in range(3):
                B[v, i, row] += scaled * plane_values[n, i]
            for b in range(columns.shape[1]):
                column = columns[n, b]
                if column >= row:
                    H[row, column] += scaled * values[n, b]
