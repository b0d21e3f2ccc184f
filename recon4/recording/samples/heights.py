"""What heights of fixes are above: the ellipsoid, or the geoid (above sea level)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import HEIGHTS_ORTHOMETRIC, HEIGHTS_UNSTATED
from recon4.model.samples import GnssSamples
from recon4.model.tuning import GEOID
from recon4.recording.report import ImportReport
from recon4.recording.samples.tuning import HEIGHTS

STATED_COLUMNS = ("ellipsoidal_height_m", "orthometric_height_m", "geoid_separation_m")
"""Columns that say what heights are above; ``height_m`` does not."""


def height_above_ellipsoid(columns: Mapping[str, Array], report: ImportReport) -> Array:
    """Heights [m], (N,); those above sea level without a separation stay so, and are counted.

    Args:
        columns: ``height_m`` and those of `STATED_COLUMNS`, (N,) each; NaN = not given.
        report: Gets the counts `HEIGHTS_UNSTATED` and `HEIGHTS_ORTHOMETRIC`.
    """
    stated, above_sea, separation = (columns[name] for name in STATED_COLUMNS)
    out = np.where(np.isfinite(stated), stated, above_sea + separation)
    only_above_sea = ~np.isfinite(out) & np.isfinite(above_sea)
    out = np.where(only_above_sea, above_sea, out)
    unstated = ~np.isfinite(out) & np.isfinite(columns["height_m"])
    report.count(HEIGHTS_ORTHOMETRIC, int(np.count_nonzero(only_above_sea)))
    report.count(HEIGHTS_UNSTATED, int(np.count_nonzero(unstated)))
    return np.where(unstated, columns["height_m"], out)


def height_of_gga(altitude_m: float, separation: object, report: ImportReport) -> float:
    """Ellipsoidal height [m] of a GGA sentence; counts as `height_above_ellipsoid`.

    Args:
        altitude_m: Above sea level.
        separation: Height of the geoid above the ellipsoid [m]. Empty = not given. Receivers
            without a model of the geoid write 0, and either of both heights.
        report: Gets the counts.
    """
    if separation in ("", None):
        report.count(HEIGHTS_ORTHOMETRIC)
        return altitude_m
    separation_m = float(str(separation))
    report.count(HEIGHTS_UNSTATED, int(separation_m == 0.0))
    return altitude_m + separation_m


def compare_heights(given: GnssSamples, found: GnssSamples, report: ImportReport) -> None:
    """Warn if heights of a file differ from those in the recording as a geoid does.

    Args:
        given: Fixes of the file, which are used.
        found: Fixes of the recording at the same place.
        report: Gets the warning.
    """
    given, found = (_in_order(one) for one in (given, found))
    if not len(given) or not len(found):
        return
    after = np.clip(np.searchsorted(given.t_ns, found.t_ns), 1, max(len(given) - 1, 1))
    pair = np.stack([after - 1, np.minimum(after, len(given) - 1)])
    gap_ns = np.abs(given.t_ns[pair] - found.t_ns)
    nearest = pair[np.argmin(gap_ns, axis=0), np.arange(len(found))]
    apart_m = (given.height_m[nearest] - found.height_m)[gap_ns.min(axis=0) < HEIGHTS.near_ns]
    if len(apart_m) < HEIGHTS.least:
        return
    usual_m = float(np.median(apart_m))
    spread_m = float(np.median(np.abs(apart_m - usual_m)))
    low_m, high_m = GEOID.least_m, GEOID.most_m
    if low_m < abs(usual_m) < high_m and spread_m < HEIGHTS.spread_m:
        report.warn(
            FindingKind.HEIGHTS_DIFFER,
            difference_m=abs(usual_m),
            spread_m=spread_m,
            side="above" if usual_m > 0 else "below",
            separation_m=-usual_m,
        )


def _in_order(fixes: GnssSamples) -> GnssSamples:
    rows = np.flatnonzero(np.isfinite(fixes.height_m))
    return fixes.take(rows[np.argsort(fixes.t_ns[rows], kind="stable")])
