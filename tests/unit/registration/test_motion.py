from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp, so3_log
from recon4.model.samples import ImuSamples
from recon4.registration.motion import FreeMotion, ImuMotion, MotionState, Rest
from recon4.registration.tuning import OdometryTuning
from recon4.settings import OdometrySettings
from tests.room_walks import T0_NS
from tests.scanned_room import RIG, imu_of, standing, strolling

SETTINGS = OdometrySettings()
S_NS = 1_000_000_000


def imu_motion(pose=strolling, seconds=2.0, rig=RIG):
    return ImuMotion(imu_of(pose, seconds), rig, SETTINGS)


def swaying(t_s):
    """Turns that change from sample to sample, at one place."""
    turns = 0.3 * np.sin(np.outer(t_s, [9.0, 7.0, 5.0]) + np.arange(3.0))
    return SE3(so3_exp(turns), np.zeros((len(t_s), 3)))


def start_of(pose, t_ns, velocity):
    vector = np.zeros(25)
    T = pose(np.array([(t_ns - T0_NS) * 1e-9]))
    vector[:3], vector[3:6], vector[14] = T.t[0], velocity, -9.80665
    return MotionState(t_ns, T.R[0], vector, np.diag(np.repeat([1e-6, 0.0], [18, 10])))


def test_a_perfect_imu_predicts_the_walk():
    state = start_of(strolling, T0_NS, [0.5, 0.1, 0.0])

    prediction = imu_motion().predict(state, T0_NS + S_NS)

    truth = strolling(prediction.t_s)
    np.testing.assert_allclose(prediction.T_odom_body.t, truth.t, atol=2e-4)
    np.testing.assert_allclose(prediction.T_odom_body.R, truth.R, atol=1e-6)
    assert prediction.t_s[0] == 0.0
    assert prediction.t_s[-1] == 1.0
    assert prediction.end.t_ns == T0_NS + S_NS


