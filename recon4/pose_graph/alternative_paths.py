"""Alternative paths between the ends of each edge, kept up to date while edges are removed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.paths import mark_affected, path_medians
from recon4.model.pose_graph import Flags, Relations


@dataclass(slots=True, eq=False)
class PathIndex:
    """Path discrepancy of every edge: median to its alternative paths (V Eq. 2.9-2.12).

    Not frozen: removing an edge recomputes only edges whose paths may contain it.
    """

    of: Relations
    alive: Flags
    """Edges that paths may use, (E,)."""
    median_m: Array
    """Median translation difference [m], NaN without a path, (E,). Of removed edges: the last."""
    count: NDArray[np.int64]
    """Number of alternative paths, (E,)."""
    max_edges: int
    with_itself: bool
    start: NDArray[np.int64]
    neighbor: NDArray[np.int64]
    edge: NDArray[np.int64]
    T_slot: SE3

    @staticmethod
    def build(of: Relations, *, nodes: int, max_edges: int, with_itself: bool = False) -> PathIndex:
        """Index the edges and compute all medians."""
        ends = np.concatenate([of.i, of.j]).astype(np.int64)
        others = np.concatenate([of.j, of.i]).astype(np.int64)
        order = np.lexsort((others, ends))
        T_j_i = of.T_i_j.inverse()
        T_both = SE3(np.concatenate([of.T_i_j.R, T_j_i.R]), np.concatenate([of.T_i_j.t, T_j_i.t]))
        index = PathIndex(
            of=of,
            alive=of.in_graph.copy(),
            median_m=np.full(len(of), np.nan),
            count=np.zeros(len(of), dtype=np.int64),
            max_edges=max_edges,
            with_itself=with_itself,
            start=np.searchsorted(ends[order], np.arange(nodes + 1)).astype(np.int64),
            neighbor=others[order],
            edge=order % max(len(of), 1),
            T_slot=T_both[order],
        )
        index._refresh(of.in_graph)
        return index

    def remove(self, rows: Any) -> None:
        """Remove edges and update the medians of edges whose paths used them."""
        stale = np.zeros(len(self.of), dtype=np.bool_)
        for row in rows:
            self.mark_affected(int(row), stale)
        self.alive[rows] = False
        self._refresh(stale & self.alive)

    def mark_affected(self, row: int, marked: Flags) -> None:
        """Mark the edges that may have an alternative path through edge ``row``."""
        mark_affected(
            row,
            *(self.of.i, self.of.j, self.start, self.neighbor, self.edge, self.alive),
            np.full(len(self.start) - 1, -1, dtype=np.int64),
            self.max_edges,
            marked,
        )

    def _refresh(self, stale: Flags) -> None:
        rows = np.flatnonzero(stale)
        self.median_m[rows], self.count[rows] = path_medians(
            rows,
            *(self.of.i, self.of.j, self.of.T_i_j.t, self.start, self.neighbor, self.edge),
            *(self.T_slot.R, self.T_slot.t, self.alive, self.max_edges, self.with_itself),
        )


def reject_worst_first(paths: PathIndex, *, free: Flags, limit_m: float) -> list[list[int]]:
    """Remove free edges above the limit until there is none (V §2.8, last paragraph; A0 no. 1).

    A round removes the worst edge, then the next worst whose paths cannot contain a removed one,
    and so on. Of equal edges the earlier one is removed.

    Returns:
        The rows removed in each round.
    """
    rounds: list[list[int]] = []
    while True:
        over = free & paths.alive & (paths.median_m > limit_m)
        candidates = np.flatnonzero(over)
        if len(candidates) == 0:
            return rounds
        worst_first = candidates[np.argsort(-paths.median_m[candidates], kind="stable")]
        blocked = np.zeros(len(free), dtype=np.bool_)
        taken = []
        for row in worst_first.tolist():
            if not blocked[row]:
                taken.append(row)
                paths.mark_affected(row, blocked)
        paths.remove(taken)
        rounds.append(taken)
