"""Ranges in centimeters or millimeters: found by their size, converted and said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.model.laser_scans import LaserScans
from recon4.recording.lasers.tuning import RANGE_UNITS
from recon4.recording.report import ImportReport


def in_meters(scans: LaserScans, report: ImportReport) -> LaserScans:
    """The scans of a 2-D laser; ranges in another unit are converted, and that is said.

    Raises:
        EmptyRecording: If there is not one return.
        CorruptFile: If no unit makes sense.
    """
    if not np.isfinite(scans.range_m).any():
        raise EmptyRecording(CodedText("laser-no-return"))
    return LaserUnit(report).in_meters(scans)


class LaserUnit:
    """The unit of scans that come in batches; the first one with returns decides."""

    def __init__(self, report: ImportReport) -> None:
        self._report, self._factor = report, 0.0

    def in_meters(self, scans: LaserScans) -> LaserScans:
        """A batch in meters.

        Raises:
            CorruptFile: If no unit makes sense.
        """
        seen = scans.range_m[np.isfinite(scans.range_m)]
        if not self._factor and len(seen):
            self._factor = _laser_factor(seen, scans.range_max_m, self._report)
        if self._factor in (0.0, 1.0):
            return scans
        self._report.count("scans_converted", len(scans))
        return replace(
            scans,
            range_m=(scans.range_m * np.float32(self._factor)).astype(np.float32),
            range_max_m=scans.range_max_m * self._factor,
        )


def line_factor(range_m: NDArray[np.floating], name: str, report: ImportReport) -> float:
    """What the ranges of a profiler must be multiplied with to be meters.

    Args:
        range_m: Returns of the first lines, (N,).
        name: Of the sensor.
        report: Receives a warning if they are not in meters.
    """
    if not len(range_m) or float(np.median(range_m)) <= RANGE_UNITS.far_line_m:
        return 1.0
    is_mm = float(np.percentile(range_m, 1.0)) > RANGE_UNITS.near_cm
    return _reported_unit_m(float(np.median(range_m)), is_mm, name=name, report=report)


def _laser_factor(seen: NDArray[np.floating], range_max_m: float, report: ImportReport) -> float:
    median = float(np.median(seen))
    if median <= RANGE_UNITS.far_m:
        return 1.0
    largest = max(float(seen.max()), range_max_m)
    is_mm = largest > RANGE_UNITS.largest_cm or median > RANGE_UNITS.median_cm
    if median * (1e-3 if is_mm else 1e-2) > RANGE_UNITS.far_m:
        raise CorruptFile(CodedText("laser-ranges-unit", median=median))
    return _reported_unit_m(median, is_mm, name="laser2d", report=report)


def _reported_unit_m(median: float, is_mm: bool, *, name: str, report: ImportReport) -> float:
    unit = "mm" if is_mm else "cm"
    report.warn(FindingKind.RANGE_UNIT, sensor=name, median=median, unit=unit)
    return 1e-3 if is_mm else 1e-2
