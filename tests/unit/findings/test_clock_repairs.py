"""Clocks that were set: a note where an IMU fits the LiDARs over the whole walk."""

import msgspec
import pytest
from msgspec.structs import replace

from recon4.findings.audit import check_walk
from recon4.findings.walk_record import WalkRecord
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import ImuChoice, ImuFault, OdometryFigures
from recon4.recording.report import warning

AGREES = OdometryFigures(multiframes=80, lost=0, imu=True)


def level_of(repaired, figures):
    imported = {"findings": [msgspec.to_builtins(repaired)]}
    found = check_walk(WalkRecord(imported=imported, odometry_figures=figures))
    (level,) = [one.level for one in found if one.kind is repaired.kind]
    return level


BACK = warning(FindingKind.CLOCK_BACK, sensor="walk", start_s=3.9, end_s=3.9, seconds=0.08)


def jumped(sensor):
    values = {"whose": "sensor", "jump_s": -0.08, "times": "without-it"}
    return warning(FindingKind.CLOCK_JUMP, sensor=sensor, **values)


@pytest.mark.parametrize("repaired", [BACK, jumped("lidar"), jumped("IMU")])
def test_a_repaired_clock_is_a_note_where_an_imu_fits_the_lidars(repaired):
    assert level_of(repaired, AGREES) is Level.NOTE


@pytest.mark.parametrize(
    "figures",
    [
        None,
        replace(AGREES, imu=False),
        replace(AGREES, lost=1),
        replace(AGREES, imu_choice=ImuChoice(outcome="not used")),
        replace(AGREES, imu_choice=ImuChoice(outcome="accelerometer not used")),
        replace(AGREES, imu_faults=(ImuFault(kind="clock", value=0.0089, sd=2e-4),)),
    ],
    ids=["unknown", "no IMU", "lost", "IMU not used", "no forces", "its clock is off"],
)
def test_a_repaired_clock_is_to_check_where_nothing_confirms_it(figures):
    assert level_of(BACK, figures) is Level.CHECK


GAP = warning(FindingKind.TIME_GAP, sensor="lidar", start_s=1.0, end_s=2.0, seconds=1.0)


@pytest.mark.parametrize("other", [GAP, jumped("GNSS")])
def test_an_imu_says_nothing_of_gaps_and_of_fixes(other):
    assert level_of(other, AGREES) is Level.CHECK
