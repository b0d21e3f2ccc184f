"""The live map of a 2-D laser: the odometry of `recon4 process`, loops, and what is missing."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se2 import between
from recon4.live.mapper.live_attitude import LiveAttitude
from recon4.live.mapper.scan_map import ScanMap
from recon4.live.mapper.scan_tracker import ScanTracker
from recon4.live.mapper.tuning import SCAN_MAP
from recon4.live.preview.coverage import CoverageClass
from recon4.live.protocol import Gaps, Loop, Path, Plan, Points
from recon4.model.rig import parse_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.slam2d.odometry import run_odometry_2d
from recon4.slam2d.tuning import Slam2dTuning
from tests.laser_rows import rows_of, with_rows, with_times
from tests.planar_walks import (
    along,
    blank_corridor,
    full_turns,
    furnished_room,
    interlaced,
    mirrored,
    ring_corridor,
    ring_walk,
    scanned,
    scanned_in,
    without,
)

LASER = parse_rig('[[sensor]]\nname = "laser2d"\nkind = "laser2d"', where="test")


def rows(scans):
    return [scans[slice(k, k + 1)] for k in range(len(scans))]


def mapped(scans, rig=LASER, *, imu=None):
    """The map, all poses, and all further messages."""
    live = ScanMap(rig, Settings())
    poses, messages = [], []
    for k, scan in enumerate(rows(scans)):
        if imu is not None:
            live.extend_imu(imu(k))
        pose, more = live.push(scan)
        poses.append(pose)
        messages += more
    return live, poses, messages


def planar(poses):
    return np.array([[*pose.p[:2], pose.yaw] for pose in poses])


@pytest.fixture(scope="module")
def room():
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0], [0.0, 1.0]])
    return scanned(furnished_room(), along(corners))


@pytest.fixture(scope="module")
def ring():
    walk = scanned(ring_corridor(), ring_walk(1.3), odometry=False)
    return walk, *mapped(walk.scans)


@pytest.mark.parametrize("odometry", [True, False])
def test_the_poses_are_those_of_the_finished_recording(room, odometry):
    scans = room.scans if odometry else replace(room.scans, odometry=None)
    scans = with_times(scans, 1e-4)
    steps = run_odometry_2d(scans, attitude=None, settings=Slam2dTuning(), progress=Silent())
    tracker, attitude = ScanTracker(LASER.sensors[0], Slam2dTuning()), LiveAttitude(LASER)

    found = [tracker.push(scan, attitude) for scan in rows(scans)]

    np.testing.assert_array_equal([step.pose for step in found], steps.pose)
    np.testing.assert_array_equal([step.keyframe for step in found], steps.keyframe)
    np.testing.assert_array_equal([step.weak_sd_m for step in found], steps.weak_sd_m)


@pytest.mark.study
def test_a_walk_around_a_block_closes_the_loop_and_stays_true(ring):
    walk, live, poses, messages = ring

    error_m, error_rad = walk.errors(planar(poses))
    loops = [message for message in messages if isinstance(message, Loop)]

    assert loops[-1].closed
    path_m = np.hypot(*np.diff(walk.truth[:, :2], axis=0).T).sum()
    assert loops[-1].walked_m == pytest.approx(path_m, abs=1.0)
    assert not any(loop.closed for loop in loops[: len(loops) // 2])
    assert error_m.max() < 0.1
    assert error_rad.max() < 0.02
    assert not any(pose.lost for pose in poses)
    assert len(live.snapshot().path) > 200


def test_the_plan_has_the_walls_and_the_free_floor(ring):
    _, live, _, messages = ring
    plan = [message for message in messages if isinstance(message, Plan)][-1]
    first, seen = live._coverage.seen()

    def cell(x, y):
        i, j = (np.floor(np.array([x, y]) / 0.25).astype(int) - first).tolist()
        return seen[i, j]

    start = np.array([-1.0, -1.0])  # the map begins at the first pose, without rotation of its axes
    yaw = ring_walk(1.3)[0, 2]
    R = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    free = [cell(*(R @ (np.array(p) - start))) for p in ((6.0, -1.2), (13.0, 6.0), (-1.2, 9.0))]
    block = cell(*(R @ (np.array([6.0, 6.0]) - start)))

    assert plan.shape == list(seen.shape)
    assert set(free) == {CoverageClass.FREE}
    assert block == CoverageClass.NOTHING
    assert np.count_nonzero(seen == CoverageClass.WELL) > 300
    assert any(isinstance(message, Points) and message.count for message in messages)
    gaps = [message for message in messages if isinstance(message, Gaps)]
    assert gaps[-1].well > 0.9


def test_a_drift_is_corrected_and_the_plan_is_drawn_again(ring):
    """The map is bent by hand until the loop closes: then it bends back."""
    walk = ring[0]
    live = ScanMap(LASER, Settings())
    messages = []
    for scan in rows(walk.scans):
        if not live._loop.closed:
            live._T_map_odom = live._T_map_odom + np.array([6e-4, 4e-4, 0.0])
        pose, more = live.push(scan)
        messages += more

    paths = [message for message in messages if isinstance(message, Path)]
    off = between(between(walk.truth[0], walk.truth[-1]), np.array([*pose.p[:2], pose.yaw]))
    walls = {len(one._coverage.seen()[1].nonzero()[0]) for one in (live, ring[1])}

    assert paths
    assert len(paths[0].points) > 150
    assert live._loop.closed
    assert np.hypot(*off[:2]) < 0.15
    assert max(walls) < 1.1 * min(walls)


def test_the_plan_is_drawn_again_at_most_every_ten_seconds(room, monkeypatch):
    live = ScanMap(LASER, Settings())
    drawn = []
    monkeypatch.setattr(live, "_redraw", lambda: drawn.append(live._summary_ns) or [])
    for scan in rows(room.scans):
        live._stale = True
        live.push(scan)

    assert len(drawn) >= 2
    assert np.diff(drawn).min() >= SCAN_MAP.redraw_every_ns


@pytest.mark.parametrize("with_imu", [False, True])
@pytest.mark.study
def test_a_laser_upside_down_gives_the_poses_of_an_upright_one(room, with_imu):
    hanging = parse_rig(
        '[[sensor]]\nname = "laser2d"\nkind = "laser2d"\nrpy_deg = [180.0, 0.0, 0.0]',
        where="test",
    )
    scans = replace(room.scans, odometry=None)
    start_ns = int(scans.t_ns[0])
    imu = (lambda k: still(k, start_ns=start_ns)) if with_imu else None

    _, upright, _ = mapped(scans, imu=imu)
    _, poses, _ = mapped(mirrored(scans), hanging, imu=imu)

    off = between(planar(upright), planar(poses))
    assert np.abs(off).max() < 0.01
    assert all(pose.imu == with_imu for pose in poses[1:])


def test_a_corridor_without_doors_is_said_to_hold_nothing_along_it():
    truth = np.stack([np.linspace(0.0, 12.0, 120), np.zeros(120), np.zeros(120)], axis=1)
    walk = scanned(blank_corridor(), truth, odometry=False)

    _, poses, _ = mapped(walk.scans)

    assert {pose.unobserved for pose in poses[5:]} == {"along"}
    assert all(pose.weak_sd_m > 0.1 for pose in poses[5:])


def test_a_furnished_room_is_observed_in_all_directions(room):
    _, poses, _ = mapped(room.scans)

    assert {pose.unobserved for pose in poses} == {""}


def test_a_laser_that_was_silent_goes_on_in_the_same_map(room):
    scans = without(replace(room.scans, odometry=None), 3.0, 5.0)

    _, poses, _ = mapped(scans)
    t_s = (room.scans.t_ns - room.scans.t_ns[0]) / 1e9
    kept = (t_s < 3.0) | (t_s > 5.0)
    truth = room.truth[kept]
    off = between(between(truth[0], truth), planar(poses))

    assert not poses[-1].lost
    assert np.hypot(off[-1, 0], off[-1, 1]) < 0.1


@pytest.mark.parametrize("layout", [full_turns, interlaced])
def test_scans_whose_angles_change_are_mapped_live_as_when_finished(layout):
    truth = along(np.array([[-2.5, 0.5], [0.5, 0.2]]), speed_m_s=0.4)
    scans = with_times(scanned_in(furnished_room(), truth, layout(len(truth))).scans, 1e-4)
    steps = run_odometry_2d(scans, attitude=None, settings=Slam2dTuning(), progress=Silent())
    tracker, attitude = ScanTracker(LASER.sensors[0], Slam2dTuning()), LiveAttitude(LASER)

    found = [tracker.push(scan, attitude) for scan in rows(scans)]

    np.testing.assert_array_equal([step.pose for step in found], steps.pose)
    assert not steps.lost.any()


def test_a_blind_laser_is_lost_and_adds_nothing(room):
    half = len(room.scans) // 2
    ranges = rows_of(room.scans).copy()
    ranges[half:] = np.nan
    scans = replace(with_rows(room.scans, ranges), odometry=None)

    live, poses, _ = mapped(scans)

    assert all(pose.lost for pose in poses[half:])
    assert poses[-1].lost_frames == len(poses) - half
    assert live.snapshot().path == mapped(scans[slice(0, half)])[0].snapshot().path


def test_scans_left_out_are_counted(room):
    live = ScanMap(LASER, Settings())
    for k, scan in enumerate(rows(room.scans[slice(0, 30)])):
        if k % 3 == 2:
            live.thin(scan)
        else:
            pose, _ = live.push(scan)

    assert pose.thinned == 9
    assert (pose.lately.frames, pose.lately.thinned) == (29, 9)


def test_memory_does_not_grow_with_the_number_of_scans(room):
    tracker, attitude = ScanTracker(LASER.sensors[0], Slam2dTuning()), LiveAttitude(LASER)
    for scan in rows(room.scans):
        tracker.push(scan, attitude)

    assert len(tracker._scans) < 10


# -- with an IMU


def still(k, *, gyro=(0.0, 0.0, 0.0), accel=(0.0, 0.0, 9.81), start_ns=0):
    """Samples of the tenth of a second around scan ``k``."""
    t_ns = start_ns + 100_000_000 * k + 5_000_000 * np.arange(-10, 30, dtype=np.int64)
    ones = np.ones((len(t_ns), 1))
    return ImuSamples(t_ns, ones * np.array(gyro), ones * np.array(accel))


def test_an_imu_levels_a_tilted_laser(room):
    """The body pitches by 20 degrees: without leveling the ranges are too long."""
    start_ns = int(room.scans.t_ns[0])
    tilt = np.deg2rad(20.0)
    accel = (-9.81 * np.sin(tilt), 0.0, 9.81 * np.cos(tilt))

    _, poses, _ = mapped(room.scans, imu=lambda k: still(k, accel=accel, start_ns=start_ns))

    assert all(pose.imu for pose in poses[1:])
    attitude = LiveAttitude(LASER)
    attitude.extend(still(0, accel=accel))
    forward = attitude.trajectory().T_a_b.R[0] @ np.array([1.0, 0.0, 0.0])
    assert forward[2] == pytest.approx(-np.sin(tilt), abs=1e-6)


def test_the_gyroscope_turns_the_attitude():
    attitude = LiveAttitude(LASER)
    for k in range(20):
        attitude.extend(still(k, gyro=(0.0, 0.0, 0.5)))

    R = attitude.trajectory().T_a_b.R
    seconds = float(attitude.trajectory().t_ns[-1] - attitude.trajectory().t_ns[0]) * 1e-9

    assert np.arctan2(R[-1, 1, 0], R[-1, 0, 0]) == pytest.approx(0.5 * seconds, abs=1e-3)


def test_an_imu_with_a_hole_does_not_cover_it():
    attitude = LiveAttitude(LASER)
    attitude.extend(still(0))
    attitude.extend(still(20))
    t_ns = attitude.trajectory().t_ns

    assert not attitude.covers(0, int(t_ns[-1]))
    assert attitude.covers(int(t_ns[-1]) - 50_000_000, int(t_ns[-1]))
    assert not attitude.covers(int(t_ns[-1]), int(t_ns[-1]) + 100_000_000)


@pytest.mark.parametrize("accel", [(0.0, 0.0, 0.0), (np.nan, np.nan, np.nan)])
def test_an_imu_without_accelerometer_is_not_used_and_said(room, accel):
    start_ns = int(room.scans.t_ns[0])

    _, poses, _ = mapped(room.scans, imu=lambda k: still(k, accel=accel, start_ns=start_ns))

    assert not any(pose.imu for pose in poses)
    assert poses[-1].remark == "no-forces"


def test_an_imu_upside_down_is_not_used_and_said(room):
    start_ns = int(room.scans.t_ns[0])
    upside_down = (0.0, 0.0, -9.81)

    _, poses, _ = mapped(room.scans, imu=lambda k: still(k, accel=upside_down, start_ns=start_ns))

    assert not any(pose.imu for pose in poses)
    assert poses[-1].remark == "not-upright"
