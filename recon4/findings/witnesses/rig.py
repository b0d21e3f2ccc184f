"""The rig file against the recording."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from msgspec.structs import replace

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.imu import fault_finding, has_derived_times
from recon4.findings.witnesses.tuning import RIG_WITNESS
from recon4.model.calibration_figures import (
    GNSS,
    IMU,
    CalibrationFigures,
    CalibrationOutcome,
    ParameterFigures,
    ParameterStatus,
    RigScatter,
)
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import ImuFault
from recon4.model.rig_origin import RigOrigin

_OF_NO_COST = {"rotation": 0.005, "clock": 0.004}
"""Smaller errors of an IMU cost the map nothing [rad, s]: the odometry estimates the axes of its
gyroscope and its clock, and a leveled map is stated to be tilted by as much as that rotation."""
_SHOWN = {"rad": (float(np.rad2deg(1.0)), "°"), "m": (100.0, " cm"), "s": (1e3, " ms")}


class RigFile(Witness):
    """Mounts, clocks and beams as the windows of the walk show them."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """What contradicts the rig file, or that it agrees."""
        figures = walk.calibration
        if figures is None:
            return
        corrected = walk.odometry_figures.imu_faults if walk.odometry_figures else ()
        untimed = has_derived_times(walk)
        found = list(rig_findings(figures, corrected=corrected, untimed=untimed))
        yield from found or [agreement(figures.outcome, figures.statuses)]


class RigAge(Witness):
    """Date of the calibration in the rig file."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Whether it is too old."""
        if walk.rig is None:
            return
        most = walk.settings.rig.max_age_days
        origin = RigOrigin.of(walk.rig, recorded_ns=walk.recorded_ns, max_age_days=most)
        if origin.is_old and origin.calibration is not None:
            yield finding(
                FindingKind.RIG_OLD,
                Level.NOTE,
                {
                    "date": str(origin.calibration.date),
                    "age_days": origin.age_days or 0,
                    "max_age_days": origin.max_age_days,
                },
            )


def rig_findings(
    figures: CalibrationFigures,
    *,
    corrected: Sequence[ImuFault] = (),
    untimed: bool = False,
) -> Iterator[Finding]:
    """What a recording says against its rig file.

    A calibration corrects what it estimates: that is a note where the calibrated rig is used.

    Args:
        figures: Of the audit or calibration.
        corrected: Errors of the IMU that the odometry found, named and corrected by itself.
        untimed: Whether times of points are derived, see `has_derived_times`.
    """
    for fault in figures.imu_faults:
        yield fault_finding(fault, corrected=False)
    level = Level.DO_NOT_USE if figures.is_severe else Level.CHECK
    if figures.scatter is not None:
        yield _changes(figures.scatter, level)
        return
    for first, second in figures.exchanged:
        names: dict[str, Value] = {"first": repr(first), "second": repr(second)}
        yield finding(FindingKind.RIG_EXCHANGED, level, names)
    if figures.exchanged and not figures.applied:
        return  # all else differs from a mount that is another sensor's
    rows = (*figures.parameters, *figures.beams)
    for sensor in dict.fromkeys(row.sensor for row in rows if row.status == "off"):
        if sensor != GNSS or figures.applied:
            mine = [row for row in rows if row.sensor == sensor]
            left = [_left(row, corrected) for row in mine]
            level = Level.NOTE if figures.applied else _level(left, untimed=untimed)
            yield _contradicted(sensor, mine, level, applied=figures.applied)
    if figures.applied:
        yield from _vague([row for row in rows if row.sensor == GNSS and row.unit == "m"])


def _left(row: ParameterFigures, corrected: Sequence[ImuFault]) -> ParameterFigures:
    """What of a difference was still there when the map was made.

    The clock of an IMU that is ahead is set back by the rig file's offset, so signs are opposite.
    """
    if (row.sensor, row.quantity) != (IMU, "clock"):
        return row
    ahead_s = sum(fault.value for fault in corrected if fault.kind == "clock")
    return replace(row, change=row.change + ahead_s)


def _level(rows: Sequence[ParameterFigures], *, untimed: bool) -> Level:
    """How much the errors of one sensor cost."""
    off = [row for row in rows if row.status == "off" and not _costs_nothing(row, untimed=untimed)]
    if not off:
        return Level.NOTE
    return Level.DO_NOT_USE if any(row.is_severe for row in off) else Level.CHECK


def _costs_nothing(row: ParameterFigures, *, untimed: bool) -> bool:
    """Whether the odometry corrects an error, or nothing states the time it is measured against."""
    if row.quantity == "clock" and untimed:
        return True
    return row.sensor == IMU and abs(row.change) <= _OF_NO_COST.get(row.quantity, 0.0)


