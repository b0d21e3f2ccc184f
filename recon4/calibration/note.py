"""Date, method and standard deviations of a calibration, for the rig file."""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np

from recon4.model.figures import CalibrationFigures, ParameterFigures
from recon4.model.rig import RigCalibration

_FIRST_UTC_NS = 946_684_800_000_000_000
"""2000-01-01: earlier times are those of a clock that was never set."""


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
    if recorded_ns < _FIRST_UTC_NS:
        return None
    mounts, beams = figures.parameters, figures.beams
    return RigCalibration(
        date=datetime.fromtimestamp(recorded_ns / 1e9, UTC).date().isoformat(),
        method=method,
        sd_deg=round(float(np.rad2deg(_largest(mounts, "rad"))), 4),
        sd_mm=round(1e3 * _largest(mounts, "m"), 2),
        sd_ms=round(1e3 * _largest(mounts, "s"), 3),
        sd_beam_deg=round(float(np.rad2deg(_largest(beams, "rad"))), 4),
        sd_beam_mm=round(1e3 * _largest(beams, "m"), 2),
    )


def _largest(rows: tuple[ParameterFigures, ...], unit: str) -> float:
    return max((row.sd or 0.0 for row in rows if row.unit == unit), default=0.0)
