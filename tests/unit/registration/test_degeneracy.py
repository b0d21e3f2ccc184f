"""Information that errors of the plane normals alone create is removed."""

import numpy as np
import pytest

from recon4.registration.degeneracy import observable_directions
from recon4.registration.plane_map import Match

NOISE_RAD = 0.05


def match_of(normals, *, residual_m=0.01, seed=1):
    """Normal equations of points around the body, all at the start of the frame."""
    rng = np.random.default_rng(seed)
    p = rng.uniform(-5.0, 5.0, (len(normals), 3))
    J = np.hstack([np.cross(p, normals), normals])
    H, g = np.zeros((12, 12)), np.zeros(12)
    H[:6, :6], g[:6] = J.T @ J, J.T @ np.full(len(normals), residual_m)
    return Match(H, g, np.full(len(normals), residual_m), len(normals), residual_m, 1.0)


def around(directions, *, off_rad=0.0, seed=2):
    """Unit normals, each a little off its direction."""
    n = np.repeat(np.asarray(directions, float), 500, axis=0)
    n += off_rad * np.random.default_rng(seed).standard_normal(n.shape)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def test_flat_ground_with_noisy_normals_has_no_horizontal_information():
    found = match_of(around([[0, 0, 1]], off_rad=0.02))

    H, _ = observable_directions(found, NOISE_RAD)

    assert found.H[3, 3] > 0.1
    np.testing.assert_allclose(H[[3, 4], [3, 4]], 0.0, atol=0.02 * found.H[3, 3])
    assert H[5, 5] == pytest.approx(found.H[5, 5], rel=0.01)


def test_the_information_of_a_room_hardly_changes():
    found = match_of(around(np.eye(3)))

    H, g = observable_directions(found, NOISE_RAD)

    np.testing.assert_allclose(np.diag(H), np.diag(found.H), rtol=0.02)
    np.testing.assert_allclose(g, found.g, atol=0.02 * np.abs(found.g).max())


def test_a_weakly_observable_direction_keeps_its_step_with_less_weight():
    found = match_of(around([[0, 0, 1], [0, 1, 0], [0.1, 0, 1]], off_rad=0.01))

    H, g = observable_directions(found, 0.02)

    assert H[3, 3] < 0.97 * found.H[3, 3]
    np.testing.assert_allclose(
        np.linalg.solve(H[:6, :6], g[:6]), np.linalg.solve(found.H[:6, :6], found.g[:6]), rtol=1e-6
    )


def test_curved_walls_observe_no_turn_that_a_gyroscope_measures():
    found = match_in_a_round_hall(tangential_rad=0.06)

    with_imu, g = observable_directions(found, NOISE_RAD, with_imu=True)
    without, _ = observable_directions(found, NOISE_RAD)

    assert found.H[2, 2] > 100 * abs(with_imu[2, 2])
    assert abs(g[2]) < 0.01 * abs(found.g[2])
    assert without[2, 2] > 0.1 * found.H[2, 2], "without a gyroscope a little is better than none"
    np.testing.assert_allclose(np.diag(with_imu)[3:6], np.diag(found.H)[3:6], rtol=0.02)


def test_a_gyroscope_leaves_a_room_all_its_turns():
    found = match_of(around(np.eye(3)))

    np.testing.assert_array_equal(
        observable_directions(found, NOISE_RAD, with_imu=True)[0],
        observable_directions(found, NOISE_RAD)[0],
    )


def match_in_a_round_hall(*, tangential_rad, radius_m=4.0, count=3000):
    """Floor and a round wall around the body, whose fitted normals are not quite radial."""
    rng = np.random.default_rng(3)
    angle, height = rng.uniform(0.0, 2 * np.pi, count), rng.uniform(-1.5, 2.5, count)
    off = angle + tangential_rad * rng.standard_normal(count)
    wall = np.column_stack([radius_m * np.cos(angle), radius_m * np.sin(angle), height])
    of_wall = np.column_stack([np.cos(off), np.sin(off), np.zeros(count)])
    floor = np.column_stack([rng.uniform(-3.0, 3.0, (count, 2)), np.full(count, -1.5)])
    p, n = np.concatenate([wall, floor]), np.concatenate([of_wall, around([[0, 0, 1]] * 6)])
    J = np.hstack([np.cross(p, n), n])
    H, g = np.zeros((12, 12)), np.zeros(12)
    H[:6, :6], g[:6] = J.T @ J, J.T @ (0.01 * np.sign(off - angle).repeat(2)[: 2 * count])
    return Match(H, g, np.full(len(p), 0.01), len(p), 0.01, 1.0)


def test_without_a_match_the_information_is_unchanged():
    nothing = match_of(np.empty((0, 3)))

    H, g = observable_directions(nothing, NOISE_RAD)

    assert not H.any()
    assert not g.any()
