"""The lever arm of an IMU, by its forces on a walk that is known."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp, so3_log
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.registration.imu_lever_arm import wrong_lever_arm
from tests.builders import T0_NS
from tests.room_walks import rig_of

STEP_S = 0.0025
T_S = np.arange(0.0, 20.0, STEP_S)
GRAVITY = np.array([0.0, 0.0, 9.81])
P_BODY_IMU = np.array([0.1, -0.2, 0.3])


def walked(noise_m=0.0):
    """Poses of a walk with steps, and samples of an IMU at `P_BODY_IMU`."""
    rng = np.random.default_rng(3)
    turn = np.stack([0.04 * np.sin(11 * T_S), 0.05 * np.sin(9 * T_S), np.sin(0.8 * T_S)], axis=1)
    R = so3_exp(turn)
    p = np.stack([T_S, 0.3 * np.sin(T_S), 0.02 * np.sin(11 * T_S)], axis=1)
    x = p + R @ P_BODY_IMU
    accel = np.gradient(np.gradient(x, STEP_S, axis=0), STEP_S, axis=0) + GRAVITY
    t_ns = T0_NS + np.rint(1e9 * T_S).astype(np.int64)
    forces = np.einsum("nji,nj->ni", R, accel)
    wrong_m = np.repeat(rng.normal(0.0, noise_m, (len(p) // 40, 3)), 40, axis=0)
    return Trajectory(t_ns, SE3(R, p + wrong_m)), ImuSamples(t_ns, _rates(R), forces)


def _rates(R):
    """Turn rates in body axes, by the rotations from sample to sample."""
    rates = np.zeros((len(R), 3))
    rates[1:-1] = so3_log(np.swapaxes(R[:-2], 1, 2) @ R[2:]) / (2 * STEP_S)
    return rates


def claimed(p_body_imu):
    """A rig that has the IMU there."""
    return replace(rig_of(SE3.identity()), T_body_imu=SE3(np.eye(3), p_body_imu))


def found(p_claimed, noise_m):
    trajectory, imu = walked(noise_m)
    return wrong_lever_arm(trajectory.t_ns[20:-20:40], trajectory, imu, rig=claimed(p_claimed))


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_a_lever_arm_that_is_wrong_by_a_meter_is_found_with_size_and_direction(axis, way):
    wrong = way * np.eye(3)[axis]

    off = found(P_BODY_IMU + wrong, 0.002)

    np.testing.assert_allclose(off.p_body, -wrong, atol=0.1)
    assert off.sd_m < 0.1


@pytest.mark.parametrize("noise_m", [0.0, 0.002, 0.02])
def test_a_right_lever_arm_is_not_accused(noise_m):
    assert found(P_BODY_IMU, noise_m) is None
