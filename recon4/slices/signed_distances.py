"""Signed distances of a map from a reference: mean, deviation, common shift, histogram."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.slices.reference import ReferenceOffsets
from recon4.slices.tuning import SIGNED
from recon4.slices.tuning_files import REFERENCES

Shift = tuple[float | None, float | None, float | None]


@dataclass(frozen=True, slots=True)
class SignedFigures:
    """Signed distances of map points; None = not known.

    Positive: the map lies in front of the reference, on the side from which it was measured.
    """

    points: int
    """Points with a normal in map and reference."""
    mean_m: float | None
    sd_m: float | None
    """Standard deviation about the mean."""
    shift_m: Shift
    """Common shift of the map against the reference along x, y, z of the map: the translation
    that explains the distances across all surfaces best. A mean of signed distances cannot show
    it: walls that face each other have opposite signs."""


class SignedTally:
    """Sums of signed distances, without keeping them."""

    def __init__(self) -> None:
        self.points = 0
        self.sum_m = self.sum_m2 = 0.0
        self.shifted, self.H, self.b = 0, np.zeros((3, 3)), np.zeros(3)
        classes = round(2.0 * SIGNED.histogram_end_m / SIGNED.histogram_step_m)
        self.histogram = np.zeros(classes, np.int64)

    def add(self, found: ReferenceOffsets, map_normal: Array) -> None:
        """Add points of the map with their normals, (N, 3), zeros = not known."""
        known = np.isfinite(found.distance_m) & (found.distance_m < REFERENCES.far_m)
        known &= np.any(found.normal != 0.0, axis=1)
        n, d = found.normal[known], found.across_m[known]
        self.shifted += len(d)
        self.H += n.T @ n
        self.b += n.T @ d
        side = np.sign(np.einsum("ni,ni->n", n, map_normal[known]))
        d = (side * d)[side != 0.0]
        self.points += len(d)
        self.sum_m += float(d.sum())
        self.sum_m2 += float((d**2).sum())
        at = np.floor((d + SIGNED.histogram_end_m) / SIGNED.histogram_step_m).astype(np.int64)
        last = len(self.histogram) - 1
        self.histogram += np.bincount(np.clip(at, 0, last), minlength=last + 1)

    def figures(self) -> SignedFigures:
        """The figures of all points that were added."""
        if not self.points:
            return SignedFigures(0, None, None, self._shift())
        mean = self.sum_m / self.points
        sd = np.sqrt(max(0.0, self.sum_m2 / self.points - mean**2))
        return SignedFigures(self.points, mean, float(sd), self._shift())

    def _shift(self) -> Shift:
        """Least squares of ``n · t = d``, only in the directions that surfaces face."""
        if self.shifted < SIGNED.least_points:
            return None, None, None
        facing, axes = np.linalg.eigh(self.H / self.shifted)
        good = facing >= SIGNED.least_facing
        V = axes[:, good]
        t = V @ ((V.T @ self.b) / (self.shifted * facing[good]))
        known: NDArray[np.bool_] = np.linalg.norm(V, axis=1) >= SIGNED.in_span
        x, y, z = (float(value) if ok else None for value, ok in zip(t, known, strict=True))
        return x, y, z


def merged(tallies: list[SignedTally]) -> SignedTally:
    """The sums of several slices together."""
    out = SignedTally()
    for one in tallies:
        out.points += one.points
        out.sum_m += one.sum_m
        out.sum_m2 += one.sum_m2
        out.shifted += one.shifted
        out.H += one.H
        out.b += one.b
        out.histogram += one.histogram
    return out
