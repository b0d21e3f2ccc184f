"""When tracking is lost: limits that follow the sensor, gaps, and maps that begin again."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.registration import scan_chain
from recon4.registration.lost import LostLimits
from recon4.registration.odometry import Odometry
from recon4.registration.plane_map import Match
from recon4.registration.result import StopReason
from recon4.registration.scan_registration import search_scans
from recon4.registration.tuning import OdometryTuning, ScanTuning
from recon4.settings import OdometrySettings, Settings
from tests.scanned_room import strolling, walk, without_points


@pytest.fixture(scope="module")
def stroll():
    return walk(strolling, 24)


def match_of(ratio, mean_m=0.01):
    residual_m = np.zeros(1000)
    return Match(np.zeros((12, 12)), np.zeros(12), residual_m, round(1000 * ratio), mean_m, 0.0)


def limits(*ratios):
    found = LostLimits(OdometrySettings())
    for ratio in ratios:
        found.learn(ratio)
    return found


def test_a_sensor_that_matches_little_is_lost_later():
    sparse, dense = limits(*[0.25] * 20), limits(*[0.9] * 20)

    assert not sparse.is_lost(match_of(0.2), sure=False)
    assert dense.is_lost(match_of(0.2), sure=False)
    assert sparse.is_lost(match_of(0.09), sure=False)


def test_before_anything_is_usual_the_scan_before_decides():
    first = limits()

    assert first.is_lost(match_of(0.25), sure=False)
    assert not first.is_lost(match_of(0.25), sure=True)
    assert first.is_lost(match_of(0.25, mean_m=0.2), sure=True)


def test_a_frame_lies_on_the_map_if_it_matches_as_usual():
    found = limits(*[0.8] * 20)

    assert found.is_usual(match_of(0.65))
    assert not found.is_usual(match_of(0.6))
    assert not found.is_usual(match_of(0.8, mean_m=0.2))
    assert not limits(*[0.8] * 5).is_usual(match_of(0.8))


FEW = range(14, 18)


@pytest.mark.parametrize(("share", "lost"), [(0.6, False), (0.2, True)])
def test_a_scan_too_sparse_for_the_last_one_lies_on_the_map_but_a_new_view_does_not(
    stroll, monkeypatch, share, lost
):
    calls = iter(range(1, 1000))

    def few(*args, **kwargs):
        found = search_scans(*args, **kwargs)
        if next(calls) not in FEW:
            return found
        return replace(found, stop=StopReason.TOO_FEW, match_ratio=share * found.match_ratio)

    monkeypatch.setattr(scan_chain, "search_scans", few)
    odometry = Odometry(stroll.rig, Settings(), None)
    steps = [odometry.push(frame) for frame in stroll]

    assert any(step.lost for step in steps) is lost
    off = stroll.true_poses()[-1].t - stroll.true_poses()[5].t
    assert np.linalg.norm(steps[-1].T_odom_body.t - steps[5].T_odom_body.t - off) < 0.03


def paused(stroll, gap_s):
    """The same way with a break after twelve multiframes in which the body stood."""
    gap_ns = round(gap_s * 1e9)
    return [
        frame if k < 12 else replace(frame, t_ns=frame.t_ns + gap_ns)
        for k, frame in enumerate(stroll)
    ]


def test_a_gap_that_an_imu_does_not_cover_begins_a_new_piece_at_the_last_pose(stroll):
    frames, imu = paused(stroll, 3.0), stroll.imu
    late = imu.t_ns > frames[11].t_ns + frames[11].duration_ns
    imu = replace(imu, t_ns=np.where(late, imu.t_ns + 3_000_000_000, imu.t_ns))
    odometry = Odometry(stroll.rig, Settings(), imu)

    steps = [odometry.push(frame) for frame in frames]

    assert [step.piece for step in steps] == [0] * 12 + [1] * 12
    assert not any(step.lost for step in steps)
    jump_m = np.linalg.norm(steps[12].T_odom_body.t - steps[11].T_odom_body.t)
    assert jump_m < 0.1  # with the speed before the gap it would be 1.5 m


def test_without_an_imu_a_sure_scan_carries_the_walk_across_a_gap(stroll):
    odometry = Odometry(stroll.rig, Settings())

    steps = [odometry.push(frame) for frame in paused(stroll, 3.0)[:16]]

    assert not any(step.lost or step.piece for step in steps)
    assert [step.bridged for step in steps] == [k == 12 for k in range(16)]
    truth = stroll.true_poses()
    moved = steps[11].T_odom_body.inverse() @ steps[15].T_odom_body
    true = truth[11].inverse() @ truth[15]
    assert np.linalg.norm(moved.t - true.t) < 0.03
    sd_m = [np.sqrt(step.motion_cov[3, 3]) for step in steps[11:14]]
    assert sd_m[1] > 0.1 > 10 * max(sd_m[0], sd_m[2])


def test_without_an_imu_a_long_gap_begins_a_new_piece(stroll):
    """In that time the body may be on a storey that looks the same."""
    odometry = Odometry(stroll.rig, Settings())

    steps = [odometry.push(frame) for frame in paused(stroll, 11.0)[9:15]]

    assert [step.piece for step in steps] == [0, 0, 0, 1, 1, 1]
    assert not any(step.lost or step.bridged for step in steps)


def test_without_an_imu_sure_scans_begin_a_new_piece_after_tracking_was_lost(stroll):
    settings = Settings(odometry=OdometryTuning(scans=ScanTuning(sure_scans=3), lost_error_m=1e-9))
    odometry = Odometry(stroll.rig, settings)

    steps = [odometry.push(frame) for frame in list(stroll)[:8]]

    # The second is lost; it and three that fit each other end the loss.
    assert [step.lost for step in steps] == [False, True, True, True, True, False, True, True]
    assert [step.piece for step in steps] == [0, 0, 0, 0, 0, 1, 1, 1]


def test_empty_scans_are_never_sure(stroll):
    settings = Settings(odometry=OdometryTuning(scans=ScanTuning(sure_scans=3)))
    frames = [frame if k < 4 else without_points(frame) for k, frame in enumerate(stroll)]
    odometry = Odometry(stroll.rig, settings)

    steps = [odometry.push(frame) for frame in frames[:14]]

    assert all(step.piece == 0 for step in steps)
    assert all(step.lost for step in steps[4:])
