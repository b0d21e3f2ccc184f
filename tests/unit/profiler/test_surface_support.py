"""What surfaces seen at other times say of the place of each multiframe."""

import numpy as np
import pytest

from recon4.model.tuning import OBSERVATION
from recon4.profiler.line_refine import surface_support

_KNOTS = 401
_STEP_NS = 20_000_000


def information(normals, *, scale=1.0):
    """Normal equations of points 3 m away on planes with these normals, in every interval."""
    H = np.zeros((_KNOTS - 1, 12, 12))
    rng = np.random.default_rng(2)
    for normal in np.asarray(normals, float):
        for _ in range(4):
            arm = 3.0 * rng.standard_normal(3)
            J = np.concatenate([np.cross(arm, normal), normal])
            H[:, :6, :6] += scale * 1e4 * np.outer(J, J)
    return H


def supported(H, *, matches=80):
    counts = np.tile([100, matches], (_KNOTS - 1, 1))
    t_mid_ns = np.arange(5, _KNOTS - 5, 5) * _STEP_NS
    knot_ns = np.arange(_KNOTS) * _STEP_NS
    return surface_support(t_mid_ns, knot_ns, H=H, counts=counts, normal_noise_rad=0.03)


def test_walls_on_all_sides_hold_a_multiframe():
    found = supported(information(np.eye(3)))

    assert found.weak_sd_m.max() < 0.3 * OBSERVATION.weak_sd_m
    np.testing.assert_allclose(found.match_ratio, 0.8)


def test_a_corridor_holds_nothing_along_it():
    # Normals that err by a degree seem to hold it along the corridor: they must not count.
    found = supported(information([[0.02, 1.0, 0.0], [-0.02, 1.0, 0.0], [0.0, 0.0, 1.0]]))

    assert found.weak_sd_m.min() > 20.0 * OBSERVATION.weak_sd_m
    np.testing.assert_allclose(np.abs(found.weak_direction[:, 0]), 1.0, atol=0.01)


@pytest.mark.parametrize("since_s", [2.0, 4.0])
def test_only_lines_near_in_time_hold_a_multiframe(since_s):
    H = information(np.eye(3))
    first = round(since_s * 1e9 / _STEP_NS)
    H[first : first + 150] = 0.0  # 3 s without a match

    found = supported(H)

    weak = found.weak_sd_m > OBSERVATION.weak_sd_m
    t_s = 1e-9 * found.t_mid_ns
    assert weak[(t_s > since_s + 1.1) & (t_s < since_s + 1.9)].all()
    assert not weak[(t_s < since_s + 0.8) | (t_s > since_s + 2.2)].any()
