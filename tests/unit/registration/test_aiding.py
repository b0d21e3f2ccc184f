"""What GNSS pulls the odometry by, and what it does not."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.registration.aiding import GnssAiding

SD_M, SD_RAD = 0.1, 0.01


def standing() -> GnssAiding:
    """A body that stands at the origin, with an antenna above it, for a second."""
    t_ns = np.arange(11, dtype=np.int64) * 100_000_000
    arm = np.array([0.0, 0.0, 1.0])
    return GnssAiding(
        t_ns=t_ns,
        p_enu=np.tile(arm, (11, 1)),
        sd_m=np.full((11, 3), SD_M),
        R_enu_body=np.tile(np.eye(3), (11, 1, 1)),
        attitude_sd_rad=SD_RAD,
        p_body_antenna=arm,
    )


def pull(T: SE3) -> tuple[np.ndarray, np.ndarray]:
    return standing().pull(T, 550_000_000)


def test_a_small_error_is_pulled_back_with_its_weight() -> None:
    H, g = pull(SE3.from_rpy(0.0, 0.0, 1e-4, t=[1e-3, 0.0, 0.0]))

    assert H[2, 2] == pytest.approx(SD_RAD**-2, rel=1e-3)
    assert g[2] == pytest.approx(1e-4 / SD_RAD**2, rel=1e-3)
    assert g[3] == pytest.approx(1e-3 / SD_M**2, rel=1e-3)


def test_a_heading_that_is_far_off_has_little_influence() -> None:
    small, large = (
        pull(SE3.from_rpy(0.0, 0.0, yaw, t=[0.0, 0.0, 0.0]))[1][2] for yaw in (0.03, 0.3)
    )

    assert 0.0 < large < 0.25 * small  # without the bound it would be ten times the small one


def test_a_position_that_is_far_off_has_little_influence() -> None:
    small, large = (pull(SE3.from_rpy(0.0, 0.0, 0.0, t=[x, 0.0, 0.0]))[1][3] for x in (0.3, 3.0))

    assert 0.0 < large < 0.25 * small


def test_nothing_is_known_outside_the_fixes() -> None:
    H, g = standing().pull(SE3.identity(), 5_000_000_000)

    assert not H.any()
    assert not g.any()
