"""In a round hall only the gyroscope holds the turn about its axis."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.findings.witnesses.motion import turn_finding
from recon4.findings.wording import text_of
from recon4.geometry.se3 import SE3
from recon4.model.finding import Level
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.known_errors import KnownErrors
from recon4.registration.degeneracy import of_rigid_pose, weakest_twist
from recon4.registration.plane_map import PlaneMap
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_matching import DEGENERACY
from recon4.registration.walk_steps import WalkSteps
from recon4.registration.weak_turns import weak_turns

CENTER = np.array([0.5, 3.0, 0.0])


def hall(points, rng, *, is_round):
    """Walls, floor and ceiling 5 m around `CENTER`, with 1 cm of noise, (N, 3)."""
    z = rng.uniform(-1.5, 2.5, points)
    angle = rng.uniform(-np.pi, np.pi, points)
    out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    if not is_round:
        out /= np.abs(out).max(axis=1, keepdims=True)
    wall = np.column_stack([5.0 * out, z])
    flat = rng.uniform(-3.5, 3.5, (points, 2))
    ends = np.column_stack([flat, rng.choice([-1.5, 2.5], points)])
    return np.concatenate([wall, ends]) + CENTER + rng.normal(0.0, 0.01, (2 * points, 3))


def weakest_in(is_round):
    """The motion that a scan from the origin observes least in such a hall."""
    rng = np.random.default_rng(4)
    planes = PlaneMap()
    planes.add(hall(60_000, rng, is_round=is_round))
    scan = hall(1500, rng, is_round=is_round)
    match = planes.match(scan, np.zeros(len(scan)), center=np.zeros(3), finest=0, gate_m=0.2)
    assert match.match_ratio > 0.9
    return weakest_twist(0.1 * of_rigid_pose(match.H))


def step(k, *, weakest, at_m, lost=False, stationary=False):
    pose = SE3(np.eye(3), np.asarray(at_m, float))
    twist, sd_m, typical_m, information = weakest
    return OdometryStep(
        frame_id=k, t_mid_ns=100_000_000 * k, T_odom_body=pose,
        t_ns=np.array([0]), T_dense=SE3.stack([pose]),
        error_m=0.01, match_ratio=0.9, rounds=3, converged=True, degeneracy=0.1,
        prediction_offset_m=0.0, lost=lost, motion_cov=np.zeros((6, 6)),
        weak_twist=twist, weak_twist_sd_m=sd_m, typical_m=typical_m,
        weak_twist_information=information, stationary=stationary,
    )  # fmt: skip


def about(center, at_m, *, sd_m=0.03):
    """A turn about a vertical axis, as a body at ``at_m`` moves in it."""
    turn = np.array([0.0, 0.0, 0.2])
    return np.concatenate([turn, np.cross(turn, at_m - center)]), sd_m, 3.0, 0.002


def walk(count, **kinds):
    """Multiframes on a straight line along x through a round hall."""
    places = [np.array([0.03 * k, 0.0, 0.0]) for k in range(count)]
    return [step(k, weakest=about(CENTER, p), at_m=p, **kinds) for k, p in enumerate(places)]


def test_a_round_hall_does_not_observe_the_turn_about_its_axis():
    twist, sd_m, _, information = weakest_in(is_round=True)
    turn, shift = twist[:3], twist[3:]

    assert abs(turn[2]) > 0.99 * np.linalg.norm(turn)
    center = np.cross(turn, shift) / (turn @ turn)
    np.testing.assert_allclose(center[:2], CENTER[:2], atol=0.4)
    in_square = weakest_in(is_round=False)
    assert sd_m > 3.0 * in_square[1]
    assert (
        information
        < DEGENERACY.curved_information / 3.0
        < DEGENERACY.curved_information
        < in_square[3] / 3.0
    )


def test_the_information_on_a_turn_does_not_depend_on_the_number_of_points():
    H = np.diag([30.0, 40.0, 20.0, 8.0, 6.0, 4.0])
    many, few = weakest_twist(H), weakest_twist(0.01 * H)

    assert few[1] == pytest.approx(10.0 * many[1])
    assert few[3] == pytest.approx(many[3])


def test_the_stretch_is_found_with_its_axis_and_its_error():
    (found,) = weak_turns(WalkSteps(walk(100)), with_imu=True)

    assert (found.start_s, found.end_s) == (0.0, pytest.approx(9.9))
    np.testing.assert_allclose(np.abs(found.axis), [0.0, 0.0, 1.0], atol=1e-9)
    np.testing.assert_allclose(found.center_m, CENTER, atol=1e-9)
    assert "about the vertical axis at x 0.5 m, y 3.0 m" in text_of(
        turn_finding(found, Level.CHECK)
    )
    assert "turned by ± 4.0° (2σ)" in text_of(turn_finding(found, Level.CHECK))
    (free,) = weak_turns(WalkSteps(walk(100)), with_imu=False)
    assert free.rate_sd_rad_s == pytest.approx(10.0 * found.rate_sd_rad_s)


@pytest.mark.parametrize(
    "steps",
    [
        pytest.param(walk(15), id="short"),
        pytest.param(walk(100, stationary=True), id="stationary"),
        pytest.param(walk(100, lost=True), id="lost"),
        pytest.param([replace(one, weak_twist_sd_m=0.01) for one in walk(100)], id="well observed"),
        pytest.param(
            [replace(one, weak_twist_information=0.02) for one in walk(100)],
            id="a campus of few points: noise, not shape",
        ),
        pytest.param(
            [replace(one, weak_twist=np.eye(6)[3]) for one in walk(100)], id="tunnel: a shift"
        ),
        pytest.param(
            [replace(one, weak_twist_sd_m=float("nan")) for one in walk(100)], id="unknown"
        ),
        pytest.param(walk(1), id="one multiframe"),
    ],
)
def test_nothing_is_said_of_other_walks(steps):
    assert weak_turns(WalkSteps(steps), with_imu=True) == ()


def test_gravity_holds_a_turn_that_tilts_the_body():
    about_x = np.array([0.2, 0.0, 0.02, 0.0, 0.0, 0.1])
    steps = WalkSteps(replace(one, weak_twist=about_x) for one in walk(100))

    assert weak_turns(steps, with_imu=True, with_gravity=True) == ()
    assert len(weak_turns(steps, with_imu=True)) == 1
    assert len(weak_turns(WalkSteps(walk(100)), with_imu=True, with_gravity=True)) == 1


def test_nothing_observed_has_no_weakest_motion():
    twist, *figures = weakest_twist(np.zeros((6, 6)))

    assert np.isnan(twist).all() and np.isnan(figures).all()


def test_poses_know_how_far_the_turn_may_move_them():
    steps = walk(100)
    found = weak_turns(WalkSteps(steps), with_imu=True)
    poses = Trajectory(
        np.array([one.t_mid_ns for one in steps]), SE3.stack(one.T_odom_body for one in steps)
    )

    mode = KnownErrors(turns=found).modes(poses.t_ns, poses.T_a_b, on_earth=False)
    cov = mode @ np.swapaxes(mode, 1, 2)

    turned = found[0].rate_sd_rad_s * 9.9
    arm_m = np.linalg.norm(poses.T_a_b.t[-1] - CENTER)
    np.testing.assert_allclose(cov[0], 0.0)
    assert np.sqrt(cov[-1, 2, 2]) == pytest.approx(turned)
    assert np.sqrt(np.trace(cov[-1, 3:, 3:])) == pytest.approx(turned * arm_m)
    on_earth = KnownErrors(turns=found).modes(poses.t_ns, poses.T_a_b, on_earth=True)
    np.testing.assert_allclose(on_earth, 0.0)
