"""What the IMU's readings say of its axes, units and clock by themselves."""

import re
from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.start import find_start
from recon4.calibration.window import cut_window
from recon4.findings.witnesses.imu import fault_finding
from recon4.geometry.se3 import so3_log
from recon4.registration.gyro_alignment import align_gyro
from tests.room_walks import T0_NS
from tests.said import texts
from tests.unit.calibration.conftest import SETTINGS, dancing

FASTER = 4
EXCHANGED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])


def start_of(dance, **change):
    imu = replace(dance.imu, **change)
    walk = RecordedWalk(replace(dance, imu=imu), dance.truth, *np.zeros((2, len(dance)), bool))
    return find_start(walk, reference=0, settings=SETTINGS)


def said(start):
    """What is wrong with the IMU, in words."""
    return texts(fault_finding(fault, corrected=False) for fault in start.faults)


def test_a_right_imu_is_left_where_it_is(dance):
    start = start_of(dance)

    assert start.faults == ()
    assert start.imu_usable
    assert start.rig.imu_time_offset_s == 0.0
    np.testing.assert_array_equal(start.rig.T_body_imu.R, np.eye(3))


def test_exchanged_axes_and_a_late_clock_are_found(dance):
    start = start_of(
        dance,
        gyro_rad_s=dance.imu.gyro_rad_s @ EXCHANGED.T,
        accel_m_s2=dance.imu.accel_m_s2 @ EXCHANGED.T,
        t_ns=dance.imu.t_ns + 150_000_000,
    )

    off = np.rad2deg(np.linalg.norm(so3_log(start.rig.T_body_imu.R @ EXCHANGED)))
    assert off < 1.0
    assert start.rig.imu_time_offset_s == pytest.approx(-0.15, abs=2e-3)


def test_an_axis_with_the_wrong_sign_makes_it_left_handed(dance):
    start = start_of(dance, gyro_rad_s=dance.imu.gyro_rad_s * [1.0, -1.0, 1.0])

    assert not start.imu_usable
    assert "left-handed" in said(start)[0]


@pytest.mark.parametrize(
    ("factor", "words"),
    [(1.03, r"\+3\.0 % off"), (np.rad2deg(1.0), "°/s"), (np.deg2rad(1.0), "too little")],
)
def test_a_wrong_scale_of_the_gyroscope_is_named(dance, factor, words):
    start = start_of(dance, gyro_rad_s=factor * dance.imu.gyro_rad_s)

    assert any(re.search(words, text) for text in said(start)), said(start)
    assert not start.imu_usable


@pytest.mark.parametrize(
    ("factor", "words"),
    [(1 / 9.80665, "seems to be g"), (1.08, "its scale is +7."), (0.92, "its scale is -8.")],
)
def test_a_wrong_unit_of_the_accelerometer_is_named(dance, factor, words):
    start = start_of(dance, accel_m_s2=factor * dance.imu.accel_m_s2)

    assert any(words in text for text in said(start)), said(start)


@pytest.mark.study
def test_an_imu_of_another_recording_explains_nothing(dance):
    rng = np.random.default_rng(1)
    noise = rng.standard_normal(dance.imu.gyro_rad_s.shape)
    start = start_of(dance, gyro_rad_s=np.cumsum(noise, axis=0) * 0.02)

    assert not start.imu_usable
    assert "explains only" in said(start)[0]


def test_lidars_that_lost_tracking_accuse_no_imu(dance):
    rng = np.random.default_rng(1)
    imu = replace(dance.imu, gyro_rad_s=rng.standard_normal(dance.imu.gyro_rad_s.shape))
    everywhere = np.ones(len(dance), bool)  # an open field, of which hardly a shot returns
    walk = RecordedWalk(replace(dance, imu=imu), dance.truth, everywhere, everywhere)

    start = find_start(walk, reference=0, settings=SETTINGS)

    assert start.faults == () and not start.imu_usable


def test_the_clock_is_found_between_the_steps_of_the_search(dance):
    imu = replace(dance.imu, t_ns=dance.imu.t_ns + 33_300_000)
    found = align_gyro(dance.truth, dance.t_mid_ns, imu)

    assert found.clock_s == pytest.approx(-0.0333, abs=5e-4)
    assert found.explained > 0.999


def test_too_few_samples_align_nothing(dance):
    assert align_gyro(dance.truth, dance.t_mid_ns[:5], dance.imu) is None


def test_the_walk_of_these_tests_turns_about_all_axes():
    t = np.linspace(0, 12, 1000)
    turned = so3_log(dancing(t).R)

    assert np.all(np.ptp(turned, axis=0) > 0.3)


def test_turns_that_a_saturated_gyroscope_misses_do_not_make_its_scale_wrong(dance):
    truth = replace(dance.truth, t_ns=faster(dance.truth.t_ns))
    gyro = FASTER * dance.imu.gyro_rad_s
    limit = 0.7 * np.abs(gyro).max()
    imu = replace(dance.imu, t_ns=faster(dance.imu.t_ns), gyro_rad_s=np.clip(gyro, -limit, limit))

    found = align_gyro(truth, faster(dance.t_mid_ns), imu)

    assert limit > 1.5 and np.mean(np.abs(gyro).max(axis=1) > limit) > 0.03
    assert found.scale == pytest.approx(1.0, abs=0.005)


def faster(t_ns):
    """The same motion in a quarter of the time."""
    return T0_NS + (t_ns - T0_NS) // FASTER


def test_a_window_with_a_saturated_sensor_has_no_imu(dance):
    gyro = dance.imu.gyro_rad_s.copy()
    from_ns = int(dance.t_mid_ns[60])
    gyro[(dance.imu.t_ns > from_ns) & (dance.imu.t_ns < from_ns + 200_000_000), 2] = 4.0
    frames = replace(dance, imu=replace(dance.imu, gyro_rad_s=gyro))

    early, late = (cut_window(frames, dance.truth, rows) for rows in (range(40), range(40, 80)))

    assert early.imu is not None
    assert late.imu is None
