"""2-D SLAM on simulated walks: accuracy, loop closure, and honest words where it cannot know."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se2 import compose, to_se3
from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import EdgeKind
from recon4.model.trajectory import Trajectory
from recon4.settings import preset
from recon4.slam2d.observability import observed
from recon4.slam2d.slam import slam2d
from recon4.slam2d.stage import with_true_order
from tests.laser_rows import angles_of, rows_of, with_rows, with_times
from tests.planar_walks import (
    PlanarWalk,
    along,
    blank_corridor,
    cast,
    clockwise_and_back,
    full_turns,
    furnished_room,
    interlaced,
    mirrored,
    rectangle,
    ring_corridor,
    ring_walk,
    scanned,
    scanned_in,
    without,
)


@pytest.fixture(scope="module")
def ring():
    return scanned(ring_corridor(), ring_walk())


def loops_of(result):
    return [e for e in result.graph.edges if e.kind is EdgeKind.LOOP and e.in_graph]


@pytest.mark.parametrize("odometry", [True, False])
def test_a_round_walk_is_mapped_and_closed(ring, odometry):
    scans = ring.scans if odometry else replace(ring.scans, odometry=None)

    result = slam2d(scans)

    distance, turn = ring.errors(result.poses)
    assert distance.max() < 0.03
    assert np.rad2deg(turn.max()) < 0.3
    assert len(loops_of(result)) >= 5
    assert not result.steps.lost.any()


def test_the_map_shows_walls_and_free_space(ring):
    result = slam2d(ring.scans)

    def probability(place):
        # The map begins at the first pose of the laser.
        p_map = compose(result.poses[0], place - ring.truth[0] * [1.0, 1.0, 0.0])[:2]
        row, column = np.floor((p_map - result.grid.origin) / result.grid.cell_m).astype(int)
        return float(result.grid.probability[row - 1 : row + 2, column - 1 : column + 2].max())

    assert abs(ring.truth[0, 2]) < 1e-9
    assert probability(np.array([6.0, 0.0, 0.0])) > 0.9
    assert probability(np.array([6.0, -1.0, 0.0])) < 0.1
    assert probability(np.array([6.0, 6.0, 0.0])) == pytest.approx(0.5)


def test_a_blank_corridor_is_unobservable_and_its_length_uncertain():
    walk = scanned(blank_corridor(), along(np.array([[0.0, 0.0], [12.0, 0.0]])), odometry=False)

    result = slam2d(walk.scans)

    distance, _ = walk.errors(result.poses)
    # Nothing can be known along the walls; the covariance must say so at every scan.
    along_sd_m = np.sqrt(result.covariance[:, 1, 1])
    assert np.all(distance[20:] < 3.0 * along_sd_m[20:])
    assert np.median(result.steps.weak_sd_m[20:]) > 1.0
    assert np.abs(result.steps.weak_direction[20:, 0]).min() > 0.99


def test_a_room_is_observable():
    walk = scanned(furnished_room(), np.zeros((12, 3)), odometry=False)

    result = slam2d(walk.scans)

    assert result.steps.weak_sd_m[5:].max() < 0.01
    assert result.steps.degeneracy[5:].min() > 0.1


def test_five_silent_seconds_are_bridged_by_odometry(ring):
    scans = without(ring.scans, 15.0, 20.0)

    result = slam2d(scans)

    rows = np.searchsorted(ring.scans.t_ns, scans.t_ns)
    distance, _ = PlanarWalk(scans, ring.truth[rows]).errors(result.poses)
    assert distance.max() < 0.15
    assert len(loops_of(result)) >= 5


def test_open_space_is_lost_and_uncertain():
    walls = rectangle(-4.0, -3.0, 4.0, 3.0)[[0, 2, 3]]
    walk = scanned(walls, along(np.array([[0.0, 0.0], [40.0, 0.0]])))

    result = slam2d(walk.scans)

    distance, _ = walk.errors(result.poses)
    sd_m = np.sqrt(np.linalg.eigvalsh(result.covariance[:, 1:, 1:])[:, -1])
    assert result.steps.lost[-50:].all()
    assert distance[-1] > 0.5
    assert distance[-1] < 3.0 * sd_m[-1]


def test_scans_without_any_return_do_not_stop_it(ring):
    ranges = rows_of(ring.scans)[:120].copy()
    ranges[50:60] = np.nan
    walk = PlanarWalk(with_rows(ring.scans[:120], ranges), ring.truth[:120])

    result = slam2d(walk.scans)

    distance, _ = walk.errors(result.poses)
    assert result.steps.lost[50:60].all()
    assert not result.steps.lost[60:].any()
    assert distance.max() < 0.06


@pytest.mark.parametrize("layout", [full_turns, interlaced, clockwise_and_back])
@pytest.mark.parametrize("method", ["indoor", "hector"])
def test_scans_whose_angles_change_are_all_used(layout, method):
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0]])
    truth = along(corners, turn_s=4.0, speed_m_s=0.4)
    walk = scanned_in(furnished_room(), truth, layout(len(truth)))

    result = slam2d(walk.scans, settings=preset(method))

    distance, turn = walk.errors(result.poses)
    assert not result.steps.lost.any()
    assert distance.max() < 0.03
    assert np.rad2deg(turn.max()) < 1.0


def test_scans_in_the_wrong_order_are_mirrored_if_odometry_shows_it(ring):
    found, was_mirrored = with_true_order(mirrored(ring.scans))

    assert was_mirrored
    np.testing.assert_allclose(found.points(200)[::-1], ring.scans.points(200), atol=1e-6)
    assert with_true_order(ring.scans) == (ring.scans, False)


def test_roll_and_pitch_level_the_scans():
    truth = along(np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0]]))
    sway = 0.15 * np.sin(np.arange(len(truth)) * 0.4)
    T_world_laser = SE3.stack(
        SE3.from_rpy(roll, 0.5 * roll, yaw, t=[x, y, 0.0])
        for roll, (x, y, yaw) in zip(sway, truth, strict=True)
    )
    walk = scanned(furnished_room(), truth, odometry=False)
    angles = angles_of(walk.scans)
    beams = np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=1)
    ranges = np.empty_like(rows_of(walk.scans))
    for k, R in enumerate(T_world_laser.R):
        level = beams @ R.T
        flat = np.hypot(level[:, 0], level[:, 1])
        azimuth = np.arctan2(level[:, 1], level[:, 0]) - truth[k, 2]
        ranges[k] = cast(furnished_room(), truth[k], azimuth, 30.0) / flat
    tilted = PlanarWalk(with_rows(walk.scans, ranges), truth)
    attitude = Trajectory(tilted.scans.t_ns, SE3(T_world_laser.R, np.zeros((len(truth), 3))))

    leveled = slam2d(tilted.scans, attitude=attitude)
    ignored = slam2d(tilted.scans)

    with_attitude, _ = tilted.errors(leveled.poses)
    without_it, _ = tilted.errors(ignored.poses)
    assert with_attitude.max() < 0.01
    assert without_it.max() > 2.0 * with_attitude.max()


def test_a_scan_that_takes_time_is_undistorted():
    walking = along(np.array([[-3.0, 0.0], [0.0, -2.0], [3.0, -1.0]]), speed_m_s=1.5, rate_hz=5.0)
    truth = np.concatenate([np.repeat(walking[:1], 6, axis=0), walking])
    walk = scanned(furnished_room(), truth, odometry=False, rate_hz=5.0)
    step_s = 0.18 / int(walk.scans.beams[0])
    velocity = np.gradient(truth, 0.2, axis=0)
    angles = angles_of(walk.scans)
    ranges = np.empty_like(rows_of(walk.scans))
    for k in range(len(truth)):
        for m in range(len(angles)):
            pose = truth[k] + velocity[k] * m * step_s
            ranges[k, m] = cast(furnished_room(), pose, angles[m : m + 1], 30.0)[0]
    scans = with_rows(walk.scans, ranges)

    timed = slam2d(with_times(scans, step_s))
    untimed = slam2d(scans)

    corrected, _ = PlanarWalk(scans, truth).errors(timed.poses)
    distorted, _ = PlanarWalk(scans, truth).errors(untimed.poses)
    assert corrected.mean() < 0.5 * distorted.mean()


def test_hector_tracks_a_slow_walk():
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0]])
    walk = scanned(furnished_room(), along(corners, turn_s=4.0, speed_m_s=0.4), odometry=False)

    result = slam2d(walk.scans, settings=preset("hector"))

    distance, _ = walk.errors(result.poses)
    assert distance.max() < 0.03
    assert not loops_of(result)


def test_the_result_is_the_same_every_time(ring):
    first, second = slam2d(ring.scans[:150]), slam2d(ring.scans[:150])

    np.testing.assert_array_equal(first.poses, second.poses)
    np.testing.assert_array_equal(first.grid.log_odds, second.grid.log_odds)


def test_the_trajectory_is_that_of_the_poses(ring):
    result = slam2d(ring.scans[:60])

    np.testing.assert_allclose(result.trajectory.T_a_b.R, to_se3(result.poses).R)
    np.testing.assert_array_equal(result.trajectory.t_ns, ring.scans.t_ns[:60])


def test_information_of_parallel_lines_is_reduced_to_nothing_along_them():
    H = 1e5 * np.diag([4.0, 1e-4, 1.0])

    found = observed(H, 0.05)

    assert found.weak_sd_m == pytest.approx(1e3)
    np.testing.assert_allclose(np.abs(found.weak_direction), [1.0, 0.0], atol=1e-9)
    assert found.information[1, 1] == pytest.approx(0.0, abs=1e-6)
    assert found.information[2, 2] == pytest.approx(1e5, rel=0.01)
