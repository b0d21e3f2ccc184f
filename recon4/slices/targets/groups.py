"""Places that belong together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array


def groups_of(places: Array, within_m: float) -> list[NDArray[np.intp]]:
    """Rows of places (N, 3) joined by steps of at most a distance [m]."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    if not len(places):
        return []
    pairs = cKDTree(places).query_pairs(within_m, output_type="ndarray")
    ones = np.ones(len(pairs), dtype=np.int8)
    links = coo_matrix((ones, (pairs[:, 0], pairs[:, 1])), shape=(len(places), len(places)))
    _, group = connected_components(links, directed=False)
    order = np.argsort(group, kind="stable")
    return list(np.split(order, np.flatnonzero(np.diff(group[order])) + 1))


def best_apart(places: Array, score: Array, apart_m: float) -> NDArray[np.intp]:
    """Rows of places (N, 3), the best first, each at least a distance from all better ones."""
    from scipy.spatial import cKDTree

    if not len(places):
        return np.zeros(0, np.intp)
    tree = cKDTree(places)
    left = np.ones(len(places), np.bool_)
    chosen = []
    for row in np.argsort(-score, kind="stable").tolist():
        if left[row]:
            chosen.append(row)
            left[tree.query_ball_point(places[row], apart_m)] = False
    return np.array(chosen, np.intp)
