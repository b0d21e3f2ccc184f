"""The clock of an IMU: what the odometry corrects, and what its audit says of the rig file."""

from dataclasses import replace

import pytest

from recon4.findings.audit import check_walk
from recon4.findings.verdict import verdict_of
from recon4.findings.walk_record import WalkRecord
from recon4.model.calibration_figures import CalibrationFigures, ParameterFigures
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import ImuFault, OdometryFigures
from recon4.model.usability import Usability


def found_in(walked):
    return check_walk(walked)


def clock_of_imu(ahead_s, *, corrected_s=None):
    """An IMU whose clock is ahead, and how much of it the odometry found and corrected."""
    value = ahead_s if corrected_s is None else corrected_s
    faults = (ImuFault(kind="clock", value=value, sd=1e-4),) if value else ()
    figures = OdometryFigures(multiframes=9, lost=0, imu=True, imu_faults=faults)
    off = ParameterFigures(
        sensor="imu", quantity="clock", axis="", unit="s", change=-ahead_s, sd=1e-4, status="off"
    )
    audit = CalibrationFigures(parameters=(off,))
    return WalkRecord(odometry_figures=figures, calibration=audit)


@pytest.mark.parametrize(
    ("corrected_s", "levels"),
    [
        (0.0201, {FindingKind.IMU_CLOCK: Level.CHECK, FindingKind.RIG_CONTRADICTED: Level.NOTE}),
        (0.012, {FindingKind.IMU_CLOCK: Level.CHECK, FindingKind.RIG_CONTRADICTED: Level.CHECK}),
        (-0.02, {FindingKind.IMU_CLOCK: Level.CHECK, FindingKind.RIG_CONTRADICTED: "do not use"}),
        (0.0, {FindingKind.RIG_CONTRADICTED: Level.DO_NOT_USE}),
    ],
    ids=["all of it", "half of it", "the other way", "nothing"],
)
def test_a_clock_that_the_odometry_corrected_is_named_once(corrected_s, levels):
    found = found_in(clock_of_imu(0.02, corrected_s=corrected_s))

    assert {one.kind: one.level for one in found if one.kind in levels} == levels


@pytest.mark.parametrize(
    ("counts", "usability"),
    [
        ({}, Usability.CHECK),
        ({"clouds_untimed": 40}, Usability.GOOD),
        ({"clouds_evened": 40}, Usability.GOOD),
    ],
    ids=["times of points", "times that are derived", "stamps that scatter"],
)
def test_a_clock_is_not_accused_by_times_that_nothing_states(counts, usability):
    walked = replace(clock_of_imu(0.05), imported={"counts": counts})

    found = [
        one for one in found_in(walked)
        if one.kind in {FindingKind.IMU_CLOCK, FindingKind.RIG_CONTRADICTED}
    ]  # fmt: skip

    assert len(found) == 2
    assert verdict_of(found).usability is usability
