"""Gravity over a walk, by an accelerometer with the errors of real units."""

import numpy as np
import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.imu import Gravity, UpsideDown
from recon4.model.finding import Level
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.registration.imu_gravity import wrong_gravity
from recon4.units import STANDARD_GRAVITY_M_S2
from tests.unit.registration.test_unseen_rides import RIG, walked


@pytest.mark.parametrize("scale", [0.04, 0.1])
@pytest.mark.parametrize("world", ["office", "staircase"])
def test_a_wrong_scale_is_measured(world: str, scale: float) -> None:
    found = wrong_gravity(*walked(world, seconds=20.0, imu_scale=scale), RIG)

    assert found / STANDARD_GRAVITY_M_S2 - 1.0 == pytest.approx(scale, abs=0.015)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("world", ["office", "staircase", "elevator:1"])
def test_a_unit_in_order_measures_gravity(world: str, seed: int) -> None:
    trajectory, imu = walked(world, seconds=20.0, seed=seed)

    assert wrong_gravity(trajectory, imu, RIG) is None


def test_the_change_of_the_velocity_is_no_gravity() -> None:
    """A walk that is cut while the body moves fast."""
    trajectory, imu = walked("office", seconds=20.0)
    s = (trajectory.t_ns - trajectory.t_ns[0]) * 1e-9
    faster = trajectory.T_a_b
    faster.t[:, 2] += 0.15 * s**2  # 0.3 m/s², 6 m/s after 20 s
    pushed = imu.accel_m_s2 + np.einsum("nji,j->ni", _attitude(trajectory, imu), [0.0, 0.0, 0.3])

    assert wrong_gravity(trajectory, ImuSamples(imu.t_ns, imu.gyro_rad_s, pushed), RIG) is None


@pytest.mark.parametrize(
    ("bias_m_s2", "levels"), [(0.1, []), (0.3, [Level.NOTE]), (0.6, [Level.CHECK])]
)
def test_only_what_no_unit_in_order_measures_is_a_fault(
    bias_m_s2: float, levels: list[Level]
) -> None:
    trajectory, imu = walked("office", seconds=20.0)
    up = np.einsum("nji,j->ni", _attitude(trajectory, imu), [0.0, 0.0, bias_m_s2])
    record = WalkRecord(
        odometry=trajectory,
        imu=ImuSamples(imu.t_ns, imu.gyro_rad_s, imu.accel_m_s2 + up),
        rig=RIG,
        odometry_figures=OdometryFigures(multiframes=200, lost=0, imu=True),
    )

    assert [one.level for one in Gravity().check(record)] == levels


def test_without_an_accelerometer_or_in_a_short_walk_nothing_is_said() -> None:
    trajectory, imu = walked("office", seconds=20.0, imu_scale=0.1)
    early = trajectory.t_ns < trajectory.t_ns[0] + 5_000_000_000
    cut = Trajectory(trajectory.t_ns[early], trajectory.T_a_b[early])
    silent = ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(imu.accel_m_s2, np.nan))

    assert wrong_gravity(cut, imu, RIG) is None
    assert wrong_gravity(trajectory, silent, RIG) is None


def _attitude(trajectory: Trajectory, imu: ImuSamples) -> np.ndarray:
    inside = np.clip(imu.t_ns, trajectory.t_ns[0], trajectory.t_ns[-1])
    R = trajectory.at(inside).R @ RIG.T_body_imu.R
    return np.asarray(R)


@pytest.mark.parametrize(
    ("sign", "lost", "levels"),
    [
        (1.0, True, []),
        (-1.0, False, [Level.NOTE]),
        (-1.0, True, [Level.CHECK]),
        (np.nan, True, []),
    ],
    ids=["upright", "upside down", "reversed", "no accelerometer"],
)
def test_reversed_accelerations_are_named_where_tracking_was_lost(
    sign: float, lost: bool, levels: list[Level]
) -> None:
    trajectory, imu = walked("office", seconds=3.0)
    record = WalkRecord(
        imu=ImuSamples(imu.t_ns, imu.gyro_rad_s, sign * imu.accel_m_s2),
        rig=RIG,
        odometry_figures=OdometryFigures(multiframes=len(trajectory), lost=0, imu=True),
        steps={"lost": np.array([False, lost])},
    )

    assert [one.level for one in UpsideDown().check(record)] == levels
