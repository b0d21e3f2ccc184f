"""Axes that the driver of an IMU exchanges: what it must publish."""

import pytest

from recon4.findings.audit import check_walk
from recon4.findings.walk_record import WalkRecord
from recon4.findings.wording import remedy_of, text_of
from recon4.model.finding import Level
from recon4.model.odometry_figures import ImuAxes, OdometryFigures


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_axes_that_a_driver_must_publish_are_stated(language):
    axes = ImuAxes(gyro="-x, -y, -z", accel="y, x, z")
    figures = OdometryFigures(multiframes=9, lost=0, imu=True, imu_axes=axes)

    (found,) = check_walk(WalkRecord(odometry_figures=figures))

    assert (found.kind, found.level) == ("IMU-AXES", Level.CHECK)
    for said in (text_of(found, language), remedy_of(found, language)):
        assert "(-x, -y, -z)" in said and "(y, x, z)" in said
