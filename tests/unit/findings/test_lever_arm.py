"""What the audit says of the lever arm of an IMU."""

import numpy as np
import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.lever_arm import LeverArm
from recon4.findings.wording import whole_text
from recon4.model.finding import Level
from recon4.model.odometry_figures import ImuChoice, OdometryFigures
from tests.unit.registration.test_imu_lever_arm import P_BODY_IMU, claimed, walked

FREE = ImuChoice(outcome="accelerometer not used")


def found(p_claimed, choice=None):
    trajectory, imu = walked(0.002)
    figures = OdometryFigures(multiframes=200, lost=0, imu=True, imu_choice=choice)
    steps = {"t_mid_ns": trajectory.t_ns[20:-20:40]}
    return list(
        LeverArm().check(
            WalkRecord(
                odometry=trajectory,
                odometry_figures=figures,
                steps=steps,
                imu=imu,
                rig=claimed(p_claimed),
            )
        )
    )


@pytest.mark.parametrize(("choice", "least"), [(None, True), (FREE, False)])
def test_a_wrong_lever_arm_is_named_with_size_and_direction(choice, least):
    (one,) = found(P_BODY_IMU + np.array([1.0, 0.0, 0.0]), choice)

    assert (one.level, one.sensor, one.direction) == (Level.NOTE, "IMU", "−x")
    assert one.values["length_m"] == pytest.approx(1.0, abs=0.1)
    assert ("may be more" in whole_text(one)) is least


def test_a_right_lever_arm_is_not_named():
    assert not found(P_BODY_IMU, FREE)
