"""The figures of a comparison as lines of text."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.comparison.records import DifferenceCounts, DistanceFigures, MapDifferences
from recon4.locales.coded import CodedText


def differences_lines(found: MapDifferences) -> Iterator[CodedText]:
    """The figures, line by line, as a terminal shows them."""
    first, second = found.first, found.second
    yield CodedText(
        "differences-head",
        second=f"{second.name} ({second.key[:8]})",
        first=f"{first.name} ({first.key[:8]})",
        relation=found.relation,
    )
    yield from _counts(found.counts)
    if found.distances:
        yield from _distances(found.distances)
    else:
        yield CodedText("differences-none")
    usual = [side.name for side in (first, second) if side.registration == "usual"]
    if usual:
        yield CodedText("differences-usual", names=", ".join(dict.fromkeys(usual)))


def _counts(counts: DifferenceCounts) -> Iterator[CodedText]:
    rows = {
        "significant": counts.significant,
        "below": counts.below_lod,
        "alone": counts.without_partner,
        "no-normal": counts.without_normal,
        "sparse": counts.sparse,
    }
    every = max(counts.core_points, 1)
    yield CodedText("differences-core-points", count=counts.core_points)
    for what, count in rows.items():
        yield CodedText(
            "differences-count", count=f"{count:10d}", percent=100.0 * count / every, what=what
        )


def _distances(of: DistanceFigures) -> Iterator[CodedText]:
    yield CodedText("differences-signed", mean_mm=1000.0 * of.mean_m, sd_mm=1000.0 * of.sd_m)
    yield CodedText(
        "differences-absolute",
        median_mm=1000.0 * of.p50_m,
        high_mm=1000.0 * of.p95_m,
        largest_mm=1000.0 * of.largest_m,
    )
    yield CodedText("differences-lod", median_mm=1000.0 * of.lod_p50_m)
