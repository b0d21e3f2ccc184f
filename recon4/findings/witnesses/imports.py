"""What the readers of the recording had to repair or leave out."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import replace

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.imu import confirms_times
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import GYRO_UNIT_ASSUMED, ImportNotes, import_notes
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.unused_data import unused_parts

_CLOCKS_SET = (FindingKind.CLOCK_BACK, FindingKind.CLOCK_JUMP)
"""Repairs that show as an error of the clock of the IMU where they are wrong, but for fixes."""


class Import(Witness):
    """Outcome, warnings and losses of the import."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """What the readers warn of, and data that is not used."""
        notes = import_notes(walk.imported)
        if notes.outcome != "complete":
            yield finding(FindingKind.IMPORT_INCOMPLETE, Level.CHECK, {"outcome": notes.outcome})
        lines = walk.odometry_figures.lines if walk.odometry_figures else None
        fits = confirms_times(walk.odometry_figures)
        for one in notes.findings:
            is_sure = fits and one.kind in _CLOCKS_SET and one.sensor != "GNSS"
            # LASER-MISSING says it of the walk, and what it costs there.
            if lines is None or one.kind is not FindingKind.LASER_NOT_IN_RIG:
                yield replace(one, level=Level.NOTE) if is_sure else one
        # In the other unit the LiDARs would see the same turns 57 times as fast, or as slow.
        agrees = _lidars_agree(walk.odometry_figures)
        yield from gyro_unit_assumed(notes, Level.NOTE if agrees else Level.CHECK)
        for part in unused_parts(notes.counts):
            if part.is_severe or part.is_scattered:
                level = Level.DO_NOT_USE if part.is_severe else Level.CHECK
                yield finding(FindingKind.IMPORT_UNUSED, level, part.values)


def gyro_unit_assumed(notes: ImportNotes, level: Level) -> Iterator[Finding]:
    """A unit of the gyroscope that its samples alone leave open, if it is."""
    if notes.counts.get(GYRO_UNIT_ASSUMED, 0):
        values: dict[str, Value] = {"fault": "gyroscope_assumed"}
        yield replace(finding(FindingKind.IMU_UNIT, level, values), sensor="IMU")


def _lidars_agree(figures: OdometryFigures | None) -> bool:
    """Whether the odometry of LiDARs used the gyroscope as it was recorded."""
    if figures is None or not figures.imu or figures.lines is not None:
        return False
    return figures.imu_choice is None or figures.imu_choice.outcome != "not used"


class Earlier(Witness):
    """Sentences of stages that were made before findings were records."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each of them."""
        for text, severe in walk.earlier_warnings:
            level = Level.DO_NOT_USE if severe else Level.CHECK
            yield finding(FindingKind.EARLIER_REMARK, level, {"text": text})
