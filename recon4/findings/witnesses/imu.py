"""The IMU against the LiDARs, gravity and its own range."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from msgspec.structs import replace

from recon4.findings.imu_axes import axes_findings
from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import IMU_WITNESS
from recon4.findings.witnesses.uncertainty import known_to
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import CLOUDS_EVENED, CLOUDS_UNTIMED, import_notes
from recon4.model.odometry_figures import (
    HeightDoubt,
    ImuChoice,
    ImuFault,
    OdometryFigures,
)
from recon4.registration.imu_gravity import wrong_gravity
from recon4.registration.imu_saturation import SaturatedAxis, saturated_axes
from recon4.registration.motion import imu_in_body
from recon4.units import STANDARD_GRAVITY_M_S2

_OUTCOMES = {
    "bias removed": FindingKind.IMU_BIAS_REMOVED,
    "accelerometer not used": FindingKind.IMU_ACCELEROMETER_NOT_USED,
    "not used": FindingKind.IMU_NOT_USED,
}


class ImuUse(Witness):
    """Which samples the odometry used, and what its filter corrected."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """An IMU that is not used as recorded, and its errors."""
        figures = walk.odometry_figures
        if figures is None:
            return
        if walk.frames is not None and not walk.frames.imu and figures.lines is None:
            yield finding(FindingKind.IMU_MISSING, Level.NOTE, known_to(walk))
        if figures.imu_choice is not None and figures.imu_choice.outcome in _OUTCOMES:
            yield _choice(figures.imu_choice)
        yield from axes_findings(figures.imu_turn, figures.imu_axes)
        if figures.forces_reversed is not None:
            samples = len(walk.imu) if walk.imu is not None else 0
            values: dict[str, Value] = {"correlation": figures.forces_reversed, "samples": samples}
            found = finding(FindingKind.IMU_FORCES_REVERSED, Level.NOTE, values)
            yield replace(found, sensor="IMU")
        untimed = has_derived_times(walk)
        for fault in figures.imu_faults:
            found = fault_finding(fault, corrected=True)
            yield _of_derived_times(found) if untimed and fault.kind == "clock" else found


def has_derived_times(walk: WalkRecord) -> bool:
    """Whether times of points follow from stamps: nothing states their place in a cloud, or how
    late they are.
    """
    counts = import_notes(walk.imported).counts
    return CLOUDS_UNTIMED in counts or CLOUDS_EVENED in counts


def confirms_times(figures: OdometryFigures | None) -> bool:
    """Whether an IMU, as it was recorded, fits the LiDARs over the whole walk."""
    if figures is None or not figures.imu or figures.lines is not None or figures.lost:
        return False
    choice = figures.imu_choice.outcome if figures.imu_choice else "as recorded"
    return choice in ("as recorded", "bias removed") and not figures.imu_faults


def _of_derived_times(found: Finding) -> Finding:
    """A clock against times that are derived: one cannot say which of them is wrong."""
    return replace(found, level=Level.NOTE, values=found.values | {"derived": True})


class Saturation(Witness):
    """An IMU at the end of its range."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each axis that repeats its largest value."""
        for axis in saturated_axes(walk.imu) if walk.imu is not None else ():
            yield _saturated(walk, axis)


class Gravity(Witness):
    """Gravity as the accelerometer measures it over the walk."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Whether it is what it should be, if the accelerometer was used."""
        figures = walk.odometry_figures
        if figures is None or walk.imu is None or walk.odometry is None or walk.rig is None:
            return
        choice = figures.imu_choice.outcome if figures.imu_choice else "as recorded"
        if not figures.imu or choice == "accelerometer not used" or figures.lines is not None:
            return
        found = wrong_gravity(walk.odometry, walk.imu, walk.rig)
        if found is None:
            return
        of_a_bias = abs(found - STANDARD_GRAVITY_M_S2) <= IMU_WITNESS.of_a_bias_m_s2
        percent = 100.0 * (found / STANDARD_GRAVITY_M_S2 - 1.0)
        values = {
            "found_m_s2": found,
            "gravity_m_s2": STANDARD_GRAVITY_M_S2,
            "percent": percent,
        }
        yield finding(FindingKind.IMU_GRAVITY, Level.NOTE if of_a_bias else Level.CHECK, values)


class UpsideDown(Witness):
    """A body that stands on its head by the accelerometer."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """A note, as LiDARs are mounted so, too; to check if tracking was lost besides."""
        figures = walk.odometry_figures
        if figures is None or walk.imu is None or walk.rig is None or figures.lines is not None:
            return
        force = imu_in_body(walk.imu, walk.rig)[1].mean(axis=0)
        angle_rad = float(np.arctan2(np.hypot(force[0], force[1]), force[2]))
        if angle_rad > IMU_WITNESS.upside_down_rad:  # NaN: no accelerometer
            lost = bool(np.any(walk.steps.get("lost", False)))
            found = finding(
                FindingKind.IMU_UPSIDE_DOWN,
                Level.CHECK if lost else Level.NOTE,
                {"angle_rad": angle_rad},
            )
            yield replace(found, sensor="IMU")


class Rides(Witness):
    """Vertical motions that only the IMU measured."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Rides that no LiDAR sees, and other contradictions of the heights."""
        for doubt in walk.odometry_figures.heights if walk.odometry_figures else ():
            yield ride_finding(doubt)


