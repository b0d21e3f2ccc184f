"""Units of an IMU, recognized by content."""

import numpy as np
import pytest

from recon4.geometry.se3 import so3_exp
from recon4.model.samples import ImuSamples
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_imu
from tests.warned import K, derivations, kinds, warned, words

RATE_HZ = 100
GRAVITY = np.array([0.0, 0.0, 9.81])


def swaying(fastest_rad_s, axis=(0.6, 0.8, 0.0), *, seconds=20.0):
    """A body that sways about an axis, its rates and what its accelerometer feels."""
    t_s = np.arange(0.0, seconds, 1.0 / RATE_HZ)
    turns = fastest_rad_s / np.pi * np.sin(np.pi * t_s)
    rng = np.random.default_rng(1)
    gyro = np.outer(fastest_rad_s * np.cos(np.pi * t_s), axis)
    accel = np.einsum("nji,j->ni", so3_exp(np.outer(turns, axis)), GRAVITY)
    noise = [rng.normal(scale=sd, size=gyro.shape) for sd in (0.002 * fastest_rad_s, 0.3)]
    return ImuSamples(np.rint(1e9 * t_s).astype(np.int64), gyro + noise[0], accel + noise[1])


def cleaned(imu, **options):
    report = ImportReport()
    return clean_imu(imu, offset_s=0.0, jumps_ns=[], report=report, **options), report


def in_degrees(imu):
    return ImuSamples(imu.t_ns, np.rad2deg(imu.gyro_rad_s), imu.accel_m_s2)


@pytest.mark.parametrize("fastest_deg_s", [5.0, 30.0, 300.0])
def test_rates_in_degrees_are_recognized_converted_and_said(fastest_deg_s):
    imu = swaying(np.deg2rad(fastest_deg_s))

    found, report = cleaned(in_degrees(imu))

    np.testing.assert_allclose(found.gyro_rad_s, imu.gyro_rad_s)
    assert report.counts["imu_gyro_scaled"] == len(imu)
    assert "are in deg/s, stored in rad/s" in derivations(report)[0]
    assert report.findings == []


@pytest.mark.parametrize("fastest_rad_s", [0.05, 1.0, 5.0, 15.0])
def test_rates_in_radians_are_left_and_not_accused(fastest_rad_s):
    imu = swaying(fastest_rad_s)

    found, report = cleaned(imu)

    np.testing.assert_array_equal(found.gyro_rad_s, imu.gyro_rad_s)
    assert (report.findings, derivations(report)) == ([], [])


def test_where_nothing_decides_the_unit_is_assumed_and_counted():
    found, report = cleaned(swaying(6.0, axis=(0.0, 0.0, 1.0)))

    assert report.counts["imu_gyro_assumed"] == len(found)
    assert "taken as rad/s" in derivations(report)[0] and not report.findings
    assert float(np.abs(found.gyro_rad_s).max()) > 5.0


@pytest.mark.parametrize("unit", ["rad_s", "deg_s"])
def test_the_setting_counts(unit):
    imu = swaying(40.0, axis=(0.0, 0.0, 1.0))

    found, report = cleaned(imu, gyro_unit=unit)

    scale = 1.0 if unit == "rad_s" else np.deg2rad(1.0)
    np.testing.assert_allclose(found.gyro_rad_s, scale * imu.gyro_rad_s)
    assert report.findings == []


def test_rates_in_no_known_unit_are_not_used_and_the_map_goes_on():
    found, report = cleaned(swaying(30_000.0, axis=(0.0, 0.0, 1.0)))

    assert found is None
    assert kinds(report) == [K.GYROSCOPE_UNIT]


@pytest.mark.parametrize(("unit", "scale"), [("g", 1 / 9.80665), ("mg", 1e3 / 9.80665)])
def test_accelerations_in_other_units_are_converted_and_said(unit, scale):
    imu = swaying(1.0)

    found, report = cleaned(ImuSamples(imu.t_ns, imu.gyro_rad_s, scale * imu.accel_m_s2))

    np.testing.assert_allclose(found.accel_m_s2, imu.accel_m_s2)
    assert report.counts["imu_accel_scaled"] == len(imu)
    assert f"was in {unit} " in derivations(report)[0]


def test_accelerations_without_a_gyroscope_are_said_not_to_level():
    imu = swaying(1.0)

    found, report = cleaned(ImuSamples(imu.t_ns, np.zeros_like(imu.gyro_rad_s), imu.accel_m_s2))

    assert found is None
    assert warned(report, K.GYROSCOPE_MISSING, why="zero", forces=True)
    assert "Its accelerations alone are not used either" in words(report)
