"""Sums of weights along the best paths between some nodes of a graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from recon4.geometry.se3 import Array
from recon4.model.pose_graph import Rows
from recon4.pose_graph.tuning_places import BOUNDS


def links_of(i: Rows, j: Rows, weight: Array, *, count: int) -> csr_array:
    """Sparse matrix of weights between nodes ``i`` and ``j``, (E,), of a graph of ``count`` nodes.

    Of several edges between two nodes the best counts; a sparse matrix alone would add them.
    """
    low, high = np.minimum(i, j), np.maximum(i, j)
    order = np.lexsort((weight, high, low))
    first = np.unique(low[order] * count + high[order], return_index=True)[1]
    rows = order[first]
    return csr_array((weight[rows] + 1e-12, (low[rows], high[rows])), shape=(count, count))


@dataclass(frozen=True, slots=True, eq=False)
class PathSums:
    """Sum along the best path between any two of K places.

    Exact for up to `BOUNDS.anchors` places. Of more, every n-th is an anchor, and paths lead past
    the anchors of both places, or along all places in between: an upper bound, larger than the
    best by what is stated of some meters of path. Memory does not grow with K then.
    """

    anchor: Rows
    """Row of the anchor of each place, (K,)."""
    beside: Array
    """From each place to its anchor, (K,)."""
    between: Array
    """From anchor to anchor, (A, A)."""
    along: Array
    """From the first place past all others to each, (K,)."""

    @staticmethod
    def of(links: csr_array, places: Rows) -> PathSums:
        """Follow the links between places, (K,), in the order of the walk."""
        stride = -(-len(places) // BOUNDS.anchors)
        anchors = places[::stride]
        anchor = np.minimum((np.arange(len(places)) + stride // 2) // stride, len(anchors) - 1)
        between = np.empty((len(anchors), len(anchors)))
        beside = np.empty(len(places))
        for first in range(0, len(anchors), BOUNDS.chunk):
            some = slice(first, first + BOUNDS.chunk)
            sums = dijkstra(links, directed=False, indices=anchors[some])
            between[some] = sums[:, anchors]
            mine = np.flatnonzero((anchor >= first) & (anchor < first + len(sums)))
            beside[mine] = sums[anchor[mine] - first, places[mine]]
        steps = _steps(links, places) if stride > 1 else np.zeros(len(places))
        return PathSums(anchor, beside, between, np.cumsum(steps))

    def __getitem__(self, at: tuple[Any, Any]) -> Any:
        """Sums from some places to others, as of an array (K, K)."""
        a, b = (np.arange(len(self.anchor))[rows] for rows in at)
        far = self.beside[a] + self.between[self.anchor[a], self.anchor[b]] + self.beside[b]
        if len(self.between) == len(self.anchor):
            return far
        return np.fmin(far, np.abs(self.along[b] - self.along[a]))


def _steps(links: csr_array, places: Rows) -> Array:
    """From the place before to each place, past the nodes of this part of the walk, (K,)."""
    steps = np.zeros(len(places))
    for first in range(0, len(places) - 1, BOUNDS.chunk):
        some = places[first : first + BOUNDS.chunk + 1]
        part = slice(some[0], some[-1] + 1)
        sums = dijkstra(links[part, part], directed=False, indices=some - some[0])
        steps[first + 1 : first + len(some)] = np.diagonal(sums[:, some - some[0]], 1)
    return steps
