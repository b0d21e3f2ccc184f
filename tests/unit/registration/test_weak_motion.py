"""What is added to the covariance of a motion along a direction that is hardly observed."""

import numpy as np
import pytest

from recon4.registration.weak_motion import unknown_speed_sd, weak_motion_cov

AXIS = np.array([0.6, 0.8, 0.0])


@pytest.mark.parametrize(
    ("speed", "with_imu", "expected"), [(1.2, True, 0.6), (1.2, False, 2.0), (40.0, False, 38.5)]
)
def test_the_speed_of_the_carrier_bounds_what_is_unknown(
    speed: float, with_imu: bool, expected: float
) -> None:
    assert unknown_speed_sd(speed, with_imu=with_imu) == expected


def test_nothing_observed_leaves_the_whole_motion_unknown() -> None:
    cov = weak_motion_cov(AXIS, 10.0, unknown_m=0.06)

    np.testing.assert_allclose(cov[3:, 3:], 0.06**2 * np.outer(AXIS, AXIS), rtol=1e-6)
    assert not cov[:3].any()


def test_what_is_observed_gets_nothing() -> None:
    assert not weak_motion_cov(AXIS, 0.018, unknown_m=0.06, converged=False).any()


def test_an_unknown_direction_gets_nothing() -> None:
    assert not weak_motion_cov(np.full(3, np.nan), 1.0, unknown_m=0.06).any()
    assert not weak_motion_cov(AXIS, float("nan"), unknown_m=0.06).any()


def test_a_registration_that_did_not_converge_says_nothing_of_the_position() -> None:
    cov = weak_motion_cov(AXIS, 0.04, unknown_m=0.2, converged=False)

    np.testing.assert_allclose(np.diag(cov), [0, 0, 0, 0.04, 0.04, 0.04])
