"""The one verdict on a map, 3-D, 2-D or still growing: its worst finding decides."""

from __future__ import annotations

from collections.abc import Iterable

from recon4.findings.wording import whole_text
from recon4.model.finding import Finding, Level, worst_first
from recon4.model.finding_kinds import FindingKind
from recon4.model.usability import MapVerdict, Unobserved, Usability

_USABILITY = {
    Level.GOOD: Usability.GOOD,
    Level.NOTE: Usability.GOOD,
    Level.CHECK: Usability.CHECK,
    Level.DO_NOT_USE: Usability.DO_NOT_USE,
}
_NOTHING_CHECKED = Finding(kind=FindingKind.NOTHING_CHECKED, level=Level.CHECK)


def verdict_of(findings: Iterable[Finding]) -> MapVerdict:
    """The verdict on a map. Without any finding nothing was checked: not good."""
    ordered = worst_first(findings) or (_NOTHING_CHECKED,)
    return MapVerdict(
        _USABILITY[ordered[0].level],
        tuple(whole_text(one) for one in ordered if one.is_reason),
        tuple(_unobserved(one) for one in ordered if one.kind in _WEAK),
    )


_WEAK = {FindingKind.WEAK_DIRECTION, FindingKind.CORRIDOR}


def _unobserved(finding: Finding) -> Unobserved:
    start_s, end_s = finding.span_s or (0.0, 0.0)
    from_m, to_m = finding.place_m or ((), ())
    return Unobserved(
        start_s=start_s,
        end_s=end_s,
        direction="" if finding.direction == "unknown" else finding.direction,
        degeneracy=float(finding.values.get("degeneracy", 0.0)),
        from_m=from_m,
        to_m=to_m,
    )
