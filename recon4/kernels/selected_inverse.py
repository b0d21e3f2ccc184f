"""Selected entries of the inverse of a sparse symmetric matrix."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def selected_inverse(
    start: NDArray[np.integer],
    row: NDArray[np.integer],
    lower: NDArray[np.float64],
    diagonal: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Entries of ``A^-1`` at the nonzero positions of the factor of ``A = L D L^T``.

    Args:
        start: Entries of column n are ``start[n]:start[n + 1]``, (N + 1,).
        row: Row of each entry, increasing within a column, the diagonal first, (K,).
        lower: Entries of the unit lower triangle ``L``, (K,).
        diagonal: ``D``, (N,).

    Returns:
        Entries of the inverse at the same positions, (K,).

    Takahashi 1973: columns from the last to the first,
    ``Z_ij = -sum_k L_kj Z_ik`` and ``Z_jj = 1/D_j - sum_k L_kj Z_kj``.
    """
    count = len(start) - 1
    Z = np.zeros(len(row))
    place = np.full(count, -1, dtype=np.int64)
    total = np.zeros(count)
    for j in range(count - 1, -1, -1):
        first, last = start[j] + 1, start[j + 1]
        for a in range(first, last):
            place[row[a]] = a
            total[a - first] = 0.0
        for a in range(first, last):
            k = row[a]
            for p in range(start[k], start[k + 1]):
                b = place[row[p]]
                if b < 0:
                    continue
                total[b - first] += lower[a] * Z[p]
                if b != a:
                    total[a - first] += lower[b] * Z[p]
        Z[start[j]] = 1.0 / diagonal[j]
        for a in range(first, last):
            Z[a] = -total[a - first]
            Z[start[j]] -= lower[a] * Z[a]
            place[row[a]] = -1
    return Z


@njit(cache=True, nogil=True, error_model="numpy")
def entries(
    start: NDArray[np.integer],
    row: NDArray[np.integer],
    values: NDArray[np.float64],
    a: NDArray[np.integer],
    b: NDArray[np.integer],
) -> NDArray[np.float64]:
    """Entries of a symmetric matrix whose lower triangle is stored; NaN if not stored.

    Args:
        start: As for `selected_inverse`.
        row: As for `selected_inverse`.
        values: Stored entries, (K,).
        a: Requested rows, (M,).
        b: Requested columns, (M,).

    Returns:
        (M,).
    """
    out = np.full(len(a), np.nan)
    for m in range(len(a)):
        low, high = min(a[m], b[m]), max(a[m], b[m])
        first, last = start[low], start[low + 1]
        p = first + np.searchsorted(row[first:last], high)
        if p < last and row[p] == high:
            out[m] = values[p]
    return out
