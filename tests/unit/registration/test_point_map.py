"""Single points observe what segments do not: the position along a long blank corridor."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.registration.odometry import Odometry
from recon4.registration.point_map import FramePoints, PointMap, WeakDirections, frame_points
from recon4.registration.tuning import PlaneTuning
from recon4.settings import Settings
from tests import scanned_room
from tests.scanned_room import RIG, scan, standing, walk
from tests.tuned import with_tuning

ALONG = np.array([[1.0, 0.0, 0.0]])
FRAMES = 90
VIEWPOINTS = 5
ACCEL_BIAS_M_S2 = np.array([0.1, 0.0, 0.0])


def strides(t_s):
    """A person stands for a second, then walks along the corridor, two steps a second."""
    t = np.maximum(np.asarray(t_s, float) - 1.0, 0.0)
    swing = 2 * np.pi * 2.0 * t
    zero = np.zeros_like(t)
    pitch = np.stack([zero, 0.03 * np.sin(swing + 0.5) * (1 - np.exp(-2 * t)), zero], axis=1)
    bounce = 0.03 * np.sin(swing) * (1 - np.exp(-2 * t))
    return SE3(so3_exp(pitch), np.stack([1.2 * (t + 0.5 * np.exp(-2 * t) - 0.5), zero, bounce], 1))


@pytest.fixture(scope="module")
def corridor():
    """70 m x 1.8 m x 2.7 m, blank but for its two ends; the accelerometer's bias changes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scanned_room, "LOW_M", np.array([-25.0, -0.9, -1.2]))
        patch.setattr(scanned_room, "HIGH_M", np.array([45.0, 0.9, 1.5]))
        patch.setattr(scanned_room, "BOXES_M", ())
        made = walk(strides, FRAMES, noise_m=0.01)
    t_s = (made.imu.t_ns - scanned_room.T0_NS) * 1e-9
    bias = np.clip((t_s - 2.0) / 2.0, 0.0, 1.0)[:, None] * ACCEL_BIAS_M_S2
    return replace(made, imu=replace(made.imu, accel_m_s2=made.imu.accel_m_s2 + bias))


def error_along_m(corridor, settings):
    """Errors of the distance walked, (N,), and the steps."""
    odometry = Odometry(corridor.rig, settings, corridor.imu)
    steps = [odometry.push(frame) for frame in corridor]
    assert not any(step.lost for step in steps)
    walked_m = np.array([step.T_odom_body.t[0] for step in steps])
    true_m = corridor.true_poses().t[:, 0]
    return (walked_m - walked_m[0]) - (true_m - true_m[0]), steps


def test_the_ends_of_a_blank_corridor_carry_odometry(corridor):
    error_m, steps = error_along_m(corridor, Settings())

    assert np.abs(error_m).max() < 0.05
    assert max(step.weak_sd_m for step in steps[30:]) < 0.02


def test_without_points_the_same_corridor_slides_and_says_so(corridor):
    error_m, steps = error_along_m(corridor, with_tuning(Settings(), "odometry.weak_eigenvalue=0"))

    assert np.abs(error_m[-1]) > 0.2
    assert np.median([step.weak_sd_m for step in steps[5:]]) > 0.05


def filled(*patches):
    point_map = PointMap(PlaneTuning())
    points = np.concatenate(patches)
    for _ in range(VIEWPOINTS):
        point_map.add(FramePoints(points, np.zeros(len(points))), np.array([0.0, 0.1]), still())
    return point_map


def still():
    return SE3.identity(2)


def wall(axis, at_m, *, count=4000, seed=0, half_m=1.0):
    """Points of a wall across an axis, around the body's height."""
    rng = np.random.default_rng([seed, axis])
    points = rng.uniform(-half_m, half_m, (count, 3))
    points[:, axis] = at_m + 0.01 * rng.standard_normal(count)
    return points


def chosen(point_map, points):
    found = point_map.choose(
        FramePoints(points, np.zeros(len(points))), np.array([0.0, 0.1]), still(), weak=ALONG
    )
    return found.body


def test_only_points_on_surfaces_that_face_the_weak_direction_are_chosen():
    end, side = wall(0, 30.0), wall(1, 5.0)
    asked = np.concatenate([end[:50], side[:50]])

    found = chosen(filled(end, side), asked)

    assert len(found) >= 45
    assert (found[:, 0] > 29.0).all()


