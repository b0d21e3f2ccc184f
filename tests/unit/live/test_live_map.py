"""A walk through the live map: followed, lost, and found again."""

from itertools import pairwise

import numpy as np
import pytest
from msgspec import structs

from recon4.geometry.se3 import so3_exp
from recon4.live.mapper import live_imu, tracker
from recon4.live.mapper.live_map import LiveMap
from recon4.live.mapper.tuning import LIVE_TRACKER
from recon4.live.protocol import RecentFrames
from recon4.settings import preset
from tests.live_walk import Follower, simulated_walk

FOLLOWED = (20, 40, 60, 76, 100, 130)
"""How many multiframes tests follow before what they are about."""


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    return simulated_walk(tmp_path_factory.mktemp("office"))


@pytest.fixture(scope="module")
def followed(walk):
    """``followed(60)`` has been pushed the first 60 multiframes, which is done once for all."""
    follower, copies = Follower(walk), {}

    def after(rows):
        for earlier, later in pairwise((0, *FOLLOWED)):
            if later <= rows and later not in copies:
                for row in range(earlier, later):
                    follower.push(row)
                copies[later] = follower.copy()
        return copies[rows].copy()

    return after


@pytest.mark.study
def test_who_is_lost_is_found_again_at_an_earlier_place(walk):
    """Without an IMU, so that nothing contradicts the jump back.

    All six places of the map are tried, one every five multiframes, before one is accepted.
    """
    follower = Follower(walk, with_imu=False)
    errors = [follower.push(row)[1] for row in range(80)]
    points_before = follower.map.snapshot().messages()[1].count
    for row in range(80, 86):
        pose, _ = follower.push(row, noise=True)
    points_lost = follower.map.snapshot().messages()[1].count
    back = walk.store[86].t_ns - walk.store[20].t_ns + 1_500_000_000
    message = [follower.push(row, back) for row in range(20, 80)]

    assert max(errors) < 0.15
    assert pose.lost
    assert points_lost == points_before
    found = [error for pose, error in message if not pose.lost]
    assert message[-1][0].relocated == 1
    assert len(found) > 5
    assert max(found) < 0.15


@pytest.mark.study
def test_noise_before_the_lidars_accuses_no_imu(walk, monkeypatch):
    """The IMU is checked by the last twelve multiframes, half of which are noise."""
    monkeypatch.setattr(
        tracker, "LIVE_TRACKER", structs.replace(LIVE_TRACKER, tried_frames=12, bad_frames=7)
    )
    follower = Follower(walk)
    for row in range(8):
        follower.push(row)
    for row in range(8, 14):
        follower.push(row, noise=True)
    message = [follower.push(row)[0] for row in range(14, 18)]

    assert all(pose.imu and not pose.remark for pose in message)


def test_an_imu_upside_down_is_said_and_used_once_the_lidars_have_shown_its_axes(walk):
    follower = Follower(walk, imu_axes=[1.0, -1.0, -1.0])

    message = [follower.push(row) for row in range(60)]

    (before, _), (after, _) = message[0], message[-1]
    assert (before.imu, before.remark, before.imu_turn) == (False, "not-upright", None)
    assert (after.imu, after.remark, after.imu_turn.rpy_deg) == (True, "", (180.0, 0.0, 0.0))
    assert not any(pose.lost for pose, _ in message)
    assert max(error for _, error in message) < 0.05


def test_an_imu_whose_x_axis_points_30_degrees_to_the_left_is_found_out_by_who_walks(walk):
    """Its gravity is right, and the walk loses no multiframe before it bends away."""
    follower = Follower(walk)
    follower.mount = so3_exp([0.0, 0.0, np.pi / 6])

    message = [follower.push(row)[0] for row in range(100)]

    begun = next(k for k, pose in enumerate(message) if pose.imu_turn)
    assert all(pose.imu and not pose.remark for pose in message)
    assert message[-1].imu_turn.rpy_deg[2] == pytest.approx(30.0, abs=2.0)
    assert follower.map.snapshot().messages()[1].generation == 1
    assert shape_error_m(walk, message, range(begun, 100)) < 0.05


def shape_error_m(walk, message, rows):
    """How far the distances from the first of some places are from the true ones."""
    p_m = np.array([message[row].p for row in rows])
    truth_m = np.array([walk.at(row).t for row in rows])
    far, true = (np.linalg.norm(p[1:] - p[0], axis=1) for p in (p_m, truth_m))
    return float(np.abs(far - true).max())


@pytest.mark.study
def test_a_gyroscope_that_turns_the_wrong_way_is_repaired_and_the_map_begins_anew(walk):
    follower = Follower(walk, gyro_axes=[1.0, 1.0, -1.0])

    message = [follower.push(row)[0] for row in range(110)]

    begun = next(k for k, pose in enumerate(message) if pose.imu_axes)
    assert (message[-1].imu_axes.gyro, message[-1].imu_axes.accel) == ("x, y, -z", "x, y, z")
    assert not any(pose.lost for pose in message[begun:])
    assert follower.map.snapshot().messages()[1].generation == 1
    assert shape_error_m(walk, message, range(begun, 110)) < 0.05


