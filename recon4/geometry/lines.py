"""Straight lines in space, as a structure of arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.geometry.tuning import LINES


@dataclass(frozen=True, slots=True, eq=False)
class Lines:
    """Segments, each kept as its midpoint and unit direction."""

    mid: Array
    """Midpoints [m], (N, 3)."""
    dir: Array
    """Unit directions, (N, 3)."""

    @staticmethod
    def through(a: Array, b: Array) -> Lines:
        """Lines through pairs of different points [m], (N, 3) each."""
        d = b - a
        return Lines(0.5 * (a + b), d / np.linalg.norm(d, axis=1, keepdims=True))

    def __len__(self) -> int:
        return len(self.mid)

    def __getitem__(self, rows: Any) -> Lines:
        return Lines(self.mid[rows], self.dir[rows])

    def moved(self, T_a_b: SE3) -> Lines:
        """Transform the lines from frame ``b`` to frame ``a``."""
        return Lines(T_a_b @ self.mid, self.dir @ T_a_b.R.T)


def closest_points(a: Lines, b: Lines) -> tuple[Array, Array]:
    """Nearest points of each pair of lines, both taken as infinite.

    Args:
        a: N lines.
        b: Their N partners, in the same frame.

    Returns:
        The point on each line of ``a`` and its partner on ``b`` [m], (N, 3) each.
        A parallel pair has no unique solution and yields NaN: the caller drops it.

    Velas 2016, eqs. (8)-(13), with unit directions.
    """
    r = a.mid - b.mid
    cos = np.sum(a.dir * b.dir, axis=1)
    sin2 = 1.0 - cos**2
    r_a, r_b = np.sum(r * a.dir, axis=1), np.sum(r * b.dir, axis=1)
    skew = sin2 > LINES.parallel_sin2
    s = np.where(skew, (cos * r_b - r_a) / np.where(skew, sin2, 1.0), np.nan)
    u = r_b + s * cos
    return a.mid + s[:, None] * a.dir, b.mid + u[:, None] * b.dir
