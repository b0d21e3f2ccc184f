"""What the first trajectory of a rig with a profiler lacks."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import LASER_MISSING
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import LineFigures


class FirstTrajectory(Witness):
    """2-D laser, IMU and profiler against each other."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """What is missing, and clocks and mounts that contradict the rig file."""
        lines = walk.odometry_figures.lines if walk.odometry_figures else None
        if lines is not None:
            yield from line_findings(lines)


def line_findings(lines: LineFigures) -> Iterator[Finding]:
    """Findings about the first trajectory of a rig with a profiler."""
    yield from _laser(lines)
    if lines.imu != "used":
        yield finding(FindingKind.LINES_WITHOUT_IMU, Level.CHECK, {"cause": lines.imu})
    if lines.mirrored:
        yield finding(FindingKind.LASER_MIRRORED, Level.CHECK)
    if lines.imu_ahead_s is not None:
        ahead_s = lines.imu_ahead_s
        yield finding(
            FindingKind.LASER_CLOCK,
            Level.CHECK,
            {"imu_s": -ahead_s, "laser_s": ahead_s} | _ahead(ahead_s),
        )
    if lines.bridged_s:
        yield finding(FindingKind.LASER_BRIDGED, Level.CHECK, {"seconds": lines.bridged_s})
    if lines.profiler_ahead_s is not None:
        ahead_s = lines.profiler_ahead_s
        yield finding(
            FindingKind.PROFILER_CLOCK, Level.CHECK, {"add_s": -ahead_s} | _ahead(ahead_s)
        )
    if lines.mount_change:
        yield finding(FindingKind.PROFILER_MOUNT, Level.CHECK, {"change": lines.mount_change})


def rests(walk: WalkRecord) -> bool:
    """Whether a profiler stands by its IMU: it has no drift, and no place to come back to."""
    lines = walk.odometry_figures.lines if walk.odometry_figures else None
    return lines is not None and lines.laser == "none" and not _drifts(lines)


def _drifts(lines: LineFigures) -> bool:
    return lines.rest_s < LASER_MISSING.rests_ratio * lines.walk_s


def _laser(lines: LineFigures) -> Iterator[Finding]:
    if lines.laser == "none":
        drifts = _drifts(lines)
        values: dict[str, Value] = {"rest_s": lines.rest_s, "rests": lines.rest_s > 0.0}
        level = Level.CHECK if drifts else Level.NOTE
        yield finding(FindingKind.LASER_MISSING, level, values | {"drifts": drifts})
    elif lines.laser == "at other times":
        first_s, last_s = lines.laser_span_s or (0.0, 0.0)
        values = {"first_s": first_s, "last_s": last_s, "walk_s": lines.walk_s}
        yield finding(FindingKind.LASER_ELSEWHEN, Level.CHECK, values)
    elif lines.silent_s:
        values = {"seconds": lines.silent_s, "first_s": lines.silent_from_s}
        yield finding(FindingKind.LASER_SILENT, Level.CHECK, values)


def _ahead(seconds: float) -> dict[str, Value]:
    return {"ahead_ms": 1e3 * abs(seconds), "way": "ahead" if seconds > 0 else "behind"}
