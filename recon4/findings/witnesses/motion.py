"""What else contradicts the odometry: people who walk along, turns, and bridged gaps."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from msgspec.structs import replace

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.uncertainty import is_known
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import MovingFigures, TurnDoubt


class Moving(Witness):
    """People and vehicles in view."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Whether they fill much of the view, and what became of their points."""
        moving = walk.odometry_figures.moving if walk.odometry_figures else None
        if moving is not None and moving.is_crowded:
            yield moving_finding(moving)


class WeakTurns(Witness):
    """Turns that only the gyroscope holds."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each stretch; no fault of the map where the positions are known well all the same."""
        level = Level.NOTE if is_known(walk) else Level.CHECK
        for doubt in walk.odometry_figures.turns if walk.odometry_figures else ():
            yield turn_finding(doubt, level)


class Bridges(Witness):
    """Gaps that one registration joined."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """How many, the first and the longest."""
        steps = walk.steps
        if "bridged" not in steps or not np.asarray(steps["bridged"]).any():
            return
        t_s = (steps["t_mid_ns"] - steps["t_mid_ns"][0]) / 1e9
        kept = np.flatnonzero(~np.asarray(steps["lost"], bool))
        ends = np.flatnonzero(np.asarray(steps["bridged"])[kept][1:]) + 1
        if not len(ends):
            return
        length_m = np.linalg.norm(np.diff(steps["t_m"][kept], axis=0), axis=1)[ends - 1]
        longest = int(np.argmax(length_m))
        at_s = t_s[kept[ends]]
        yield finding(
            FindingKind.GAP_BRIDGED,
            Level.CHECK,
            {
                "count": len(ends),
                "single": len(ends) == 1,
                "several": len(ends) > 1,
                "first_s": float(at_s[0]),
                "longest_s": float(at_s[longest]),
                "longest_m": float(length_m[longest]),
            },
            span_s=(float(at_s[0]), float(at_s[-1])),
        )


def moving_finding(moving: MovingFigures) -> Finding:
    """Moving objects that fill much of the view."""
    ratio, t_s = np.array(moving.ratio), np.array(moving.t_s)
    crowded = t_s[ratio >= moving.CROWDED]
    return finding(
        FindingKind.MOVING_OBJECTS,
        Level.DO_NOT_USE if moving.is_severe else Level.CHECK,
        {
            "most": float(ratio.max()),
            "most_s": float(t_s[ratio.argmax()]),
            "outcome": str(moving.outcome),
            "points_left_out": moving.points_left_out,
        },
        span_s=(float(crowded[0]), float(crowded[-1])),
    )


def turn_finding(doubt: TurnDoubt, level: Level) -> Finding:
    """A stretch in which the LiDARs hardly observe a turn of the body."""
    x_m, y_m, z_m = doubt.center_m
    turn_rad = 2.0 * doubt.rate_sd_rad_s * (doubt.end_s - doubt.start_s)
    values: dict[str, Value] = {"x_m": x_m, "y_m": y_m, "z_m": z_m, "turn_rad": turn_rad}
    found = finding(FindingKind.WEAK_TURN, level, values, span_s=(doubt.start_s, doubt.end_s))
    axis = "vertical" if abs(doubt.axis[2]) > np.sqrt(0.5) else "horizontal"
    return replace(found, direction=axis)
