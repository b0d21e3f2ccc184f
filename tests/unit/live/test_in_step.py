"""Multiframes are mapped when the IMU has told of their time."""

import numpy as np

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
    in_step = ImuSynchronization()

    assert [ids(in_step.came(frame(k))) for k in range(3)] == [[0], [1], [2]]


def test_a_frame_waits_for_the_samples_of_its_end():
    in_step = ImuSynchronization()
    in_step.heard(0)

    early = ids(in_step.came(frame(0))), ids(in_step.heard(TENTH_NS // 2))

    assert early == ([], [])
    assert ids(in_step.heard(TENTH_NS - 5_000_000)) == [0]


def test_samples_that_are_there_already_hold_nothing_up():
    in_step = ImuSynchronization()
    in_step.heard(3 * TENTH_NS)

    assert [ids(in_step.came(frame(k))) for k in range(4)] == [[0], [1], [2], []]


def test_an_imu_that_falls_silent_is_waited_for_three_frames():
    in_step = ImuSynchronization()
    in_step.heard(0)

    came = [ids(in_step.came(frame(k))) for k in range(6)]

    assert came == [[], [], [], [0], [1], [2]]
    assert ids(in_step.rest()) == [3, 4, 5]
    assert in_step.rest() == []
