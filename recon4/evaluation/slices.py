"""Relative error e_r: thin slices of the map against the true model (V §3.2, Table 3.2)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.evaluation.reference_mesh import TriangleMesh
from recon4.evaluation.tuning import RELATIVE_ERROR
from recon4.geometry.se3 import SE3, Array

Distance = Callable[[Array], Array]
"""Points in the frame of the model (N, 3) -> distances to it (N,) [m]; see `mesh.distance_to`."""


@dataclass(frozen=True, slots=True, eq=False)
class Slice:
    """A thin slab across the model."""

    name: str
    normal: Array
    """Unit normal of its plane in the frame of the model, (3,)."""
    offset_m: float
    """``normal · p`` of its middle plane [m]."""
    width_m: float = 0.02
    """Thickness [m] (V: 2 cm)."""

    def contains(self, p_model: Array) -> NDArray[np.bool_]:
        """Which of the points (N, 3) lie in it, (N,)."""
        distance_m = p_model @ self.normal - self.offset_m
        return np.asarray(np.abs(distance_m) <= self.width_m / 2.0)


@dataclass(frozen=True, slots=True)
class SliceError:
    """One row of V Table 3.2."""

    name: str
    points: int
    """Points within the outlier limit; the figures below are of these."""
    outliers: int
    """Points beyond the limit: people, mixed pixels, or errors of the map."""
    mean_m: float
    """Mean distance to the model [m]; NaN = no points."""
    ratio_within_2cm: float
    """Ratio of the points within 2 cm, 0..1."""
    ratio_within_5cm: float
    """Ratio of the points within 5 cm, 0..1."""


@dataclass(frozen=True, slots=True, eq=False)
class RelativeError:
    """e_r of a map."""

    slices: tuple[SliceError, ...]
    point_weighted: SliceError
    """All slices together, weighted by points: the average in V."""
    plain_mean_m: float
    """Unweighted mean of the slices' means [m]."""
    outlier_m: float
    """Outlier limit: points farther from the model are only counted [m]."""
    histogram: NDArray[np.int64]
    """Points by distance in classes of a millimeter, without outliers (V Fig. 3.2)."""
    alignment: str
    """How the map was aligned with the model, as text."""


def spread_slices(
    mesh: TriangleMesh, *, horizontal: int = 4, vertical: int = 4, width_m: float = 0.02
) -> tuple[Slice, ...]:
    """Slices spread evenly through the model: half of the vertical ones across x, half across y.

    The k-th of n planes lies at ``(k + 1/2) / n`` of the model's extent.
    """
    low, high = mesh.bounds()
    across_x = (vertical + 1) // 2
    out: list[Slice] = []
    for axis, count, word in (
        (2, horizontal, "z"),
        (0, across_x, "x"),
        (1, vertical - across_x, "y"),
    ):
        normal = np.eye(3)[axis]
        for k in range(count):
            offset_m = float(low[axis] + (k + 0.5) / count * (high[axis] - low[axis]))
            out.append(Slice(f"{word} = {offset_m:.2f} m", normal, offset_m, width_m))
    return tuple(out)


def relative_error(
    chunks: Iterable[Array],
    slices: Iterable[Slice],
    *,
    T_model_map: SE3,
    distance: Distance,
    alignment: str = "given",
) -> RelativeError:
    """Distances of the points in the slices to the model, in one pass with little memory.

    Args:
        chunks: Points of the map [m], arrays of (N, 3), of any length and number.
        slices: The slices, in the frame of the model.
        T_model_map: Moves the map onto the model.
        distance: Distance of points to the model. Points beyond `RELATIVE_ERROR.outlier_m` are
            counted, not averaged.
        alignment: How ``T_model_map`` was found, as text.
    """
    tallies = [_ErrorAccumulator(s, distance) for s in slices]
    for chunk in chunks:
        p_model = T_model_map @ np.asarray(chunk, dtype=np.float64)
        for tally in tallies:
            tally.add(p_model)
    rows = tuple(tally.row() for tally in tallies)
    measured = [row.mean_m for row in rows if row.points]
    histogram = np.sum([one.tally.histogram for one in tallies], axis=0)
    return RelativeError(
        slices=rows,
        point_weighted=merge_slices(rows),
        plain_mean_m=float(np.mean(measured)) if measured else float("nan"),
        outlier_m=RELATIVE_ERROR.outlier_m,
        histogram=histogram,
        alignment=alignment,
    )


class DistanceTally:
    """Counts and sums of distances to the model, without keeping them."""

    def __init__(self) -> None:
        self.histogram = np.zeros(
            int(np.ceil(RELATIVE_ERROR.outlier_m / RELATIVE_ERROR.histogram_step_m)), dtype=np.int64
        )
        self.sum_m = 0.0
        self.outliers = self.within_2cm = self.within_5cm = 0

    def add(self, distance_m: Array) -> None:
        """Add distances [m], (N,); those beyond `RELATIVE_ERROR.outlier_m` are only counted."""
        near = distance_m[distance_m < RELATIVE_ERROR.outlier_m]
        self.outliers += len(distance_m) - len(near)
        self.sum_m += float(near.sum())
        self.within_2cm += int((near < 0.02).sum())
        self.within_5cm += int((near < 0.05).sum())
        classes = np.minimum(
            (near / RELATIVE_ERROR.histogram_step_m).astype(np.int64), len(self.histogram) - 1
        )
        self.histogram += np.bincount(classes, minlength=len(self.histogram))

    def row(self, name: str) -> SliceError:
        """The figures of a slice of this name."""
        points = int(self.histogram.sum())
        return SliceError(
            name=name,
            points=points,
            outliers=self.outliers,
            mean_m=_ratio(self.sum_m, points),
            ratio_within_2cm=_ratio(self.within_2cm, points),
            ratio_within_5cm=_ratio(self.within_5cm, points),
        )


class _ErrorAccumulator:
    """Accumulates the errors of a slice; distances are computed in batches."""

    def __init__(self, where: Slice, distance: Distance) -> None:
        self.where = where
        self.distance = distance
        self.tally = DistanceTally()
        self.waiting_points = 0
        self.waiting: list[Array] = []

    def add(self, p_model: Array) -> None:
        inside = p_model[self.where.contains(p_model)]
        self.waiting.append(inside)
        self.waiting_points += len(inside)
        if self.waiting_points >= RELATIVE_ERROR.batch:
            self._measure()

    def row(self) -> SliceError:
        self._measure()
        return self.tally.row(self.where.name)

    def _measure(self) -> None:
        if not self.waiting_points:
            return
        points = np.ascontiguousarray(np.concatenate(self.waiting))
        self.waiting, self.waiting_points = [], 0
        self.tally.add(np.asarray(self.distance(points), dtype=np.float64))


def merge_slices(rows: tuple[SliceError, ...]) -> SliceError:
    """Merge slices, weighted by points."""
    points = sum(row.points for row in rows)
    used = [row for row in rows if row.points]
    return SliceError(
        name="all points",
        points=points,
        outliers=sum(row.outliers for row in rows),
        mean_m=_ratio(sum(row.mean_m * row.points for row in used), points),
        ratio_within_2cm=_ratio(sum(row.ratio_within_2cm * row.points for row in used), points),
        ratio_within_5cm=_ratio(sum(row.ratio_within_5cm * row.points for row in used), points),
    )


def _ratio(part: float, whole: int) -> float:
    return part / whole if whole else float("nan")
