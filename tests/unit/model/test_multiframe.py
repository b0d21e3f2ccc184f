"""The columns of a multiframe stay consistent in selections."""

import numpy as np

from recon4.model.multiframe import COLUMNS, Multiframe


def two_sensors() -> Multiframe:
    return Multiframe(
        frame_id=7,
        t_ns=1_000_000_000,
        duration_ns=100_000_000,
        xyz=np.arange(12, dtype=np.float32).reshape(4, 3),
        intensity=np.array([10, 20, 30, 40], dtype=np.uint16),
        ring=np.array([0, 1, 0, 1], dtype=np.uint8),
        sensor=np.array([0, 0, 1, 1], dtype=np.uint8),
        echo=np.zeros(4, dtype=np.uint8),
        dt_ns=np.array([0, 50, 0, 50], dtype=np.int32),
    )


def test_its_pose_refers_to_the_middle():
    assert two_sensors().t_mid_ns == 1_050_000_000


def test_the_points_of_one_sensor_keep_their_columns():
    second = two_sensors().of_sensor(1)

    assert len(second) == 2
    assert second.intensity.tolist() == [30, 40]
    assert second.xyz.tolist() == [[6.0, 7.0, 8.0], [9.0, 10.0, 11.0]]
    assert (second.frame_id, second.t_ns) == (7, 1_000_000_000)


def test_a_sensor_that_is_not_there_has_no_points():
    assert len(two_sensors().of_sensor(2)) == 0


def test_every_declared_column_is_a_field_of_the_declared_type():
    frame = two_sensors()

    for name, (dtype, width) in COLUMNS.items():
        column = getattr(frame, name)
        assert column.dtype == np.dtype(dtype)
        assert column.size == len(frame) * width
