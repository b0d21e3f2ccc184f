"""Comparison of map slices with a reference: the rows of V Table 3.2."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.evaluation.slices import DistanceTally, SliceError, merge_slices
from recon4.evaluation.tuning import RELATIVE_ERROR
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText, said
from recon4.locales.languages import ENGLISH
from recon4.mapping.tiles import TileSet
from recon4.model.plain import finite_or_none
from recon4.slices.points import points_in
from recon4.slices.reference import Method, Reference, ReferenceOffsets, alignment_text
from recon4.slices.reference_fit import ReferenceFit, fit_of
from recon4.slices.residual_table import UNKNOWN
from recon4.slices.slice_plane import PlanePosition, SlicePlane
from recon4.slices.tuning import SIGNED
from recon4.slices.tuning_files import REFERENCES, SLICE_PLANES

_METHODS: dict[Method, str] = {
    "plane": "to the reference's surface",
    "point": "to its nearest point (V)",
}


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


@dataclass(frozen=True, slots=True)
class ComparedSlice:
    """One slice against a reference; figures without points are None."""

    name: str
    points: int
    outliers: int
    mean_m: float | None
    """Mean distance, without sign."""
    ratio_within_2cm: float | None
    ratio_within_5cm: float | None
    signed: SignedFigures
    position: PlanePosition | None = None
    """Where it lies; None = several slices together."""

    @staticmethod
    def of(
        row: SliceError, signed: SignedFigures, position: PlanePosition | None = None
    ) -> ComparedSlice:
        """The row of a slice."""
        return ComparedSlice(
            name=row.name,
            points=row.points,
            outliers=row.outliers,
            mean_m=finite_or_none(row.mean_m),
            ratio_within_2cm=finite_or_none(row.ratio_within_2cm),
            ratio_within_5cm=finite_or_none(row.ratio_within_5cm),
            signed=signed,
            position=position,
        )


@dataclass(frozen=True, slots=True)
class Comparison:
    """Errors of map slices against a reference (V Table 3.2), and their signs."""

    slices: tuple[ComparedSlice, ...]
    point_weighted: ComparedSlice
    """All slices together, weighted by points."""
    plain_mean_m: float | None
    """Unweighted mean of the slices' means [m]; None = no points."""
    outlier_m: float
    """Points farther from the reference are only counted [m]."""
    histogram: tuple[int, ...]
    """Points by signed distance, from ``-histogram_end_m`` on; the end classes are open."""
    histogram_step_m: float
    histogram_end_m: float
    fit: ReferenceFit
    reference: str
    """Name of the reference."""
    method: Method
    alignment: str = "none"
    """How the reference was aligned with the map."""
    notes: tuple[str, ...] = ()
    """How its columns, units and CRS were read, as sentences."""


def compare(
    tiles: TileSet,
    planes: Sequence[SlicePlane],
    reference: Reference,
    *,
    rng: np.random.Generator,
    language: str = ENGLISH,
) -> Comparison:
    """Mean distance and ratios within 2 and 5 cm of every slice, from all its points; and signs.

    Points farther than 0.5 m from the reference (people, changed objects) are outliers and counted
    separately. Averages are weighted by points, as in V, and plain over the slices. What is said
    of the reference is in the language.

    Raises:
        ConfigError: Without slices.
    """
    if not planes:
        raise ConfigError(CodedText("comparison-no-slice"))
    found = [_one(tiles, plane, reference) for plane in planes]
    rows = tuple(row for row, _ in found)
    measured = [row.mean_m for row in rows if row.points]
    all_signed = merged([signed for _, signed in found])
    fit = fit_of(tiles, reference, rng=rng)
    return Comparison(
        slices=tuple(
            ComparedSlice.of(row, signed.figures(), plane.position)
            for plane, (row, signed) in zip(planes, found, strict=True)
        ),
        point_weighted=ComparedSlice.of(merge_slices(rows), all_signed.figures()),
        plain_mean_m=float(np.mean(measured)) if measured else None,
        outlier_m=RELATIVE_ERROR.outlier_m,
        histogram=tuple(all_signed.histogram.tolist()),
        histogram_step_m=SIGNED.histogram_step_m,
        histogram_end_m=SIGNED.histogram_end_m,
        fit=replace(fit, text=said(fit.text, language)),
        reference=reference.name,
        method=reference.method,
        alignment=alignment_text(reference.alignment, language),
        notes=tuple(one.said(language) for one in reference.notes),
    )