def ride_finding(doubt: HeightDoubt) -> Finding:
    """A contradiction of heights; files of earlier versions do not state its pattern."""
    contradiction = doubt.largest_m_s2 is not None
    half = doubt.speed_m_s is not None
    severe = half or abs(doubt.rise_m) >= IMU_WITNESS.storey_m
    values: dict[str, Value] = {
        "rise_m": abs(doubt.rise_m),
        "way": "up" if doubt.rise_m > 0 else "down",
    }
    if contradiction:
        values |= {"stated": True, "largest_m_s2": doubt.largest_m_s2 or 0.0}
        values |= {"usual_m_s2": doubt.usual_m_s2 or 0.0}
    else:
        values |= {"half": half, "whole": not half, "speed_m_s": doubt.speed_m_s or 0.0}
    return finding(
        FindingKind.HEIGHT_CONTRADICTED if contradiction else FindingKind.UNSEEN_RIDE,
        Level.DO_NOT_USE if severe else Level.CHECK,
        values,
        span_s=(doubt.start_s, doubt.end_s),
    )


def fault_finding(fault: ImuFault, *, corrected: bool) -> Finding:
    """An error of an IMU; ``corrected`` by the odometry, or as a rig's audit found it."""
    found = finding(_FAULTS[fault.kind, corrected], Level.CHECK, _fault_values(fault))
    return replace(found, direction=fault.axis, sensor="IMU")


_FAULTS = {
    ("gyroscope scale", True): FindingKind.IMU_GYRO_SCALE,
    ("gyroscope rotation", True): FindingKind.IMU_GYRO_ROTATION,
    ("clock", True): FindingKind.IMU_CLOCK,
    ("left-handed", False): FindingKind.IMU_LEFT_HANDED,
    ("foreign", False): FindingKind.IMU_FOREIGN,
    ("gyroscope unit", False): FindingKind.IMU_UNIT,
    ("accelerometer unit", False): FindingKind.IMU_UNIT,
    ("gyroscope scale", False): FindingKind.IMU_SCALE,
    ("accelerometer scale", False): FindingKind.IMU_SCALE,
}


def _fault_values(fault: ImuFault) -> dict[str, Value]:
    value, sd = fault.value, fault.sd or 0.0
    match fault.kind:
        case "gyroscope rotation":
            return {"angle_rad": value, "sd_rad": sd}
        case "clock":
            way = "ahead" if value > 0.0 else "behind"
            return {"size_ms": 1e3 * abs(value), "sd_ms": 1e3 * sd, "way": way}
        case "foreign":
            return {"explained": value}
        case "gyroscope unit":
            return {"fault": "gyroscope_deg" if value > 1.0 else "gyroscope_small"}
        case "accelerometer unit":
            return {"fault": "accelerometer_g"}
        case "accelerometer scale":
            found_m_s2 = (1.0 + value) * STANDARD_GRAVITY_M_S2
            return {
                "accelerometer": True,
                "found_m_s2": found_m_s2,
                "gravity_m_s2": STANDARD_GRAVITY_M_S2,
                "percent": 100.0 * value,
            }
    way = "large" if value > 0.0 else "small"
    percent = 100.0 * value
    return {"gyroscope": True, "size": abs(value), "sd": sd, "way": way, "percent": percent}


def _choice(choice: ImuChoice) -> Finding:
    values: dict[str, Value] = {}
    if choice.bias_rad_s is not None:
        values |= dict(zip(("x_rad_s", "y_rad_s", "z_rad_s"), choice.bias_rad_s, strict=True))
    if choice.with_m is not None and choice.without_m is not None:
        values |= {"with_m": choice.with_m, "without_m": choice.without_m}
    found = finding(_OUTCOMES[choice.outcome], Level.CHECK, values)
    return replace(found, sensor="IMU")


def _saturated(walk: WalkRecord, axis: SaturatedAxis) -> Finding:
    t_ns = walk.imu.t_ns if walk.imu is not None else np.zeros(1, np.int64)
    is_gyroscope = axis.sensor == "gyroscope"
    largest = np.rad2deg(axis.largest) if is_gyroscope else axis.largest
    found = finding(
        FindingKind.IMU_SATURATED,
        Level.CHECK,
        {
            "first_s": 1e-9 * float(t_ns[axis.runs[0][0]] - t_ns[0]),
            "largest": f"{largest:.0f}" if is_gyroscope else f"{largest:.1f}",
            "unit": "deg_s" if is_gyroscope else "m_s2",
            "times": len(axis.runs),
        },
    )
    return replace(found, direction=axis.axis, sensor=axis.sensor)
