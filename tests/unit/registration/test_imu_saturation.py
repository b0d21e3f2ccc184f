"""An IMU at the end of its range is named: its scale only looks wrong."""

from dataclasses import replace

import numpy as np

from recon4.findings.walk_record import WalkRecord
from recon4.model.finding_kinds import FindingKind
from recon4.model.samples import ImuSamples
from tests.said import found_in, texts


def saturated_texts(imu):
    """What is said of an IMU alone."""
    found = found_in(WalkRecord(imu=imu))
    return texts(one for one in found if one.kind is FindingKind.IMU_SATURATED)


def samples(*, gyro_range_deg_s=1e4, accel_range_m_s2=1e4):
    """30 s of a walk with turns of up to 300°/s about z and shaking of 20 m/s² along y."""
    rng = np.random.default_rng(2)
    t_s = np.arange(0.0, 30.0, 0.005)
    gyro = 0.05 * rng.standard_normal((len(t_s), 3))
    gyro[:, 2] += np.deg2rad(300.0) * np.sin(0.5 * t_s)
    accel = 0.2 * rng.standard_normal((len(t_s), 3)) + np.array([0.0, 0.0, 9.81])
    accel[:, 1] += 20.0 * np.sin(11.0 * t_s)
    limit = np.deg2rad(gyro_range_deg_s)
    return ImuSamples(
        t_ns=np.rint(1e9 * t_s).astype(np.int64),
        gyro_rad_s=np.clip(gyro, -limit, limit),
        accel_m_s2=np.clip(accel, -accel_range_m_s2, accel_range_m_s2),
    )


def test_a_gyroscope_at_the_end_of_its_range_is_named_with_axis_and_place():
    (text,) = saturated_texts(samples(gyro_range_deg_s=250.0))

    assert "The gyroscope is saturated, first 2.0 s" in text
    assert "250°/s about z, 5 times" in text and "about x" not in text


def test_so_is_an_accelerometer():
    (text,) = saturated_texts(samples(accel_range_m_s2=19.6))

    assert "The accelerometer is saturated" in text
    assert "19.6 m/s² along y" in text


def test_an_imu_within_its_range_is_not():
    assert saturated_texts(samples()) == []


def held(imu, times=6):
    """The samples as packets have them that come more often: each again until the next one."""
    t_ns = imu.t_ns[0] + np.arange(times * len(imu)) * (5_000_000 // times)
    gyro, accel = (np.repeat(one, times, axis=0) for one in (imu.gyro_rad_s, imu.accel_m_s2))
    return ImuSamples(t_ns=t_ns, gyro_rad_s=gyro, accel_m_s2=accel)


def test_samples_that_packets_repeat_do_not_saturate_an_imu():
    assert saturated_texts(held(samples())) == []
    (text,) = saturated_texts(held(samples(gyro_range_deg_s=250.0)))
    assert "250°/s about z, 5 times" in text


def test_coarse_steps_at_the_peak_of_a_turn_do_not_saturate_a_gyroscope():
    """A JT128 counts in 0.14°/s."""
    step, t_s = np.deg2rad(0.14), np.arange(0.0, 20.0, 0.005)
    gyro = np.zeros((len(t_s), 3))
    gyro[:, 2] = step * np.rint(np.deg2rad(142.7) / step * np.exp(-((t_s - 10.0) ** 2)))
    accel = 0.1 * np.random.default_rng(1).standard_normal((len(t_s), 3))
    imu = ImuSamples(np.rint(1e9 * t_s).astype(np.int64), gyro, accel)

    assert saturated_texts(imu) == []


def test_the_peak_of_a_fast_turn_does_not_saturate_a_gyroscope_of_fine_steps():
    """Five samples of a forest walk are within 0.01 % of the largest, and none is the same."""
    peak_deg_s = [
        241.6885, 241.8979, 241.9998, 242.1521, 242.5889, 242.6084, 242.6118, 242.5363,
        242.6078, 242.6044, 242.4400, 242.3328, 242.3007, 242.1657, 241.8517, 241.7034,
    ]  # fmt: skip
    imu = samples(gyro_range_deg_s=200.0)
    gyro = 0.5 * imu.gyro_rad_s
    gyro[1000:1016, 2] = np.deg2rad(peak_deg_s)

    assert saturated_texts(replace(imu, gyro_rad_s=gyro)) == []


def test_neither_is_one_that_stands_or_has_no_samples():
    still = np.zeros((200, 3))
    t_ns = np.arange(200) * 5_000_000
    gravity = still + np.array([0.0, 0.0, 9.81])
    assert saturated_texts(ImuSamples(t_ns=t_ns, gyro_rad_s=still, accel_m_s2=gravity)) == []
    nothing = np.empty((0, 3))
    none = ImuSamples(t_ns=np.empty(0, np.int64), gyro_rad_s=nothing, accel_m_s2=nothing)
    assert saturated_texts(none) == []