def _one(tiles: TileSet, plane: SlicePlane, reference: Reference) -> tuple[SliceError, SignedTally]:
    distances, signed = DistanceTally(), SignedTally()
    for part in points_in(tiles, plane, ["normal"]):
        found = reference.offsets(plane.to_map(part.uvd))
        distances.add(found.distance_m)
        signed.add(found, part.columns["normal"].astype(np.float64))
    return distances.row(plane.name), signed


def usual_planes(
    tiles: TileSet, *, thickness_m: float = SLICE_PLANES.error_thickness_m
) -> tuple[SlicePlane, ...]:
    """Eight slices spread evenly: four horizontal, two across x, two across y (V §3.2)."""
    low, high = tiles.bounds_m
    if not np.isfinite(low).all():
        raise ConfigError(CodedText("comparison-no-points"))
    x, y, z = ((low[a] + (np.arange(4) + 0.5) / 4.0 * (high - low)[a]) for a in range(3))
    planes = [SlicePlane.horizontal(float(h), thickness_m=thickness_m) for h in z]
    for k in (0, 2):
        middle = (x[k] + x[k + 1]) / 2.0
        planes.append(
            SlicePlane.vertical(
                (middle, float(low[1])), (middle, float(high[1])), thickness_m=thickness_m
            )
        )
    for k in (0, 2):
        middle = (y[k] + y[k + 1]) / 2.0
        planes.append(
            SlicePlane.vertical(
                (float(low[0]), middle), (float(high[0]), middle), thickness_m=thickness_m
            )
        )
    return tuple(planes)


def to_csv(found: Comparison) -> str:
    """The table as CSV in centimeters and percent, then both averages, remarks, the histogram."""
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(
        [
            *("slice", "points", "outliers", "mean_cm", "below_2cm_pct", "below_5cm_pct"),
            *("signed_points", "signed_mean_cm", "signed_sd_cm"),
            *("shift_x_cm", "shift_y_cm", "shift_z_cm"),
        ]
    )
    for row in (*found.slices, found.point_weighted):
        name = "average weighted by points" if row is found.point_weighted else row.name
        figures = (row.mean_m, row.ratio_within_2cm, row.ratio_within_5cm)
        signed = (row.signed.mean_m, row.signed.sd_m, *row.signed.shift_m)
        rows.writerow(
            [
                *(name, row.points, row.outliers, *map(_number, figures)),
                *(row.signed.points, *map(_number, signed)),
            ]
        )
    rows.writerow(["plain average of the slices", "", "", _number(found.plain_mean_m)])
    rows.writerow([])
    remarks = (
        f"against {found.reference}: {found.fit.text}",
        f"distances: {_METHODS[found.method]}",
        f"alignment of the reference: {found.alignment}",
        *(f"reference: {note}" for note in found.notes),
        "signed: + = the map lies in front of the reference, on the side it was seen from",
    )
    out.writelines(f"# {' '.join(remark.split())}\n" for remark in remarks)
    rows.writerow(["signed_from_cm", "points"])
    for k, count in enumerate(found.histogram):
        low_m = k * found.histogram_step_m - found.histogram_end_m
        rows.writerow([f"{100.0 * low_m:.1f}" if k else "below", count])
    return out.getvalue()


def signed_text(signed: SignedFigures) -> str:
    """The signed figures as one line in centimeters."""
    x, y, z = map(_number, signed.shift_m)
    return (
        f"signed mean {_number(signed.mean_m)} cm, σ {_number(signed.sd_m)} cm; "
        f"shift of the map x {x}, y {y}, z {z} cm"
    )


def _number(value: float | None) -> str:
    return UNKNOWN if value is None else f"{100.0 * value:.2f}"
