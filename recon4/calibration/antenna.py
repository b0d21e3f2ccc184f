"""The GNSS receiver in the stage ``calibration``: after the mounts, because it needs them."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.result import CalibrationResult
from recon4.calibration.rig_file_note import with_antenna_note
from recon4.calibration.tuning_joint import ANTENNA_STAGE
from recon4.georeference.antenna_calibration import (
    AntennaCalibration,
    GnssRefusal,
    calibrate_antenna,
)
from recon4.model.calibration_figures import (
    GNSS,
    CalibrationFigures,
    CalibrationOutcome,
    GnssOutcome,
)
from recon4.progress import Progress
from recon4.settings.reads import CalibrationReads


def with_antenna(
    found: CalibrationResult, walk: RecordedWalk, *, settings: CalibrationReads, progress: Progress
) -> CalibrationResult:
    """Add what the fixes say of lever arm and clock of the receiver; correct them on request.

    The trajectory of the odometry follows a wrong lever arm in part, where the LiDARs observe
    little. If it contradicts the rig file, a calibration tracks the walk again without the fixes.
    With mounts that are wrong and not corrected nothing is calibrated.

    Args:
        found: What was found of LiDARs and IMU.
        walk: The recording with its odometry.
        settings: Uses calibration, gnss and those of the odometry.
        progress: Counts multiframes that are tracked again.
    """
    wanted = settings.calibration.wanted
    if wanted and GNSS not in wanted:
        return found
    moved = walk.with_rig(found.rig) if found.rig else walk
    antenna = _estimate(moved, settings)
    if antenna is None:
        return found
    may = settings.calibration.mode == "auto" and (found.rig or not found.figures.contradicts)
    if not (may and antenna.is_off):
        return _with_rows(found, _doubted(antenna))
    moved = replace(moved, trajectory=moved.tracked_freely(settings, progress))
    free = _estimate(moved, settings)
    if free is None or not free.is_off:
        return _with_rows(found, _doubted(antenna), GnssRefusal(GnssOutcome.ONLY_AIDED))
    if free.refusal:
        return _with_rows(found, free, free.refusal)
    return _corrected(found, free, recorded_ns=walk.start_ns)


def _estimate(walk: RecordedWalk, settings: CalibrationReads) -> AntennaCalibration | None:
    frames = walk.frames
    return calibrate_antenna(
        walk.trajectory,
        frames.gnss,
        frames.rig,
        imu=frames.imu,
        settings=settings.gnss,
    )


def _doubted(antenna: AntennaCalibration) -> AntennaCalibration:
    """With the standard deviations of a trajectory that the fixes pulled."""
    rows = tuple(
        msgspec.structs.replace(row, sd=ANTENNA_STAGE.aided_sd_factor * (row.sd or 0.0))
        for row in antenna.rows
    )
    return replace(antenna, rows=rows)


def _with_rows(
    found: CalibrationResult, antenna: AntennaCalibration, refusal: GnssRefusal | None = None
) -> CalibrationResult:
    """The rows of the receiver beside the others; its contradictions are said with the map."""
    figures = found.figures
    said = refusal or GnssRefusal(GnssOutcome.CONTRADICTS if antenna.is_off else GnssOutcome.AGREES)
    figures = msgspec.structs.replace(
        figures,
        parameters=(*figures.parameters, *antenna.rows),
        outcome=_with_gnss(figures, said.outcome, said.names),
    )
    return replace(found, figures=figures)


def _corrected(
    found: CalibrationResult, antenna: AntennaCalibration, *, recorded_ns: int
) -> CalibrationResult:
    figures = found.figures
    figures = msgspec.structs.replace(
        figures,
        parameters=(*figures.parameters, *antenna.rows),
        applied=True,
        outcome=_with_gnss(figures, GnssOutcome.CONFIRMED),
    )
    rig = with_antenna_note(antenna.rig, antenna.rows, recorded_ns=recorded_ns)
    return replace(found, figures=figures, rig=rig)


def _with_gnss(
    figures: CalibrationFigures, gnss: GnssOutcome, names: tuple[str, ...] = ()
) -> CalibrationOutcome:
    assert isinstance(figures.outcome, CalibrationOutcome)  # not of an earlier project
    return msgspec.structs.replace(figures.outcome, gnss=gnss, gnss_names=names)
