"""Date, method and standard deviations of a calibration, for the rig file."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.model.calibration_figures import GNSS, CalibrationFigures, ParameterFigures
from recon4.model.rig import Rig, RigCalibration
from recon4.model.rig_origin import recording_day


def calibration_note(
    method: str, figures: CalibrationFigures, *, recorded_ns: int
) -> RigCalibration | None:
    """What a rig file says of its calibration; None if the recording has no date.

    The date is that of the walk: since then the mounts may have changed.

    Args:
        method: As ``joint``.
        figures: What was estimated.
        recorded_ns: Start of the recording [ns].
    """
    date = _date(recorded_ns)
    if not date:
        return None
    mounts, beams = figures.parameters, figures.beams
    return RigCalibration(
        date=date,
        method=method,
        sd_deg=round(float(np.rad2deg(_largest(mounts, "rad"))), 4),
        sd_mm=round(1e3 * _largest(mounts, "m"), 2),
        sd_ms=round(1e3 * _largest(mounts, "s"), 3),
        sd_beam_deg=round(float(np.rad2deg(_largest(beams, "rad"))), 4),
        sd_beam_mm=round(1e3 * _largest(beams, "m"), 2),
    )


def with_antenna_note(rig: Rig, rows: tuple[ParameterFigures, ...], *, recorded_ns: int) -> Rig:
    """A rig whose note also has the standard deviations of lever arm and clock of the receiver.

    The date of mounts that were calibrated on another day stays.

    Args:
        rig: With or without a note.
        rows: What was estimated of the receiver.
        recorded_ns: Start of the recording [ns].
    """
    date = _date(recorded_ns)
    if rig.calibration is None and not date:
        return rig
    note = rig.calibration or RigCalibration(
        date=date, method=GNSS, sd_deg=0.0, sd_mm=0.0, sd_ms=0.0
    )
    antenna = replace(
        note,
        sd_antenna_mm=round(1e3 * _largest(rows, "m"), 2),
        sd_gnss_ms=round(1e3 * _largest(rows, "s"), 3),
    )
    return replace(rig, calibration=antenna)


def _date(recorded_ns: int) -> str:
    """Day of a recording, as ``2026-11-22``; empty = its clock was never set."""
    day = recording_day(recorded_ns)
    return day.isoformat() if day else ""


def _largest(rows: tuple[ParameterFigures, ...], unit: str) -> float:
    return max((row.sd or 0.0 for row in rows if row.unit == unit), default=0.0)
