"""Whether the positions are known well enough, and what would help."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.findings.finding import Finding, Level
from recon4.findings.kinds import FindingKind
from recon4.findings.walk import WalkRecord, path_length_m
from recon4.findings.witnesses.base import finding
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.uncertainty_files import uncertainty_figures

_KNOWN_M, _KNOWN_PER_METER = 0.05, 0.001
"""Positions are known well with a 2σ of 5 cm and 0.1 % of the path length [m] …"""
_UNKNOWN = 10.0
"""… and unknown above this multiple."""
_ANYWHERE_M = 100.0
_HELPS = 0.8
"""A control point is proposed if it leaves less than this ratio of the largest deviation."""


class Uncertainty:
    """Covariances of the final poses against what a map is good for."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """How well the positions are known."""
        if walk.uncertainty is None or walk.final is None or len(walk.final) < 2:
            return
        found = uncertainty_figures(walk.uncertainty, walk.final)
        known_m, limit_m = 2.0 * found.largest_sd_m, _limit_m(walk.final)
        fine = known_m <= limit_m
        helps = not fine and found.point_sd_m < _HELPS * found.largest_sd_m
        point = {
            "point_from_s": found.point_from_s,
            "point_to_s": found.point_to_s,
            "point_m": 2.0 * found.point_sd_m,
        }
        yield finding(
            FindingKind.UNCERTAINTY,
            _level(known_m, limit_m),
            {
                "known_m": known_m,
                "limit_m": limit_m,
                "at_s": found.at_s,
                "frame": "earth" if found.on_earth else "start",
                "fine": fine,
                "limited": not fine and known_m < _ANYWHERE_M,
                "unlimited": not fine and known_m >= _ANYWHERE_M,
            }
            | (point if helps else {}),
            span_s=None if fine else (found.at_s, found.at_s),
        )


def is_known(walk: WalkRecord) -> bool:
    """Whether all positions are stated to be known well: lost multiframes count as unknown."""
    known = known_to(walk)
    return bool(known) and walk.final is not None and known["known_m"] <= _limit_m(walk.final)


def known_to(walk: WalkRecord) -> dict[str, float]:
    """How well the worst position is known, ``known_m``: 2σ [m]; empty = not stated."""
    if walk.uncertainty is None or walk.final is None or len(walk.final) < 2:
        return {}
    return {"known_m": 2.0 * uncertainty_figures(walk.uncertainty, walk.final).largest_sd_m}


def _level(known_m: float, limit_m: float) -> Level:
    if known_m <= limit_m:
        return Level.GOOD
    return Level.CHECK if known_m <= _UNKNOWN * limit_m else Level.DO_NOT_USE


def _limit_m(final: Trajectory) -> float:
    return _KNOWN_M + _KNOWN_PER_METER * float(path_length_m(final)[-1])
