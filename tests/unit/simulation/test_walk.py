from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp, so3_log
from recon4.model.rig import load_rig
from recon4.simulation.gait import plan_walk
from recon4.simulation.imu import ImuModel, simulate_imu
from recon4.simulation.worlds import WORLDS, build_world
from tests.unit.simulation.rooms import still

RIG = load_rig("4recon")


@pytest.fixture(scope="module")
def office_walk():
    return plan_walk(build_world("office"), seconds=30.0, rng=np.random.default_rng(5))


def imu_of(walk, rig=RIG, model=None, seed=0):
    model = model or ImuModel.perfect()
    return simulate_imu(walk, rig, model, epoch_ns=1_000, rng=np.random.default_rng(seed))


def test_the_imu_of_a_body_at_rest_feels_gravity_upwards():
    samples = imu_of(still())

    np.testing.assert_allclose(samples.accel_m_s2, [[0, 0, 9.80665]] * len(samples), atol=1e-9)
    np.testing.assert_allclose(samples.gyro_rad_s, 0.0, atol=1e-12)
    assert samples.t_ns[0] == 1_000 and set(np.diff(samples.t_ns)) == {5_000_000}


def test_imu_samples_integrate_back_to_the_truth(office_walk):
    samples = imu_of(office_walk)
    t_s = 1e-9 * (samples.t_ns - 1_000)
    start = office_walk.poses(t_s[:1])[0]
    R, p, v = start.R, start.t.copy(), office_walk.state(t_s[:1], 1)[0, :3]
    step = 0.005
    force = R @ samples.accel_m_s2[0] - [0, 0, 9.80665]

    for k in range(len(samples) - 1):
        R = R @ so3_exp(0.5 * step * (samples.gyro_rad_s[k] + samples.gyro_rad_s[k + 1]))
        following = R @ samples.accel_m_s2[k + 1] - [0, 0, 9.80665]
        p = p + step * v + step**2 * (force / 3.0 + following / 6.0)
        v = v + 0.5 * step * (force + following)
        force = following

    end = office_walk.poses(t_s[-1:])[0]
    assert np.rad2deg(np.linalg.norm(so3_log(R.T @ end.R))) < 0.02
    assert np.linalg.norm(p - end.t) < 0.1  # 30 s of double integration by the trapezoid rule


def test_angular_rate_is_the_derivative_of_the_pose(office_walk):
    t_s, h = np.linspace(2.0, 28.0, 300), 1e-5

    before, after = office_walk.poses(t_s - h), office_walk.poses(t_s + h)
    numeric = so3_log(np.swapaxes(before.R, 1, 2) @ after.R) / (2 * h)

    np.testing.assert_allclose(office_walk.angular_rate(t_s), numeric, atol=1e-5)


def test_an_imu_off_the_body_feels_the_motion_of_its_own_place(office_walk):
    mount = SE3.from_rpy(0.1, -0.2, 0.3, t=[0.2, -0.1, 0.3])
    samples = imu_of(office_walk, replace(RIG, T_body_imu=mount))
    rows = np.arange(400, 5600, 37)
    t_s, h = 0.005 * rows, 1e-3

    here = [(office_walk.poses(t_s + k * h) @ np.tile(mount.t, (len(t_s), 1))) for k in (-1, 0, 1)]
    acceleration = (here[0] - 2 * here[1] + here[2]) / h**2
    R_map_imu = office_walk.poses(t_s).R @ mount.R
    expected = np.einsum("nji,nj->ni", R_map_imu, acceleration + np.array([0, 0, 9.80665]))

    np.testing.assert_allclose(samples.accel_m_s2[rows], expected, atol=0.01)


def test_a_real_imu_has_the_stated_noise_and_bias():
    walk = still(seconds=60.0)
    many = [imu_of(walk, model=ImuModel(), seed=seed) for seed in range(12)]

    noise = np.mean([np.diff(s.gyro_rad_s, axis=0).std() / np.sqrt(2) for s in many])
    biases = np.array([s.gyro_rad_s.mean(axis=0) for s in many])

    assert np.rad2deg(noise) == pytest.approx(0.005 * np.sqrt(200), rel=0.05)
    assert 0.1 < np.rad2deg(biases.std()) < 0.3


@pytest.mark.parametrize("world", WORLDS)
def test_a_walk_is_human_and_ends_where_it_began(world):
    walk = plan_walk(build_world(world), seconds=60.0, rng=np.random.default_rng(2))
    t_s = np.arange(0.0, 60.0, 0.01)
    velocity, turning = walk.state(t_s, 1)[:, :3], walk.state(t_s, 1)[:, 5]
    state = walk.state([0.0, walk.seconds])

    assert walk.seconds == 60.0
    np.testing.assert_allclose(state[0, :5], state[1, :5], atol=1e-5)
    assert np.sin(0.5 * (state[1, 5] - state[0, 5])) == pytest.approx(0.0, abs=1e-5)
    assert np.abs(velocity[t_s < 0.8]).max() < 0.015  # on stairs the slowest start rises a little
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    assert 0.5 < np.median(speed[speed > 0.4]) < 1.45
    assert 130.0 < np.rad2deg(np.abs(turning)).max() < 265.0
    assert np.abs(walk.acceleration(t_s)).max() < 12.0


def test_steps_bounce_the_body_about_twice_a_second(office_walk):
    t_s = np.arange(5.0, 25.0, 0.01)
    z = office_walk.state(t_s)[:, 2] - 1.5

    spectrum = np.abs(np.fft.rfft(z * np.hanning(len(z))))
    frequency = np.fft.rfftfreq(len(z), 0.01)

    assert 1.5 < frequency[spectrum[1:].argmax() + 1] < 2.1
    assert 0.01 < np.sqrt(2) * z.std() < 0.03


def test_a_longer_walk_is_more_rounds_by_other_ways():
    world = build_world("office")
    walk = plan_walk(world, seconds=600.0, rng=np.random.default_rng(1))

    path = walk.state(np.arange(0.0, 600.0, 0.1))[:, :2]
    at_home = np.linalg.norm(path - path[0], axis=1) < 1.0
    visits = np.count_nonzero(np.diff(at_home.astype(int)) == 1)
    way = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()

    assert visits >= 3
    assert 0.8 * 600 < way < 1.3 * 600


def test_other_seeds_walk_other_ways():
    world = build_world("office")

    walks = [plan_walk(world, seconds=60.0, rng=np.random.default_rng(k)) for k in (1, 1, 2)]

    assert np.array_equal(walks[0].coefficients, walks[1].coefficients)
    assert np.abs(walks[0].coefficients[:, 0, :2] - walks[2].coefficients[:, 0, :2]).max() > 1.0
