"""Scans of a 2-D laser: angles, returns and their times."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from recon4.model.laser_scans import LaserScans, joined_scans


@pytest.fixture
def scans() -> LaserScans:
    """Three scans of three, two and one beams."""
    return LaserScans(
        t_ns=np.array([0, 100_000_000, 200_000_000], np.int64),
        range_m=np.array([1.0, np.nan, 2.0, 3.0, 4.0, 5.0], np.float32),
        start=np.array([0, 3, 5, 6]),
        angle_min_rad=np.array([-np.pi / 2, np.pi / 2, 0.0]),
        angle_step_rad=np.array([np.pi / 2, -np.pi / 2, 0.1]),
        range_max_m=30.0,
        time_step_s=np.array([0.001, 0.002, 0.0]),
        odometry=np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.5], [2.0, 2.0, 0.5]]),
    )


def test_a_return_lies_in_the_direction_of_its_beam(scans: LaserScans) -> None:
    np.testing.assert_allclose(scans.points(0), [[0.0, -1.0], [0.0, 2.0]], atol=1e-12)
    np.testing.assert_allclose(scans.points(1), [[0.0, 3.0], [4.0, 0.0]], atol=1e-12)


def test_a_scan_takes_as_long_as_its_beams(scans: LaserScans) -> None:
    np.testing.assert_allclose(scans.duration_s, [0.003, 0.004, 0.0])


def test_selected_scans_keep_their_beams_and_odometry(scans: LaserScans) -> None:
    for rows in (slice(1, 2), np.array([1]), np.array([False, True, False])):
        second = scans[rows]
        assert len(second) == 1
        assert second.odometry is not None
        np.testing.assert_array_equal(second.odometry, [[1.0, 2.0, 0.5]])
        np.testing.assert_array_equal(second.range_m, [3.0, 4.0])
        np.testing.assert_array_equal(second.angles_rad(0), scans.angles_rad(1))


def test_parts_joined_again_are_the_whole(scans: LaserScans) -> None:
    whole = joined_scans([scans[:1], scans[1:]])
    for field in fields(LaserScans):
        np.testing.assert_array_equal(getattr(whole, field.name), getattr(scans, field.name))
    apart = scans[np.array([0, 2])]
    np.testing.assert_array_equal(apart.range_m, [1.0, np.nan, 2.0, 5.0])
    assert scans[:0].start.tolist() == [0]


def test_a_layout_that_changes_is_described_by_its_limits(scans: LaserScans) -> None:
    assert scans.layout == "scans of 1 to 3 beams over 90°"
    assert scans[:1].layout == "scans of 3 beams over 180°"


def test_times_must_increase(scans: LaserScans) -> None:
    with pytest.raises(AssertionError):
        scans[np.array([1, 0])]
