"""Stretches of findings on the axes of the charts, and on the trajectory in the plans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.finding import Finding, Level
from recon4.model.trajectory import Trajectory
from recon4.report.figures import AMBER, GRAY, ORANGE, bars
from recon4.report.plan import PlanPath
from recon4.report.tuning import STRETCH_CHART

_COLORS = {Level.NOTE: GRAY, Level.CHECK: AMBER, Level.DO_NOT_USE: ORANGE}
_PATHS = {
    Level.NOTE: ("line-note", "a note"),
    Level.CHECK: ("line-check", "to be checked"),
    Level.DO_NOT_USE: ("line-do-not-use", "do not use"),
}
"""CSS class of a stretch in a plan, and its legend; the worst ones are drawn last."""


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

    def shaded_at(self, t_s: Array, x: Array) -> list[tuple[float, float, str]]:
        """`shaded` on an axis that is not the time.

        Args:
            t_s: Times since the start, increasing [s], (N,).
            x: Places on the axis at these times, (N,).
        """
        ends = [(np.interp([start, end], t_s, x), color) for start, end, color in self.shaded]
        return [(float(at[0]), float(at[1]), color) for at, color in ends]

    def paths(self, walk: Trajectory) -> tuple[PlanPath, ...]:
        """The parts of the trajectory within the stretches, a path for each level."""
        t_s = (walk.t_ns - walk.t_ns[0]) / 1e9
        pieces: dict[Level, list[Array]] = {}
        for one in self.findings:
            start_s, end_s, _ = self._part(one)
            first, last = np.searchsorted(t_s, [start_s, end_s])
            piece = walk.T_a_b.t[max(int(first) - 1, 0) : int(last) + 1]
            pieces.setdefault(one.level, []).append(piece)
        return tuple(
            PlanPath(css, tuple(pieces[level]))
            for level, (css, _) in _PATHS.items()
            if level in pieces
        )

    @property
    def legend(self) -> tuple[tuple[str, str], ...]:
        """CSS class and meaning of each of `paths`."""
        levels = {one.level for one in self.findings}
        return tuple(
            (css, f"stretch of a finding: {text}")
            for level, (css, text) in _PATHS.items()
            if level in levels
        )

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
        return [(svg, f"{text} Charts along the walk are shaded there.")]

    def _part(self, one: Finding) -> tuple[float, float, str]:
        start_s, end_s = one.span_s or (0.0, 0.0)
        return (
            start_s,
            max(end_s, start_s + STRETCH_CHART.least * self.duration_s),
            _COLORS[one.level],
        )


def marked_times(findings: Sequence[Finding], duration_s: float) -> MarkedTimes:
    """The findings that have a stretch within the walk."""
    shown = (one for one in findings if one.level in _COLORS and one.span_s is not None)
    return MarkedTimes(
        tuple(one for one in shown if one.span_s and one.span_s[0] <= duration_s), duration_s
    )
