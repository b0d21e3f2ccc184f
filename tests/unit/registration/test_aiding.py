"""What GNSS pulls the odometry by, and what it does not."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory
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


def test_a_body_agrees_with_fixes_within_three_deviations_of_their_antenna() -> None:
    agrees = [
        standing().agrees(SE3.from_rpy(roll, 0.0, 0.0, t=[x, 0.0, 0.0]), t_ns)
        for roll, x, t_ns in [(0, 0.29, 550_000_000), (0, 0.31, 0), (0.4, 0, 0), (0, 0, 9**10)]
    ]

    assert agrees == [True, False, False, False]


def walking(*, missing: slice = slice(0, 0)) -> GnssAiding:
    """A body that goes 1 m/s along x and turns 90°/s, with an antenna 1 m before it."""
    rows = np.delete(np.arange(31), missing)
    R = SE3.stack(SE3.from_rpy(0.0, 0.0, 0.05 * np.pi * k, t=[0.0, 0.0, 0.0]) for k in rows).R
    arm, place = np.array([1.0, 0.0, 0.0]), np.outer(0.1 * rows, [1.0, 0.0, 0.0])
    return GnssAiding(
        t_ns=rows.astype(np.int64) * 100_000_000,
        p_enu=place + R @ arm,
        sd_m=np.full((len(rows), 3), SD_M),
        R_enu_body=R,
        attitude_sd_rad=SD_RAD,
        p_body_antenna=arm,
    )


def test_fixes_alone_make_a_trajectory_of_the_body() -> None:
    T = walking().trajectory.at(np.array([1_550_000_000]))

    assert T.t[0] == pytest.approx([1.55, 0.0, 0.0], abs=0.01)
    assert T.angle()[0] == pytest.approx(np.pi * 0.775, abs=0.01)


def test_a_time_beside_a_gap_is_covered_and_one_inside_is_not() -> None:
    aiding = walking(missing=slice(10, 15))

    assert aiding.covers(700_000_000, 800_000_000)
    assert not aiding.covers(800_000_000, 1_000_000_000)
    assert not aiding.covers(2_950_000_000, 3_050_000_000)


def test_an_odometry_begins_in_the_frame_of_fixes_that_begin_soon() -> None:
    aiding = walking()

    for t_ns, at_ns in ((0, 0), (150_000_000, 150_000_000), (-950_000_000, 0)):
        first = aiding.first(t_ns)
        assert first is not None
        assert first[0] == at_ns
    assert aiding.first(-1_050_000_000) is None
    assert aiding.first(5_000_000_000) is None


def test_the_velocity_of_a_body_that_moves_is_that_between_its_fixes() -> None:
    found = walking().velocity(100_000_000)

    assert found == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)
    assert standing().velocity(100_000_000) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert walking().velocity(2_900_000_000) is None  # no fixes are so far after it


def test_fixes_that_a_trajectory_contradicts_are_counted() -> None:
    aiding = walking()
    right = aiding.trajectory[slice(1, None)]
    drifting = SE3(right.T_a_b.R, right.T_a_b.t * [[1.5, 1.0, 1.0]])

    assert aiding.rejected_ratio(right) == 0.0
    # 0.05 m a fix; three standard deviations are 0.3 m.
    found = aiding.rejected_ratio(Trajectory(right.t_ns, drifting))
    assert found == pytest.approx(24 / 30, abs=1 / 30)
    earlier = Trajectory(right.t_ns - 1_200_000_000, drifting)
    assert aiding.rejected_ratio(earlier) == 0.0  # its frame is not that of the fixes
    short = Trajectory(right.t_ns[:2] // 1000 + 110_000_000, drifting[:2])
    assert aiding.rejected_ratio(short) == 0.0  # between two fixes
