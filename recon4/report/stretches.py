"""Stretches of findings on the time axis of the charts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from recon4.findings.finding import Finding, Level
from recon4.report.figures import AMBER, GRAY, ORANGE, bars

_COLORS = {Level.NOTE: GRAY, Level.CHECK: AMBER, Level.DO_NOT_USE: ORANGE}
_LEAST = 0.004
"""Of the axis: a moment is drawn as wide."""


@dataclass(frozen=True, slots=True)
class MarkedTimes:
    """The stretches of the findings of a walk."""

    findings: tuple[Finding, ...]
    """Those with a stretch that do not confirm the map, worst first."""
    duration_s: float

    @property
    def shaded(self) -> list[tuple[float, float, str]]:
        """First and last time and color of each stretch; the worst ones are drawn last."""
        return [self._part(one) for one in reversed(self.findings)]

    def chart(self) -> list[tuple[str, str]]:
        """SVG and caption of a chart with a row for each kind; none without a stretch."""
        if not self.findings:
            return []
        rows: dict[str, list[tuple[float, float, str]]] = {}
        for one in self.findings:
            rows.setdefault(str(one.kind), []).append(self._part(one))
        label = "time from the start [s]"
        svg = bars("findings", list(rows.items()), label=label, until=self.duration_s)
        text = "Findings along the walk: orange do not use, yellow check, gray notes."
        return [(svg, f"{text} Charts over time are shaded there.")]

    def _part(self, one: Finding) -> tuple[float, float, str]:
        start_s, end_s = one.span_s or (0.0, 0.0)
        return start_s, max(end_s, start_s + _LEAST * self.duration_s), _COLORS[one.level]


def marked_times(findings: Sequence[Finding], duration_s: float) -> MarkedTimes:
    """The findings that have a stretch within the walk."""
    shown = (one for one in findings if one.level in _COLORS and one.span_s is not None)
    return MarkedTimes(
        tuple(one for one in shown if one.span_s and one.span_s[0] <= duration_s), duration_s
    )
