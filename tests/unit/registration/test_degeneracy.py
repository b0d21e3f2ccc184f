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


def test_without_a_match_the_information_is_unchanged():
    nothing = match_of(np.empty((0, 3)))

    H, g = observable_directions(nothing, NOISE_RAD)

    assert not H.any()
    assert not g.any()
