"""Sums of weights along the best paths between some nodes of a graph."""

from __future__ import annotations

from dataclasses import dataclass, field
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
    best by what is stated of some meters of path. Memory does not grow with K then. Paths are
    followed from the anchors of those places that are asked for.
    """

    links: csr_array
    anchors: Rows
    """Nodes, (A,)."""
    anchor: Rows
    """Row of the anchor of each place, (K,)."""
    beside: Array
    """From each place to its anchor, (K,)."""
    along: Array
    """From the first place past all others to each, (K,)."""
    followed: dict[int, Array] = field(default_factory=dict)
    """From an anchor to all of them, (A,), by its row."""

    @staticmethod
    def of(links: csr_array, places: Rows) -> PathSums:
        """Follow the links between places, (K,), in the order of the walk."""
        stride = -(-len(places) // BOUNDS.anchors)
        anchors = places[::stride]
        anchor = np.minimum((np.arange(len(places)) + stride // 2) // stride, len(anchors) - 1)
        along, beside = np.zeros(len(places)), np.zeros(len(places))
        if stride > 1:
            along = np.cumsum(_steps(links, places))
            beside = _beside(links, places, anchor, anchors=anchors, along=along)
        return PathSums(links, anchors, anchor, beside, along)

    def __getitem__(self, at: tuple[Any, Any]) -> Any:
        """Sums from some places to others, as of an array (K, K)."""
        a, b = (np.arange(len(self.anchor))[rows] for rows in at)
        rows, row = np.unique(self.anchor[b], return_inverse=True)
        between = self._between(rows)[row.reshape(np.shape(b)), self.anchor[a]]
        far = self.beside[a] + between + self.beside[b]
        if len(self.anchors) == len(self.anchor):
            return far
        return np.fmin(far, np.abs(self.along[b] - self.along[a]))

    def _between(self, rows: Rows) -> Array:
        """From some anchors to all of them, (R, A)."""
        new = [row for row in rows.tolist() if row not in self.followed]
        for first in range(0, len(new), BOUNDS.chunk):
            some = new[first : first + BOUNDS.chunk]
            sums = dijkstra(self.links, directed=False, indices=self.anchors[some])
            self.followed.update(zip(some, sums[:, self.anchors], strict=True))
        found = [self.followed[row] for row in rows.tolist()]
        return np.array(found, np.float64).reshape(len(rows), len(self.anchors))


def _beside(links: csr_array, places: Rows, anchor: Rows, *, anchors: Rows, along: Array) -> Array:
    """From each place to its anchor; arguments as of `PathSums`, (K,)."""
    beside = np.zeros(len(places))
    own = along[np.searchsorted(places, anchors)]
    # The path along the places is never better; a little more leaves room for rounding.
    farthest = float(np.abs(along - own[anchor]).max()) * (1.0 + 1e-6)
    for first in range(0, len(anchors), BOUNDS.chunk):
        some = slice(first, first + BOUNDS.chunk)
        sums = dijkstra(links, directed=False, indices=anchors[some], limit=farthest)
        mine = np.flatnonzero((anchor >= first) & (anchor < first + len(sums)))
        beside[mine] = sums[anchor[mine] - first, places[mine]]
    return beside


def _steps(links: csr_array, places: Rows) -> Array:
    """From the place before to each place, past the nodes of this part of the walk, (K,)."""
    steps = np.zeros(len(places))
    for first in range(0, len(places) - 1, BOUNDS.chunk):
        some = places[first : first + BOUNDS.chunk + 1]
        part = slice(some[0], some[-1] + 1)
        sums = dijkstra(links[part, part], directed=False, indices=some - some[0])
        steps[first + 1 : first + len(some)] = np.diagonal(sums[:, some - some[0]], 1)
    return steps
