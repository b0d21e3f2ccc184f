"""A ledge before a wall: the place along a weak direction where most points lie on planes."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.registration.motion import MotionState, Prediction
from recon4.registration.plane_map import Match
from recon4.registration.point_map import FramePoints, PointMap, WeakDirections, better_place_m
from recon4.registration.tuning import PlaneTuning

DEPTH_M, FAR_M, OFF_M = 0.16, 6.06, -0.13
T_S = np.array([0.0, 0.1])


def surface(count, seed, *, at_m=FAR_M, left=False):
    """Points (N, 3) of a wall across the corridor, or of its left half."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1.0, 1.0, (count, 3))
    points[:, 0] = at_m + 0.004 * rng.standard_normal(count)
    if left:
        points[:, 1] = np.abs(points[:, 1])
    return points


def at(x_m):
    return SE3(np.tile(np.eye(3), (2, 1, 1)), np.tile([x_m, 0.0, 0.0], (2, 1)))


@pytest.fixture(scope="module")
def wall():
    """The wall, and a ledge that covers its left half."""
    point_map = PointMap(PlaneTuning())
    for seed in range(5):
        ledge = surface(4000, seed + 5, at_m=FAR_M - DEPTH_M, left=True)
        points = np.concatenate([surface(4000, seed), ledge])
        point_map.add(FramePoints(points, np.zeros(len(points))), T_S, at(0.0))
    return point_map


def step_m(wall, *, by_scans):
    """Where the step of the third round leads from 13 cm behind the place [m]."""
    end = MotionState(0, np.eye(3), np.zeros(25), np.eye(28))
    prediction = Prediction(T_S, at(OFF_M), end, np.eye(34), SE3.identity() if by_scans else None)
    points = np.concatenate([surface(40, 20, left=True), surface(40, 21)])
    seen = FramePoints(points, np.full(len(points), 0.05))
    weak = WeakDirections(wall, lambda: seen, prediction, max_eigenvalue=0.05)
    segments = Match(
        np.zeros((12, 12)), np.zeros(12), np.zeros(9), 9, 0.0, 0.0, np.diag([0.0, 0.5, 0.5])
    )
    for rounds in (1, 2, 3):
        H, g = weak.pull(segments, rounds, 0.2, T_odom_body=at(OFF_M))
    along = np.zeros(12)
    along[[3, 9]] = 1.0
    return -float(along @ g) / float(along @ H @ along)


def test_a_step_leads_to_where_most_points_lie_on_planes(wall):
    assert step_m(wall, by_scans=True) == pytest.approx(-OFF_M, abs=0.015)


def test_an_imu_knows_the_place_so_the_next_plane_counts(wall):
    assert step_m(wall, by_scans=False) < 0.0


def surfaces(shift_m):
    """Distances of 30 points to the next of two planes, and of 20 that see one of them only."""
    either = min(abs(shift_m - DEPTH_M), abs(shift_m))
    one = abs(shift_m - DEPTH_M)
    return np.array([either] * 30 + [one if one < 0.1 else np.nan] * 20)


def test_a_place_counts_as_better_only_if_clearly_more_points_lie_there():
    between_m = -0.5 * DEPTH_M

    assert better_place_m(surfaces, shifted_m=between_m) == pytest.approx(DEPTH_M, abs=0.01)
    assert better_place_m(lambda s: surfaces(s)[:34], shifted_m=between_m) == 0.0


def test_a_place_far_from_the_prediction_is_none():
    assert better_place_m(lambda s: surfaces(s)[:42], shifted_m=0.4) == 0.0
