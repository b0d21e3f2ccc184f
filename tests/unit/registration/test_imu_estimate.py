"""What the odometry finds out about an IMU."""

import re

import numpy as np
import pytest

from recon4.findings.witnesses.imu import fault_finding
from recon4.geometry.se3 import so3_exp
from recon4.model.samples import ImuSamples
from recon4.registration.imu_estimate import ImuEstimate
from recon4.registration.odometry import Odometry
from recon4.settings import Settings
from tests.said import texts
from tests.tuned import with_tuning

SD, SETTINGS = 2e-4, Settings()


def said(found):
    """Its faults in words."""
    return texts(fault_finding(fault, corrected=True) for fault in found.faults)


def estimate(gain=None, *, clock_s=0.0, sd=SD):
    matrix = np.zeros((3, 3)) if gain is None else gain
    return ImuEstimate(np.ravel(matrix), sd**2 * np.eye(9), clock_s, 1e-4)


@pytest.fixture
def walked(office_frames):
    """An office walk with a wrong IMU -> what is found of it, and the steps."""

    def run(scale=1.0, late_ns=0, settings=SETTINGS, known=None):
        imu = office_frames.imu
        wrong = ImuSamples(imu.t_ns + late_ns, scale * imu.gyro_rad_s, imu.accel_m_s2)
        odometry = Odometry(office_frames.rig, settings, wrong)
        if known is not None:
            odometry.remember_imu(known)
        steps = [odometry.push(frame) for frame in office_frames]
        states.append(odometry.imu_state)
        return ImuEstimate.of(odometry.imu_state), steps

    states = []
    run.states = states
    return run


def test_an_imu_in_order_is_nothing_to_speak_of(walked):
    found, _ = walked()

    assert found.faults == ()
    assert abs(found.clock_s) < 1e-3
    assert np.abs(found.gain[::4]).max() < 0.01


def test_a_wrong_scale_is_measured_and_named(walked):
    found, _ = walked(scale=1.03)

    assert found.gain[8] == pytest.approx(1.0 / 1.03 - 1.0, abs=2e-3)
    (text,) = said(found)
    assert re.match(r"The gyroscope measures turns about z (2\.[89]|3\.[0-2]) % ± ", text)
    assert "too large" in text


@pytest.mark.parametrize(("late_ns", "words"), [(20_000_000, "ahead of"), (-10_000_000, "behind")])
def test_a_wrong_clock_is_measured_and_named(walked, late_ns, words):
    found, _ = walked(late_ns=late_ns)

    assert found.clock_s == pytest.approx(1e-9 * late_ns, abs=5e-4)
    assert f"{words} that of the LiDARs" in " ".join(said(found))


@pytest.mark.parametrize("late_ns", [100_000_000, -100_000_000])
def test_a_clock_far_off_is_found_by_the_second_walk(walked, late_ns):
    walked(late_ns=late_ns)

    found, _ = walked(late_ns=late_ns, known=walked.states[-1])

    assert found.clock_s == pytest.approx(1e-9 * late_ns, abs=3e-3)


def test_a_walk_confirms_what_differs_by_less_than_a_fault():
    known = estimate(clock_s=0.060)

    assert estimate(clock_s=0.063).confirms(known)
    assert not estimate(clock_s=0.065).confirms(known)
    assert not estimate(np.diag([0.0, 0.02, 0.0]), clock_s=0.060).confirms(known)
    assert not estimate(so3_exp(np.array([0.0, 0.013, 0.0])) - np.eye(3), clock_s=0.06).confirms(
        known
    )


@pytest.mark.study
def test_without_the_estimate_a_wrong_scale_turns_the_walk(walked):
    fixed = with_tuning(SETTINGS, "odometry.gyro_gain_sd=0", "odometry.imu_clock_sd_s=0")
    _, right = walked()
    _, corrected = walked(scale=1.03)
    found, wrong = walked(scale=1.03, settings=fixed)

    def turned_rad(steps):
        between = steps[0].T_odom_body.inverse() @ steps[-1].T_odom_body
        truth = right[0].T_odom_body.inverse() @ right[-1].T_odom_body
        return float((truth.inverse() @ between).angle())

    assert found.faults == ()
    assert turned_rad(corrected) < 0.2 * turned_rad(wrong)


def test_a_rotated_gyroscope_is_named_with_its_angle():
    (text,) = said(estimate(so3_exp([0.02, 0.0, 0.02]) - np.eye(3)))

    assert "rotated by 1.6°" in text


def test_what_is_not_significant_is_not_said():
    assert estimate(0.03 * np.eye(3), sd=0.01).faults == ()
    assert estimate(so3_exp([0.03, 0.0, 0.0]) - np.eye(3), sd=0.01).faults == ()
    assert estimate(clock_s=0.003).faults == ()


def test_without_an_imu_there_is_no_estimate(office_frames):
    odometry = Odometry(office_frames.rig, SETTINGS, None)
    odometry.push(office_frames[0])

    assert odometry.imu_state is None
