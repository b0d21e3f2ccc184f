"""Kernel of the eigenvectors of small matrices.

Kernels of other files call it. Numba does not notice a change here in what it has compiled for
them: after one, remove ``recon4/kernels/__pycache__``.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy", fastmath=True)
def eigen_sym3(
    a: NDArray[np.float64], vals: NDArray[np.float64], vecs: NDArray[np.float64]
) -> None:
    """Eigenvalues (ascending) and vectors (columns) of a symmetric 3x3 by Jacobi rotations."""
    for i in range(3):
        for j in range(3):
            vecs[i, j] = 1.0 if i == j else 0.0
    for _ in range(8):
        off = a[0, 1] ** 2 + a[0, 2] ** 2 + a[1, 2] ** 2
        if off < 1e-24:
            break
        for p in range(2):
            for q in range(p + 1, 3):
                if abs(a[p, q]) < 1e-16:
                    continue
                theta = 0.5 * (a[q, q] - a[p, p]) / a[p, q]
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
                if theta < 0.0:
                    t = -t
                c = 1.0 / np.sqrt(t * t + 1.0)
                s = t * c
                for k in range(3):
                    akp, akq = a[k, p], a[k, q]
                    a[k, p] = c * akp - s * akq
                    a[k, q] = s * akp + c * akq
                for k in range(3):
                    apk, aqk = a[p, k], a[q, k]
                    a[p, k] = c * apk - s * aqk
                    a[q, k] = s * apk + c * aqk
                for k in range(3):
                    vkp, vkq = vecs[k, p], vecs[k, q]
                    vecs[k, p] = c * vkp - s * vkq
                    vecs[k, q] = s * vkp + c * vkq
    for i in range(3):
        vals[i] = a[i, i]
    for i in range(2):
        for j in range(2 - i):
            if vals[j] > vals[j + 1]:
                vals[j], vals[j + 1] = vals[j + 1], vals[j]
                for k in range(3):
                    vecs[k, j], vecs[k, j + 1] = vecs[k, j + 1], vecs[k, j]
