"""A mount of the profiler that the rig file does not know is found by the sharpness of the map."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.profiler.clock_audit import some_points
from recon4.profiler.mount_audit import mount_change
from recon4.profiler.samples import TimedPoints
from recon4.profiler.stage_odometry import run_line_odometry
from recon4.progress import Silent
from tests.said import line_texts


@pytest.fixture(scope="module")
def points(frames):
    return some_points(frames, min_range_m=1.5)


@pytest.fixture(scope="module")
def origin_m(frames):
    return frames.rig.sensors[frames.rig.row_of("profiler")].T_body_sensor.t


def mounted(points, origin_m, *, turn_deg=(0.0, 0.0, 0.0), shift_m=(0.0, 0.0)):
    """The points as a rig file places them that lacks this turn and shift."""
    p = points.p_body - origin_m - [*shift_m, 0.0]
    return TimedPoints(points.t_ns, p @ so3_exp(np.deg2rad(turn_deg)) + origin_m)


def test_the_mount_of_the_rig_file_is_left_alone(points, origin_m, truth):
    found = mount_change(points, origin_m, truth)

    assert found is None or not found.is_wrong


@pytest.mark.parametrize("turn_deg", [(1.5, 0.0, 0.0), (0.0, -1.25, 0.0), (0.5, 1.0, -0.75)])
@pytest.mark.study
def test_a_turned_profiler_is_found(points, origin_m, truth, turn_deg):
    found = mount_change(mounted(points, origin_m, turn_deg=turn_deg), origin_m, truth)

    assert found.is_wrong
    # In these few points a turn about the vertical hardly differs from a shift.
    np.testing.assert_allclose(np.rad2deg(found.turn_rad[:2]), turn_deg[:2], atol=0.4)
    assert np.linalg.norm(np.rad2deg(found.turn_rad) - turn_deg) < np.linalg.norm(turn_deg) / 2.0


def test_a_shifted_profiler_is_found(points, origin_m, truth):
    found = mount_change(mounted(points, origin_m, shift_m=(0.0, -0.08)), origin_m, truth)

    assert found.is_wrong
    assert found.shift_m[1] == pytest.approx(-0.08, abs=0.03)


def test_a_wrong_rig_file_is_said_with_the_change(frames, settings, tmp_path):
    row = frames.rig.row_of("profiler")
    sensors = list(frames.rig.sensors)
    T = sensors[row].T_body_sensor
    wrong = SE3(so3_exp(np.deg2rad([-1.5, 0.0, 0.0])) @ T.R, T.t)
    sensors[row] = replace(sensors[row], T_body_sensor=wrong)
    store = replace(frames, rig=replace(frames.rig, sensors=tuple(sensors)))

    found = run_line_odometry(store, tmp_path, settings=settings, progress=Silent())

    (text,) = line_texts(found)
    assert "mounted otherwise than the rig file says: +1.5° about x" in text
