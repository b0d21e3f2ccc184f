"""Multiframes are mapped when the IMU samples of their time are there."""

import numpy as np

from recon4.live.mapper.follower import frame_end_ns
from recon4.live.mapper.imu_synchronization import ImuSynchronization
from recon4.model.multiframe import COLUMNS, Multiframe

TENTH_NS = 100_000_000


def frame(k):
    columns = {
        name: np.zeros((0, width) if width > 1 else 0, dtype)
        for name, (dtype, width) in COLUMNS.items()
    }
    return Multiframe(k, k * TENTH_NS, TENTH_NS, **columns)


def ids(frames):
    return [one.frame_id for one in frames]


def test_without_an_imu_nothing_waits():
    synchronization = ImuSynchronization(frame_end_ns)

    assert [ids(synchronization.push(frame(k))) for k in range(3)] == [[0], [1], [2]]


def test_a_frame_waits_for_the_samples_of_its_end():
    synchronization = ImuSynchronization(frame_end_ns)
    synchronization.imu_until(0)

    early = ids(synchronization.push(frame(0))), ids(synchronization.imu_until(TENTH_NS // 2))

    assert early == ([], [])
    assert ids(synchronization.imu_until(TENTH_NS - 5_000_000)) == [0]


def test_samples_that_are_there_already_delay_nothing():
    synchronization = ImuSynchronization(frame_end_ns)
    synchronization.imu_until(3 * TENTH_NS)

    assert [ids(synchronization.push(frame(k))) for k in range(4)] == [[0], [1], [2], []]


def test_an_imu_that_falls_silent_is_waited_for_three_frames():
    synchronization = ImuSynchronization(frame_end_ns)
    synchronization.imu_until(0)

    ready = [ids(synchronization.push(frame(k))) for k in range(6)]

    assert ready == [[], [], [], [0], [1], [2]]
    assert ids(synchronization.flush()) == [3, 4, 5]
    assert synchronization.flush() == []
