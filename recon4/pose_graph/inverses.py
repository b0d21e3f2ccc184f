"""Blocks of the inverse of a sparse matrix, only where its factor is not zero (Takahashi 1973)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.selected_inverse import entries, selected_inverse

if TYPE_CHECKING:
    from scipy.sparse import csc_array


@dataclass(frozen=True, slots=True, eq=False)
class SelectedInverse:
    """Entries of the inverse of the information matrix of nodes with K axes each."""

    start: NDArray[np.int64]
    row: NDArray[np.int64]
    values: Array
    """Columns of the lower factor's pattern, compressed, with the entries of the inverse."""
    axes: NDArray[np.int64]
    """Columns of each node in it, (N, K)."""

    def blocks(self, a: NDArray[np.intp], b: NDArray[np.intp]) -> Array:
        """Blocks of pairs of nodes, (M, K, K): their covariance if both are joined by an edge."""
        at_a, at_b = np.broadcast_arrays(self.axes[a][:, :, None], self.axes[b][:, None, :])
        found: Array = entries(self.start, self.row, self.values, at_a.ravel(), at_b.ravel())
        return found.reshape(-1, *at_a.shape[1:])


def inverted(information: csc_array, *, axes: int) -> SelectedInverse:
    """The inverse of a positive definite matrix.

    Args:
        information: (N K, N K).
        axes: How many a node has, K.
    """
    from scipy.sparse.linalg import splu  # slow to import, and most of the review needs none

    factor = splu(
        information,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    lower = factor.L.tocsc()
    lower.sort_indices()
    start, row = lower.indptr.astype(np.int64), lower.indices.astype(np.int64)
    values = selected_inverse(start, row, lower.data, factor.U.diagonal())
    return SelectedInverse(start, row, values, factor.perm_c.astype(np.int64).reshape(-1, axes))
