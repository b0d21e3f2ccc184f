"""The figures of a comparison as lines of text."""

from __future__ import annotations

from recon4.comparison.records import DifferenceCounts, DistanceFigures, MapDifferences


def differences_text(found: MapDifferences) -> str:
    """The figures, as a terminal shows them."""
    first, second = found.first, found.second
    lines = [
        f"{second.name} ({second.key[:8]}) against {first.name} ({first.key[:8]}): "
        f"{found.relation}",
        *_counts(found.counts),
        *(_distances(found.distances) if found.distances else ["no core point has a distance"]),
    ]
    usual = [side.name for side in (first, second) if side.registration == "usual"]
    if usual:
        names = " and ".join(dict.fromkeys(usual))
        lines.append(f"{names}: states no uncertainties; that of a usual good map was used")
    return "\n".join(lines)


def _counts(counts: DifferenceCounts) -> list[str]:
    rows = (
        ("differ significantly (95 %)", counts.significant),
        ("below the level of detection", counts.below_lod),
        ("without a partner in the other map", counts.without_partner),
        ("without a normal", counts.without_normal),
        ("with too few points of their own", counts.sparse),
    )
    every = max(counts.core_points, 1)
    return [
        f"{counts.core_points} core points",
        *(f"{count:10d}  {100.0 * count / every:5.1f} %  {text}" for text, count in rows),
    ]


def _distances(of: DistanceFigures) -> list[str]:
    return [
        f"signed mean {1000.0 * of.mean_m:.1f} mm, standard deviation {1000.0 * of.sd_m:.1f} mm",
        f"absolute: median {1000.0 * of.p50_m:.1f} mm, 95 % below {1000.0 * of.p95_m:.1f} mm, "
        f"largest {1000.0 * of.largest_m:.1f} mm",
        f"level of detection: median {1000.0 * of.lod_p50_m:.1f} mm",
    ]