def test_two_halves_predict_the_same_as_the_whole():
    motion, state = imu_motion(), start_of(strolling, T0_NS, [0.5, 0.1, 0.0])

    whole = motion.predict(state, T0_NS + S_NS).end
    halves = motion.predict(motion.predict(state, T0_NS + S_NS // 2).end, T0_NS + S_NS).end

    np.testing.assert_allclose(halves.vector, whole.vector, atol=1e-6)
    np.testing.assert_allclose(halves.P, whole.P, rtol=1e-3, atol=1e-12)


def test_the_joint_prior_is_a_covariance_of_start_and_end():
    prediction = imu_motion().predict(start_of(strolling, T0_NS, [0.5, 0, 0]), T0_NS + S_NS // 10)

    prior = prediction.prior
    assert prior.shape == (34, 34)
    np.testing.assert_allclose(prior, prior.T, atol=1e-15)
    np.testing.assert_array_equal(prior[:6, :6], 1e-6 * np.eye(6))
    np.testing.assert_array_equal(prior[6:, 6:], prediction.end.P)
    assert np.linalg.eigvalsh(prior).min() > -1e-15
    # Over a tenth of a second the pose at the end is nearly that at the start, moved.
    assert prior[3, 9] == pytest.approx(1e-6, rel=1e-6)


def test_gravity_is_level_at_the_start():
    tilt = so3_exp([0.2, -0.1, 0.0])

    def tilted(t_s):
        return SE3(np.tile(tilt, (len(t_s), 1, 1)), np.zeros((len(t_s), 3)))

    state = imu_motion(tilted).initial(T0_NS)

    np.testing.assert_allclose(state.R.T @ [0, 0, 1], tilt.T @ [0, 0, 1], atol=1e-6)
    np.testing.assert_allclose(state.vector[12:15], [0, 0, -9.80665])
    # The heading is left as it is: the turn is about a horizontal axis of the body.
    assert abs((state.R - state.R.T)[1, 0]) < 0.03


def test_an_imu_upside_down_levels_too():
    def turned_over(t_s):
        return SE3(np.tile(so3_exp([np.pi, 0, 0]), (len(t_s), 1, 1)), np.zeros((len(t_s), 3)))

    state = imu_motion(turned_over).initial(T0_NS)

    np.testing.assert_allclose(state.R @ [0, 0, -1], [0, 0, 1], atol=1e-6)


def test_mounting_and_lever_arm_of_the_imu_are_compensated():
    T_body_imu = SE3.from_rpy(0.1, 0.2, 1.0, t=[0.3, -0.2, 0.4])
    rig = replace(RIG, T_body_imu=T_body_imu)

    def of_imu(t_s):
        return strolling(t_s) @ T_body_imu

    mounted = ImuMotion(imu_of(of_imu, 2.0), rig, SETTINGS)
    state = start_of(strolling, T0_NS, [0.5, 0.1, 0.0])

    np.testing.assert_allclose(
        mounted.predict(state, T0_NS + S_NS).T_odom_body.t[-1],
        imu_motion().predict(state, T0_NS + S_NS).T_odom_body.t[-1],
        atol=2e-3,
    )


def test_what_the_imu_covers():
    motion = imu_motion(seconds=2.0)
    imu = imu_of(strolling, 2.0)
    hole = (imu.t_ns < T0_NS + S_NS) | (imu.t_ns > T0_NS + S_NS + 60_000_000)
    holed = ImuMotion(
        ImuSamples(imu.t_ns[hole], imu.gyro_rad_s[hole], imu.accel_m_s2[hole]), RIG, SETTINGS
    )

    assert motion.covers(T0_NS, T0_NS + S_NS)
    assert not motion.covers(T0_NS + 2 * S_NS, T0_NS + 3 * S_NS)
    assert not motion.covers(T0_NS - 2 * S_NS, T0_NS - S_NS)
    assert not motion.covers(T0_NS + 10 * S_NS, T0_NS + 11 * S_NS)
    assert holed.covers(T0_NS, T0_NS + S_NS // 2)
    assert not holed.covers(T0_NS + S_NS // 2, T0_NS + 3 * S_NS // 2)


def test_scale_axes_and_clock_of_the_imu_are_applied():
    gain = np.array([[0.97, 0.01, 0.0], [-0.01, 1.02, 0.02], [0.0, -0.02, 1.03]])
    imu, late_ns = imu_of(swaying, 2.0), 20_000_000
    wrong = ImuSamples(imu.t_ns + late_ns, imu.gyro_rad_s @ np.linalg.inv(gain).T, imu.accel_m_s2)
    state = start_of(swaying, T0_NS + S_NS // 2, [0.0, 0.0, 0.0])
    known = state.vector.copy()
    known[15:24], known[24] = (gain - np.eye(3)).ravel(), 0.02

    right = ImuMotion(imu, RIG, SETTINGS).predict(state, T0_NS + S_NS).end
    corrected = ImuMotion(wrong, RIG, SETTINGS).predict(replace(state, vector=known), T0_NS + S_NS)

    np.testing.assert_allclose(corrected.end.R, right.R, atol=1e-5)
    np.testing.assert_allclose(corrected.end.vector[:6], right.vector[:6], atol=1e-4)
    as_measured = ImuMotion(wrong, RIG, SETTINGS).predict(state, T0_NS + S_NS).end
    assert np.abs(as_measured.R - right.R).max() > 5e-3


def test_a_clock_that_is_far_off_is_not_followed_without_bound():
    state = start_of(strolling, T0_NS + S_NS, [0.5, 0.1, 0.0])
    vector = state.vector.copy()
    vector[24] = 1e6

    end = imu_motion().predict(replace(state, vector=vector), T0_NS + S_NS + S_NS // 10).end

    assert np.isfinite(end.vector).all()


def test_settings_say_how_well_scale_and_clock_are_known():
    sure = OdometryTuning(gyro_gain_sd=0.0, imu_clock_sd_s=0.0)
    free, fixed = (ImuMotion(imu_of(strolling, 2.0), RIG, s) for s in (SETTINGS, sure))

    ends = [motion.predict(motion.initial(T0_NS), T0_NS + S_NS).end for motion in (free, fixed)]

    sd = [np.sqrt(np.diag(end.P))[18:] for end in ends]
    np.testing.assert_allclose(sd[0], np.repeat([0.01, 0.005], [9, 1]), rtol=1e-3)
    np.testing.assert_array_equal(sd[1], 0.0)


def test_a_gyroscope_alone_still_turns():
    imu = imu_of(strolling, 2.0)
    alone = ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(imu.accel_m_s2, np.nan))
    motion = ImuMotion(alone, RIG, SETTINGS)

    state = motion.initial(T0_NS)
    end = motion.predict(state, T0_NS + S_NS).end

    np.testing.assert_array_equal(state.R, np.eye(3))
    np.testing.assert_allclose(end.R, so3_exp([0, 0, np.deg2rad(20.0)]), atol=1e-6)
    np.testing.assert_allclose(end.vector[:3], 0.0, atol=1e-12)


def test_the_turn_of_a_second():
    turn = imu_motion().turn(T0_NS, T0_NS + S_NS)

    np.testing.assert_allclose(turn, so3_exp([0, 0, np.deg2rad(20.0)]), atol=1e-6)


def test_without_an_imu_the_velocity_stays_constant():
    motion = FreeMotion(SETTINGS)
    state = motion.initial(T0_NS)
    vector = state.vector.copy()
    vector[3:6], vector[6:9] = [1.0, 0.5, 0.0], [0.0, 0.0, -0.7]

    end = motion.predict(replace(state, vector=vector), T0_NS + S_NS // 10).end

    np.testing.assert_allclose(end.vector[:3], [0.1, 0.05, 0.0], atol=1e-12)
    np.testing.assert_allclose(end.R, so3_exp([0, 0, 0.07]), atol=1e-12)
    assert motion.covers(T0_NS, T0_NS + 1)
    assert not motion.covers(T0_NS, T0_NS)


def test_a_stationary_state_stays():
    state = start_of(standing, T0_NS, [0.0, 0.0, 0.0])

    end = imu_motion(standing).predict(state, T0_NS + S_NS).end

    np.testing.assert_allclose(end.vector[:6], 0.0, atol=1e-9)


def test_a_steady_motion_through_two_poses_reaches_the_second():
    motion = FreeMotion(SETTINGS)
    first = SE3.from_rpy(0.1, -0.2, 0.5, t=[1.0, 2.0, 0.5])
    second = SE3(first.R @ so3_exp([0.02, -0.01, 0.15]), first.t + np.array([0.1, 0.05, -0.02]))
    ends_ns = (T0_NS, T0_NS + S_NS // 10)
    start_ns = T0_NS + S_NS // 20

    state = motion.between(SE3.stack([first, second]), ends_ns, start_ns)
    end = motion.predict(state, ends_ns[1]).end

    np.testing.assert_allclose(state.vector[:3], (first.t + second.t) / 2, atol=1e-12)
    np.testing.assert_allclose(end.T_odom_body.t, second.t, atol=1e-6)
    np.testing.assert_allclose(end.R, second.R, atol=1e-6)


def test_angular_acceleration_acts_on_an_imu_with_a_lever_arm():
    arm_m, spin_up = 0.4, 2.0
    rig = replace(RIG, T_body_imu=SE3(np.eye(3), np.array([arm_m, 0.0, 0.0])))
    t_s = np.arange(0.0, 1.0, 0.005)
    rate, zero = spin_up * t_s, np.zeros_like(t_s)
    # The body turns faster and faster where it is; its IMU is dragged along and pulled inwards.
    accel = np.stack([-arm_m * rate**2, arm_m * spin_up + zero, 9.80665 + zero], axis=1)
    gyro = np.stack([zero, zero, rate], axis=1)
    imu = ImuSamples(T0_NS + np.rint(t_s * 1e9).astype(np.int64), gyro, accel)
    state = start_of(standing, T0_NS, [0.0, 0.0, 0.0])

    end = ImuMotion(imu, rig, SETTINGS).predict(state, T0_NS + S_NS // 2).end

    np.testing.assert_allclose(end.vector[:6], 0.0, atol=1e-6)


def test_only_samples_near_the_start_determine_the_vertical():
    upright, tilted = np.array([0.0, 0.0, 9.80665]), np.array([3.0, 0.0, 9.3])
    t_ns = T0_NS + np.arange(400) * (S_NS // 200)
    accel = np.where(np.arange(400)[:, None] < 150, upright, tilted)

    state = ImuMotion(ImuSamples(t_ns, np.zeros((400, 3)), accel), RIG, SETTINGS).initial(T0_NS)

    np.testing.assert_allclose(state.R, np.eye(3), atol=1e-9)


def test_what_is_known_of_the_unit_outlives_a_new_start():
    motion = imu_motion()
    learned = motion.initial(T0_NS)
    vector, P = learned.vector.copy(), learned.P.copy()
    vector[15:24], vector[24] = 0.02, 0.015
    P[18:, 18:] = np.diag(np.repeat([2e-4, 3e-4], [9, 1]) ** 2)

    motion.remember(replace(learned, vector=vector, P=P))
    begun = motion.initial(T0_NS + S_NS)

    np.testing.assert_array_equal(begun.vector[15:], vector[15:])
    sd = np.sqrt(np.diag(begun.P))[18:]
    np.testing.assert_allclose(sd, np.repeat([1.02e-3, 5.83e-4], [9, 1]), rtol=1e-2)
    np.testing.assert_array_equal(begun.vector[:12], learned.vector[:12])


@pytest.mark.parametrize(("clock_s", "gain"), [(0.015, 0.0), (0.003, 0.02)])
def test_a_gain_that_a_walk_has_found_with_a_wrong_clock_is_found_again(clock_s, gain):
    motion = imu_motion()
    learned = motion.initial(T0_NS)
    vector, P = learned.vector.copy(), learned.P.copy()
    vector[15:24], vector[24] = 0.02, clock_s
    P[18:, 18:] = np.diag(np.repeat([2e-4, 3e-4], [9, 1]) ** 2)

    motion.remember(replace(learned, vector=vector, P=P), of_walk=True)
    begun = motion.initial(T0_NS + S_NS)

    np.testing.assert_array_equal(begun.vector[15:], np.repeat([gain, clock_s], [9, 1]))
    sd = np.sqrt(np.diag(begun.P))[18:]
    np.testing.assert_allclose(
        sd, np.repeat([1.02e-3 if gain else 1.005e-2, 5.83e-4], [9, 1]), rtol=1e-2
    )


def test_a_saturated_gyroscope_is_not_taken_for_a_measurement():
    imu = imu_of(spinning, 3.0)
    limit = 2.5
    noise = np.random.default_rng(1).normal(0.0, 1e-3, imu.accel_m_s2.shape)
    clipped = replace(
        imu,
        gyro_rad_s=np.clip(imu.gyro_rad_s, -limit, limit),
        accel_m_s2=imu.accel_m_s2 + noise,  # two samples are never alike
    )
    fast_ns = T0_NS + S_NS  # turns of 4 rad/s for a third of a second

    known = ImuMotion(imu, RIG, SETTINGS).predict(
        start_of(spinning, fast_ns, [0, 0, 0]), fast_ns + S_NS // 10
    )
    missed = ImuMotion(clipped, RIG, SETTINGS).predict(
        start_of(spinning, fast_ns, [0, 0, 0]), fast_ns + S_NS // 10
    )
    before = ImuMotion(clipped, RIG, SETTINGS).predict(
        start_of(spinning, T0_NS, [0, 0, 0]), T0_NS + S_NS // 10
    )

    wrong = np.linalg.norm(so3_log(known.end.R.T @ missed.end.R))
    stated = np.sqrt(np.diag(missed.end.P)[:3].max())
    assert wrong > np.deg2rad(5.0)
    assert wrong / 2.0 < stated < np.deg2rad(20.0)
    assert np.sqrt(np.diag(before.end.P)[:3].max()) < np.deg2rad(0.1)


def spinning(t_s):
    """Turns about z of up to 4 rad/s at one place, fastest after 1 s."""
    turns = np.zeros((len(t_s), 3))
    turns[:, 2] = 2.0 * np.tanh(2.0 * (t_s - 1.0))
    return SE3(so3_exp(turns), np.zeros((len(t_s), 3)))


def who_walks_and_stands(seconds=6.0, walking_s=3.0, still_again_s=6.0):
    """IMU samples of a body that bounces by 2 m/s² at 2 Hz, then stands."""
    t_s = np.arange(0.0, seconds, 0.005)
    accel = np.tile([0.0, 0.0, 9.80665], (len(t_s), 1))
    bounces = (t_s < walking_s) | (t_s >= still_again_s)
    accel[:, 2] += bounces * 2.0 * np.sin(4.0 * np.pi * t_s)
    return ImuSamples(T0_NS + (1e9 * t_s).astype(np.int64), np.zeros_like(accel), accel)


def rest_at(second, imu, *, speed=0.8, weak=True):
    state = start_of(standing, T0_NS, [speed, 0.0, 0.0])
    motion = ImuMotion(imu, RIG, SETTINGS)
    return motion.rest(replace(state, t_ns=T0_NS + int(1e9 * second)), weak=weak)


def test_who_walked_and_is_still_has_stopped_if_nothing_observes_the_speed():
    imu = who_walks_and_stands()

    assert rest_at(5.0, imu) is Rest.STOPPED
    assert rest_at(5.0, imu, weak=False) is Rest.MOVING
    assert rest_at(2.0, imu) is Rest.MOVING
    assert rest_at(3.2, imu) is Rest.MOVING  # the half second before had steps


def test_who_is_accelerated_evenly_has_not_stopped():
    imu = who_walks_and_stands()
    pushed = replace(imu, accel_m_s2=imu.accel_m_s2 + np.array([1.6, 0.0, 0.0]))

    assert rest_at(5.0, pushed) is Rest.MOVING


def test_who_never_walked_may_be_on_a_cart():
    assert rest_at(5.0, who_walks_and_stands(walking_s=0.0)) is Rest.MOVING


def test_a_still_body_without_speed_is_stationary_whatever_observes_it():
    imu = who_walks_and_stands(walking_s=0.0)

    assert rest_at(5.0, imu, speed=0.05, weak=False) is Rest.STATIONARY
    assert rest_at(5.0, imu, speed=0.05) is Rest.STATIONARY


@pytest.mark.parametrize("noise_m_s2", [0.0, 0.014, 0.1])
def test_noise_alone_does_not_set_a_body_in_motion(noise_m_s2):
    imu = who_walks_and_stands(walking_s=0.0)
    noise = noise_m_s2 * np.random.default_rng(1).standard_normal(imu.accel_m_s2.shape)

    noisy = replace(imu, accel_m_s2=imu.accel_m_s2 + noise)

    assert rest_at(5.0, noisy, speed=0.02) is Rest.STATIONARY


def test_who_begins_to_walk_does_not_stand_any_more():
    imu = who_walks_and_stands(walking_s=0.0)
    noise = 0.014 * np.random.default_rng(1).standard_normal(imu.accel_m_s2.shape)
    sinks = np.zeros_like(noise)
    sinks[1e-9 * (imu.t_ns - T0_NS) >= 4.8, 2] = -0.1

    begun = replace(imu, accel_m_s2=imu.accel_m_s2 + noise + sinks)

    assert rest_at(4.8, begun, speed=0.02) is Rest.STATIONARY
    assert rest_at(5.0, begun, speed=0.02) is Rest.MOVING


def test_without_an_imu_nothing_is_known_of_a_rest():
    state = start_of(standing, T0_NS, [0.0, 0.0, 0.0])

    assert FreeMotion(SETTINGS).rest(state, weak=True) is Rest.MOVING