def test_nobody_asks_for_the_axes_of_an_imu_that_is_right(walk, monkeypatch):
    asked = []
    monkeypatch.setattr(live_imu, "Odometry", lambda *args: asked.append(args))
    follower = Follower(walk)

    message = [follower.push(row)[0] for row in range(100)]

    assert not asked
    assert all(pose.imu and not pose.remark and not pose.imu_turn for pose in message)


@pytest.mark.study
def test_accelerations_of_zero_are_said_and_mapping_goes_on_with_the_gyroscope(walk):
    follower = Follower(walk, imu_axes=[0.0, 0.0, 0.0], gyro_axes=[1.0, 1.0, 1.0])

    message = [follower.push(row) for row in range(60)]

    assert all(pose.imu and not pose.lost for pose, _ in message)
    assert message[0][0].remark == "no-accelerometer zero"
    assert max(error for _, error in message) < 0.15


@pytest.mark.study
def test_accelerations_that_fail_on_the_way_do_not_end_the_map(followed):
    follower = followed(20)
    follower.axes[1] = 0.0

    message = [follower.push(row) for row in range(20, 60)]

    assert not any(pose.lost for pose, _ in message)
    assert max(error for _, error in message) < 0.15


@pytest.mark.parametrize(
    ("rate", "said"),
    [(0.0, "zero"), (0.03, "constant")],
)
@pytest.mark.study
def test_a_gyroscope_whose_values_never_change_is_found_out_and_said(walk, rate, said):
    follower = Follower(walk, gyro_axes=[0.0, 0.0, 0.0])
    follower.rate = np.array([rate, -rate, rate])

    message = [follower.push(row)[0] for row in range(25)]

    assert message[0].imu and not message[-1].imu
    assert message[-1].remark == f"no-gyroscope {said}"


@pytest.mark.study
def test_a_long_path_keeps_its_start(walk):
    live_map = LiveMap(walk.store.rig, preset("indoor"))

    for k in range(30_000):
        live_map._path.extend(np.array([0.1 * k, 0.0, 0.0]))

    path = live_map.snapshot().messages()[0].points
    assert path[0] == [0.0, 0.0, 0.0]
    assert 9_000 < len(path) < 12_001


def test_how_far_a_prediction_was_off_can_be_read_for_three_seconds(walk):
    live_map = LiveMap(walk.store.rig, preset("indoor"))

    shown = [live_map._largest_offset_m(k * 100_000_000, 0.4 if k == 5 else 0.0) for k in range(50)]

    assert shown == [0.0] * 5 + [0.4] * 31 + [0.0] * 14


def test_what_is_left_out_is_counted_for_ten_seconds(walk):
    follower = Follower(walk)
    for row in range(0, 10, 2):
        follower.push(row)
        follower.map.thin(walk.frame(row + 1))
    pose, _ = follower.push(10)
    later, _ = follower.push(11, 10_000_000_000)

    assert (pose.thinned, pose.lately) == (5, RecentFrames(11, 5))
    assert (later.thinned, later.lately.thinned) == (5, 0)


@pytest.mark.study
def test_after_a_pause_the_walk_goes_on_where_it_stopped(followed):
    follower = followed(100)
    later = [follower.push(row, 60_000_000_000) for row in range(100, 130)]

    assert later[0][0].lost
    assert not any(pose.lost for pose, _ in later[20:])
    assert max(error for pose, error in later if not pose.lost) < 0.1


def test_a_pause_during_a_turn_is_not_mistaken_for_a_place_that_looks_alike(followed):
    """The corridor looks the same from its other end; the next view is through another door."""
    follower = followed(76)
    later = [follower.push(row, 60_000_000_000) for row in range(76, 110)]

    assert later[0][0].lost and not later[-1][0].lost
    assert max(error for pose, error in later if not pose.lost) < 0.1


@pytest.mark.study
def test_who_was_carried_elsewhere_in_a_pause_is_found_before_anything_is_drawn(walk, followed):
    follower = followed(130)
    back = walk.store[130].t_ns - walk.store[60].t_ns + 60_000_000_000
    later = [follower.push(row, back) for row in range(60, 142)]

    found = [error for pose, error in later if not pose.lost]
    assert len(found) > 10
    assert max(found) < 0.1


def test_lidars_that_are_silent_for_three_seconds_lose_nobody_who_has_an_imu(walk, followed):
    follower = followed(60)
    for row in range(60, 90):
        follower.map.extend_imu(walk.imu(row))
    later = [follower.push(row) for row in range(90, 100)]

    assert not later[-1][0].lost
    assert later[-1][0].relocated == 0
    assert later[-1][1] < 0.1


def test_a_few_bad_multiframes_are_no_reason_to_search(followed):
    follower = followed(40)
    lost = [follower.push(row, noise=True)[0].lost for row in range(40, 43)]
    pose, error_m = [follower.push(row) for row in range(43, 60)][-1]

    assert lost == [True] * 3
    assert not pose.lost
    assert pose.relocated == 0
    assert error_m < 0.05
