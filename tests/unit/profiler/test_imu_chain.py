"""The chain of states joined by the IMU: it agrees with the truth, and is pulled to it."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.profiler.at_rest import AtRest
from recon4.profiler.fusion import PlanarPoses, attitude, fuse
from recon4.profiler.imu_chain import covers, initial_chain, linearize, make_drive
from recon4.settings import OdometrySettings
from recon4.simulation.gait import plan_walk
from recon4.simulation.imu import ImuModel, simulate_imu
from recon4.simulation.truth import true_trajectory
from recon4.simulation.worlds import build_world

SECONDS = 12.0


@pytest.fixture(scope="module")
def walked():
    """Truth and perfect IMU samples of a walk."""
    rng = np.random.default_rng(1)
    walk = plan_walk(build_world("hall"), seconds=SECONDS, rng=rng)
    rig = load_rig("wuerzburg")
    imu = simulate_imu(walk, rig, ImuModel.perfect(), epoch_ns=0, rng=rng)
    return true_trajectory(walk, epoch_ns=0), imu


def drive_of(imu, *, knot_s=0.05):
    span = (0, round(SECONDS * 1e9))
    return make_drive(imu, load_rig("wuerzburg"), span, knot_s=knot_s, settings=OdometrySettings())


def test_the_true_motion_is_what_the_imu_predicts(walked):
    truth, imu = walked
    drive = drive_of(imu)
    chain = initial_chain(drive).following(truth)
    speed = truth.at(drive.knot_ns[1:-1] + 500_000).t - truth.at(drive.knot_ns[1:-1] - 500_000).t
    chain.vector[1:-1, 3:6] = speed / 1e-3

    found = linearize(chain)

    assert np.abs(found.residual[2:-2, 0:3]).max() < 1e-4  # rotation [rad]
    assert np.abs(found.residual[2:-2, 3:6]).max() < 1e-3  # position [m]
    assert np.abs(found.residual[2:-2, 6:9]).max() < 2e-2  # velocity [m/s]


def test_a_dense_pose_lies_on_the_true_path_between_knots(walked):
    truth, imu = walked
    chain = initial_chain(drive_of(imu, knot_s=0.2)).following(truth)

    dense = linearize(chain).trajectory()

    between = dense.t_ns[5::40]
    assert len(dense) == 12 * 200 + 1
    assert np.abs(dense.at(between).t - truth.at(between).t).max() < 0.01


def planar_poses(truth, *, sd_m=0.0, sd_rad=0.0, T_body_laser=None):
    rng = np.random.default_rng(2)
    mount = T_body_laser or SE3.from_rpy(0.0, 0.0, 0.3, t=[0.1, 0.0, 0.4])
    t_ns = np.arange(50_000_000, round(SECONDS * 1e9) - 50_000_000, 50_000_000)
    T = truth.at(t_ns) @ mount
    turn = np.zeros((len(t_ns), 3))
    turn[:, 2] = np.arctan2(T.R[:, 1, 0], T.R[:, 0, 0]) + sd_rad * rng.standard_normal(len(t_ns))
    t = T.t.copy()
    t[:, :2] += sd_m * rng.standard_normal((len(t_ns), 2))
    t[:, 2] = 0.0
    sd = np.array([max(sd_m, 1e-3), max(sd_m, 1e-3), max(sd_rad, 1e-3)])
    cov = np.tile(np.diag(sd**2), (len(t_ns), 1, 1))
    return PlanarPoses(t_ns, SE3(so3_exp(turn), t), cov, mount)


def test_planar_poses_and_imu_give_all_six_degrees_of_freedom(walked):
    truth, imu = walked

    dense = linearize(fuse(drive_of(imu), planar_poses(truth))).trajectory()

    true = truth.at(dense.t_ns)
    away = dense.T_a_b.t - true.t
    assert np.abs(away[:, :2]).max() < 0.01
    assert np.ptp(away[:, 2]) < 0.05  # the height of a step is in the accelerations
    angle = SE3(np.swapaxes(true.R, 1, 2) @ dense.T_a_b.R, true.t).angle()
    assert np.degrees(angle).max() < 0.3


def test_noise_of_the_planar_poses_is_averaged(walked):
    truth, imu = walked

    chain = fuse(drive_of(imu), planar_poses(truth, sd_m=0.05, sd_rad=0.02))

    true = truth.at(chain.drive.knot_ns)
    away = chain.vector[:, 0:2] - true.t[:, :2]
    assert np.sqrt((away**2).sum(axis=1).mean()) < 0.025


def test_without_an_imu_the_planar_poses_are_followed(walked):
    truth, _ = walked
    drive = drive_of(None)

    chain = fuse(drive, planar_poses(truth))

    assert not drive.has_imu
    away = chain.vector[:, 0:2] - truth.at(drive.knot_ns).t[:, :2]
    assert np.abs(away[5:-5]).max() < 0.06


def test_the_attitude_of_a_walking_person_is_level_within_two_degrees(walked):
    truth, imu = walked

    found = attitude(drive_of(imu))

    tilt = found.T_a_b.rpy()[:, :2] - truth.at(found.t_ns).rpy()[:, :2]
    assert np.degrees(np.abs(tilt)).max() < 2.5


def test_samples_with_a_hole_do_not_cover_the_walk(walked):
    _, imu = walked
    kept = (imu.t_ns < 4_000_000_000) | (imu.t_ns > 4_500_000_000)
    holed = ImuSamples(imu.t_ns[kept], imu.gyro_rad_s[kept], imu.accel_m_s2[kept])

    assert covers(imu, (0, round(SECONDS * 1e9)))
    assert not covers(holed, (0, round(SECONDS * 1e9)))
    assert covers(holed, (5_000_000_000, 6_000_000_000))


def resting(imu, *, sway_m_s2):
    """Samples of a scanner at rest, of the noise and the biases of a cheap IMU; it may sway."""
    t_s, rng = 1e-9 * imu.t_ns, np.random.default_rng(4)
    accel = rng.normal([0.1, -0.05, 9.8], 0.01, (len(t_s), 3))
    accel[:, 0] += sway_m_s2 * np.sin(2.0 * np.pi * 0.7 * t_s)
    return ImuSamples(imu.t_ns, rng.normal([0.01, 0.0, -0.01], 0.003, (len(t_s), 3)), accel)


def test_without_a_2_d_laser_a_scanner_at_rest_does_not_drift(walked):
    _, walking = walked

    still = fuse(drive_of(resting(walking, sway_m_s2=0.0)), None).knots.T_a_b
    swaying = fuse(drive_of(resting(walking, sway_m_s2=0.3)), None).knots.T_a_b

    assert np.ptp(still.t, axis=0).max() < 2e-3
    assert np.rad2deg(np.abs((still[0].inverse() @ still[-1]).rpy())).max() < 0.2
    assert np.ptp(swaying.t, axis=0).max() > 0.2


def test_nobody_who_walks_is_at_rest(walked):
    truth, imu = walked
    drive = drive_of(imu)
    steps_m = np.linalg.norm(np.diff(truth.at(drive.knot_ns).t, axis=0), axis=1)

    still = AtRest.of(drive).still

    assert steps_m[still].max(initial=0.0) < 2e-3
    assert still.mean() < 0.1
