"""Scans of a 2-D laser: angles, returns and their times."""

from __future__ import annotations

import numpy as np
import pytest

from recon4.model.laser_scans import LaserScans


@pytest.fixture
def scans() -> LaserScans:
    return LaserScans(
        t_ns=np.array([0, 100_000_000], np.int64),
        range_m=np.array([[1.0, np.nan, 2.0], [3.0, 3.0, 3.0]], np.float32),
        angle_min_rad=-np.pi / 2,
        angle_step_rad=np.pi / 2,
        range_max_m=30.0,
        time_step_s=0.001,
        odometry=np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.5]]),
    )


def test_a_return_lies_in_the_direction_of_its_beam(scans: LaserScans) -> None:
    np.testing.assert_allclose(scans.points(0), [[0.0, -1.0], [0.0, 2.0]], atol=1e-12)
    np.testing.assert_allclose(scans.points(1), [[0.0, -3.0], [3.0, 0.0], [0.0, 3.0]], atol=1e-12)


def test_a_beam_without_return_keeps_the_times_of_the_others(scans: LaserScans) -> None:
    np.testing.assert_allclose(scans.beam_offsets_s(0), [0.0, 0.002])


def test_selected_scans_keep_their_odometry(scans: LaserScans) -> None:
    second = scans[1:]
    assert len(second) == 1
    assert second.odometry is not None
    np.testing.assert_array_equal(second.odometry, [[1.0, 2.0, 0.5]])
    np.testing.assert_array_equal(second.range_m, [[3.0, 3.0, 3.0]])


def test_times_must_increase(scans: LaserScans) -> None:
    with pytest.raises(AssertionError):
        scans[np.array([1, 0])]