def test_points_shift_the_body_along_weak_directions_but_never_turn_it(corridor):
    odometry = Odometry(corridor.rig, Settings(), corridor.imu)
    pulls = []
    original = WeakDirections.pull

    def recorded(self, segments, *args, **kwargs):
        H, g = original(self, segments, *args, **kwargs)
        pulls.append((H, g, self._weak))
        return H, g

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(WeakDirections, "pull", recorded)
        for k in range(40):
            odometry.push(corridor[k])
    pulled = [(H, g, weak) for H, g, weak in pulls if np.any(g)]
    assert pulled
    for H, g, weak in pulled[-20:]:
        shift = np.kron(np.eye(2), np.diag([0, 0, 0, 1, 1, 1]))
        np.testing.assert_array_equal(shift @ H @ shift, H)
        across = np.eye(3) - weak.T @ weak
        np.testing.assert_allclose(across @ g[3:6], 0.0, atol=1e-6 * np.abs(g).max())


def test_the_plane_that_one_ring_spans_is_no_surface():
    # A vertical fan of rays around an edge: floor and wall, all in the plane x = 0 of the ring.
    rng = np.random.default_rng(2)
    along = rng.uniform(0.0, 0.2, 600)
    floor = np.column_stack([0.02 * rng.standard_normal(600), 0.8 + along, np.full(600, -1.2)])
    face = np.column_stack([0.02 * rng.standard_normal(600), np.full(600, 1.0), -1.2 + along])
    fan = np.concatenate([floor, face])

    assert len(chosen(filled(fan), fan)) == 0


def test_a_surface_between_the_weak_direction_and_another_says_too_little():
    c, s = np.cos(0.7), np.sin(0.7)
    end = wall(0, 5.0)
    slanted = end @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    assert len(chosen(filled(end), end))
    assert len(chosen(filled(slanted), slanted)) == 0


@pytest.mark.parametrize("tilt_deg", [0, 45])
def test_a_surface_may_face_both_of_two_weak_directions(tilt_deg):
    turn = so3_exp([0.0, 0.0, np.deg2rad(tilt_deg)])
    end = wall(0, 5.0) @ turn.T
    sideways = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])

    found = filled(end).choose(
        FramePoints(end, np.zeros(len(end))), np.array([0.0, 0.1]), still(), weak=sideways
    )

    assert len(found)


def test_points_that_scatter_by_more_than_their_range_are_no_surface():
    # A corner at the height of the body, hit by a few rings: the best plane is nearly horizontal.
    rng = np.random.default_rng(3)
    floor = rng.uniform(-1.0, 1.0, (6000, 3)) + np.array([5.0, 0.0, 0.0])
    exact, corner = floor.copy(), floor.copy()
    exact[:, 2] = 2.1 + 0.004 * rng.standard_normal(6000)
    corner[:, 2] = 2.1 + 0.02 * rng.standard_normal(6000)
    up = np.array([[0.0, 0.0, 1.0]])

    counts = [
        len(
            filled(p).choose(
                FramePoints(p, np.zeros(len(p))), np.array([0.0, 0.1]), still(), weak=up
            )
        )
        for p in (exact, corner)
    ]

    assert counts[0] > 500
    assert counts[1] < 0.1 * counts[0]


def test_an_empty_map_gives_no_points():
    assert len(chosen(PointMap(PlaneTuning()), wall(0, 3.0))) == 0


def test_no_more_points_than_the_rounds_can_afford():
    end = wall(0, 30.0, count=20_000)

    found = chosen(filled(end), end)

    assert 700 < len(found) <= 1500


def test_far_cubes_are_forgotten():
    point_map = filled(wall(0, 30.0))
    here = FramePoints(wall(0, 430.0), np.zeros(4000))
    there = SE3(np.tile(np.eye(3), (2, 1, 1)), np.full((2, 3), [400.0, 0.0, 0.0]))

    for _ in range(49 - VIEWPOINTS):
        point_map.add(here, np.array([0.0, 0.1]), SE3.identity(2))
    assert len(chosen(point_map, wall(0, 30.0)))
    point_map.add(here, np.array([0.0, 0.1]), there)

    assert not len(chosen(point_map, wall(0, 30.0)))


def test_of_the_points_nearby_every_fourth_is_used():
    frame = scan(standing, scanned_room.T0_NS)

    points = frame_points(frame, RIG)

    near = np.linalg.norm(frame.xyz, axis=1) < 2.5
    assert len(points) == pytest.approx((~near).sum() + near.sum() / 4, rel=0.02)
    assert len(points.s) == len(points.body)


def test_a_person_who_stands_is_stationary_and_one_who_walks_is_not(corridor):
    odometry = Odometry(corridor.rig, Settings(), corridor.imu)
    stationary = [odometry.push(frame).stationary for frame in corridor]

    assert all(stationary[:9])
    assert not any(stationary[12:])