def agreement(outcome: CalibrationOutcome | str, statuses: Sequence[ParameterStatus]) -> Finding:
    """What came of comparing the rig file with a recording, and of calibrating it.

    Args:
        outcome: Of the calibration; a sentence in projects of version 0.1.
        statuses: Of each parameter.
    """
    agrees = "consistent" in statuses and "off" not in statuses
    kind = FindingKind.RIG_AGREES if agrees else FindingKind.RIG_NOT_COMPARED
    return finding(kind, Level.GOOD if agrees else Level.NOTE, _outcome(outcome, statuses))


def _outcome(
    outcome: CalibrationOutcome | str, statuses: Sequence[ParameterStatus]
) -> dict[str, Value]:
    if isinstance(outcome, str):
        return {"earlier": outcome}
    return {
        "rig": str(outcome.rig),
        "names": ", ".join(outcome.names),
        "gnss": str(outcome.gnss),
        "gnss_names": ", ".join(outcome.gnss_names),
        "unknown": statuses.count("not observable"),
        "parameters": len(statuses),
    }


def _changes(scatter: RigScatter, level: Level) -> Finding:
    factor, unit = _SHOWN[scatter.unit]
    relation = "about" if scatter.quantity == "rotation" else "along"
    found = finding(
        FindingKind.RIG_CHANGES,
        level,
        {
            "factor": scatter.factor,
            "quantity": scatter.quantity,
            "axis": f"{relation} {scatter.axis}" if scatter.axis else "",
            "what": _what(scatter.sensor),
            "scatter": f"{factor * scatter.sd:.2f}{unit}",
        },
    )
    return replace(found, sensor=scatter.sensor)


def _contradicted(
    sensor: str, rows: Sequence[ParameterFigures], level: Level, *, applied: bool
) -> Finding:
    values: dict[str, Value] = {"what": _what(sensor), "applied": applied}
    values |= {"not_applied": not applied}
    values |= _vector(rows, "rotation", ("rotation_rad", "rotation_sd_rad", "rotation_axis"))
    position = _vector(rows, "position", ("position_cm", "position_sd_cm", "position_axis"))
    values |= {
        name: 100.0 * value if isinstance(value, float) else value
        for name, value in position.items()
    }
    for row in rows:
        if row.quantity == "clock" and row.status == "off":
            values |= {"clock_ms": 1e3 * row.change, "clock_sd_ms": 1e3 * (row.sd or 0.0)}
    values |= _beams(rows)
    return replace(finding(FindingKind.RIG_CONTRADICTED, level, values), sensor=sensor)


def _what(sensor: str) -> str:
    """A word of the catalog, or the name of a LiDAR."""
    return sensor if sensor in ("imu", GNSS) else f"LiDAR {sensor!r}"


def _vector(
    rows: Sequence[ParameterFigures], quantity: str, names: tuple[str, str, str]
) -> dict[str, Value]:
    """Length, standard deviation along it and main axis, if any axis is off."""
    of_kind = [row for row in rows if row.quantity == quantity]
    if not any(row.status == "off" for row in of_kind):
        return {}
    change = np.array([row.change for row in of_kind])
    length = float(np.linalg.norm(change))
    sd_of_axes = np.array([row.sd or 0.0 for row in of_kind])
    sd = float(np.linalg.norm(change / length * sd_of_axes))
    main = of_kind[int(np.argmax(np.abs(change)))]
    return dict(zip(names, (length, sd, main.axis), strict=True))


def _beams(rows: Sequence[ParameterFigures]) -> dict[str, Value]:
    values: dict[str, Value] = {}
    for quantity in ("range", "elevation", "azimuth"):
        off = [row for row in rows if row.quantity == f"beam {quantity}" and row.status == "off"]
        if off:
            most = max(abs(row.change) for row in off)
            values[f"{quantity}_beams"] = len(off)
            values |= {"range_mm": 1e3 * most} if quantity == "range" else {f"{quantity}_rad": most}
    return values


def _vague(rows: Sequence[ParameterFigures]) -> Iterator[Finding]:
    """The axes of the lever arm that the walk shows only roughly."""
    vague = [row for row in rows if (row.sd or 0.0) > RIG_WITNESS.vague_m]
    if vague:
        axes = ", ".join(f"{row.axis} ± {100 * (row.sd or 0.0):.1f} cm" for row in vague)
        yield finding(FindingKind.ANTENNA_VAGUE, Level.NOTE, {"axes": axes})
