"""Inertial packets of Ouster sensors: both profiles, axes, times."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.recording.formats.datagrams import NO_DATAGRAMS
from recon4.recording.packets.family import Companion
from recon4.recording.packets.ouster.encode import encode_imu, metadata_json
from recon4.recording.packets.ouster.family import FAMILY as OUSTER
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from tests.ouster_models import nominal_metadata
from tests.unit.recording.ouster_packets import companion, datagrams_of, of_port, opened

T0_NS = 5_000_000_000


def samples_of(datagrams, *companions, report=None, **fields):
    """Inertial samples on the clock of the sensor, and the report."""
    report = report or ImportReport()
    packets = opened(NO_DATAGRAMS, *companions, report=report, **fields)
    clock = SensorClock("os", packet_s=0.0016, report=report)
    clock.past_hour = False
    return packets.samples(datagrams, clock), report


def metadata_of(R_sensor_imu=None):
    metadata = nominal_metadata("OS1-32")
    if R_sensor_imu is not None:
        metadata = replace(metadata, R_sensor_imu=R_sensor_imu)
    return Companion("os.json", metadata_json(metadata))


def arrived(payloads, t_ns, port=7503):
    """Datagrams that arrive half a millisecond after they were measured."""
    return datagrams_of(payloads, port=port, t_ns=np.asarray(t_ns) + 500_000)


def test_samples_are_turned_into_the_frame_of_the_points():
    R_sensor_imu = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    t_ns = T0_NS + 10_000_000 * np.arange(3)
    payloads = encode_imu(t_ns, np.tile([1.0, 2, 9], (3, 1)), np.tile([0.1, 0.2, 0.3], (3, 1)))

    found, report = samples_of(arrived(payloads, t_ns), metadata_of(R_sensor_imu))

    np.testing.assert_allclose(found.imu.accel_m_s2, np.tile([-2.0, 1, 9], (3, 1)), atol=1e-5)
    np.testing.assert_allclose(found.imu.gyro_rad_s, np.tile([-0.2, 0.1, 0.3], (3, 1)), atol=1e-6)
    np.testing.assert_array_equal(np.diff(found.imu.t_ns), 10_000_000)
    assert report.counts["imu_samples"] == 3


def test_acceleration_is_interpolated_to_the_time_of_the_gyroscope():
    t_ns = T0_NS + 10_000_000 * np.arange(5)
    accel = np.column_stack([np.arange(5.0), np.zeros(5), np.full(5, 9.8)])
    payloads = encode_imu(t_ns, accel, np.zeros((5, 3)))
    payloads[:, 16:24] = (t_ns + 2_500_000).astype("<u8")[:, None].view(np.uint8)

    found, _ = samples_of(arrived(payloads, t_ns), metadata_of())

    np.testing.assert_allclose(found.imu.accel_m_s2[:, 0], [0.25, 1.25, 2.25, 3.25, 4], atol=1e-5)


def test_packets_of_the_new_profile_are_read(data):
    folder = data("packets/ouster")
    head = of_port(folder / "imu_zm_no_lidar.pcap", 7513)

    found, report = samples_of(head, companion(folder / "imu_zm_no_lidar_0.json"))

    imu = found.imu
    assert (len(imu), report.counts["samples_damaged"]) == (64, 0)
    assert np.median(np.diff(imu.t_ns)) == pytest.approx(1.5625e6, rel=0.02)
    first = np.frombuffer(bytes.fromhex("0c22c43d8919933ef9851c41"), "<f4")
    np.testing.assert_array_equal(imu.accel_m_s2[0], first.astype(np.float64))
    assert np.linalg.norm(imu.accel_m_s2.mean(axis=0)) == pytest.approx(9.81, abs=0.1)
    assert np.abs(imu.gyro_rad_s).max() < 0.05
    assert OUSTER.recognize(head, ()).kind == "samples"


def test_damaged_and_repeated_packets_are_counted():
    t_ns = T0_NS + 10_000_000 * np.arange(6)
    payloads = encode_imu(t_ns, np.tile([0.0, 0, 9.8], (6, 1)), np.zeros((6, 3)))
    payloads[1, 24:28] = 255  # not a number
    payloads[2, 8:16] = 255  # a time of its own
    payloads[4] = payloads[3]

    found, report = samples_of(arrived(payloads, t_ns), metadata_of())

    assert len(found.imu) == 3
    assert report.counts["samples_damaged"] == 2
    assert report.counts["imu_copies"] == 1 and report.counts["samples_out_of_order"] == 0
    assert report.counts["sample_datagrams"] == 6


def test_packets_to_the_port_of_another_sensor_are_left_alone():
    t_ns = T0_NS + 10_000_000 * np.arange(4)
    payloads = encode_imu(t_ns, np.tile([0.0, 0, 9.8], (4, 1)), np.zeros((4, 3)))
    mine = arrived(payloads, t_ns)
    mine.port[1::2] = 7603
    elsewhere = arrived(payloads, t_ns, port=9000)

    assert len(samples_of(mine, metadata_of())[0].imu) == 2
    assert len(samples_of(elsewhere, metadata_of())[0].imu) == 4


def test_of_two_serial_numbers_only_its_own_samples_are_of_a_sensor(data):
    folder = data("packets/ouster")
    head = of_port(folder / "imu_zm_no_lidar.pcap", 7513)
    payloads = head.payloads(np.arange(len(head)), 452)
    payloads[::2, 7:12] = 9
    both = datagrams_of(payloads, port=7513, t_ns=head.t_ns)

    found, report = samples_of(both, companion(folder / "imu_zm_no_lidar_0.json"))

    assert len(found.imu) == 32
    assert report.counts["samples_out_of_order"] == 0
