import numpy as np

from recon4.geometry.se3 import SE3, so3_exp, so3_log
from recon4.kernels.imu import place_points, propagate, rotation
from recon4.model.trajectory import Trajectory

GRAVITY = np.array([0.0, 0.0, -9.80665])
NOISE = np.array([3e-4, 1e-2, 1e-4, 1e-3])


def state(*, p=(0, 0, 0), v=(0, 0, 0), bg=(0, 0, 0), ba=(0, 0, 0), g=GRAVITY):
    return np.concatenate([p, v, bg, ba, g]).astype(np.float64)


def carry(gyro, accel, *, t_s=None, R_start=None, state0=None, cov=None, noise=NOISE):
    t_s = np.linspace(0.0, 0.1, len(gyro)) if t_s is None else t_s
    return propagate(
        t_s,
        np.asarray(gyro, float),
        np.asarray(accel, float),
        np.eye(3) if R_start is None else R_start,
        state() if state0 is None else state0,
        np.zeros((18, 18)) if cov is None else cov,
        noise,
    )


def test_rotation_of_a_vector_is_the_exponential_map():
    for w in ([0.0, 0.0, 0.0], [1e-10, 0, 0], [0.1, -0.4, 2.0], [0, np.pi, 0]):
        np.testing.assert_allclose(rotation(np.array(w)), so3_exp(w), atol=1e-12)


def test_at_rest_nothing_moves():
    still = np.zeros((21, 3))

    R, p, v, _, _ = carry(still, still - GRAVITY)

    np.testing.assert_allclose(R[-1], np.eye(3), atol=1e-15)
    np.testing.assert_allclose(p, 0.0, atol=1e-15)
    np.testing.assert_allclose(v, 0.0, atol=1e-15)


def test_one_second_of_one_meter_per_second_squared():
    still = np.zeros((101, 3))

    _, p, v, _, _ = carry(
        still, still - GRAVITY + [1.0, 0, 0], t_s=np.linspace(0, 1, 101), state0=state(v=(0, 2, 0))
    )

    np.testing.assert_allclose(p[-1], [0.5, 2.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(v, [1.0, 2.0, 0.0], atol=1e-12)


def test_a_turn_at_constant_rate_keeps_gravity_where_it_is():
    rate = np.array([0.0, 0.0, np.pi / 2])
    gyro = np.tile(rate, (101, 1))
    accel = np.tile(-GRAVITY, (101, 1))

    R, p, _, _, _ = carry(gyro, accel, t_s=np.linspace(0, 1, 101))

    np.testing.assert_allclose(R[-1], so3_exp([0, 0, np.pi / 2]), atol=1e-12)
    np.testing.assert_allclose(p[-1], 0.0, atol=1e-12)


def test_going_round_in_a_circle():
    # 1 m around the origin at 1 rad/s, looking ahead: 1 m/s² to the left in the body.
    t_s = np.linspace(0, 1, 401)
    gyro = np.tile([0.0, 0.0, 1.0], (401, 1))
    accel = np.tile([0.0, 1.0, 0.0] - GRAVITY, (401, 1))

    _, p, v, _, _ = carry(
        gyro,
        accel,
        t_s=t_s,
        R_start=so3_exp([0, 0, np.pi / 2]),
        state0=state(p=(1, 0, 0), v=(0, 1, 0)),
    )

    np.testing.assert_allclose(p[-1], [np.cos(1), np.sin(1), 0], atol=1e-5)
    np.testing.assert_allclose(v, [-np.sin(1), np.cos(1), 0], atol=1e-5)


def test_biases_are_subtracted():
    gyro, accel = np.tile([0.1, 0.2, -0.1], (21, 1)), np.tile([0.3, 0.0, 9.0], (21, 1))

    R, p, v, _, _ = carry(
        gyro, accel, state0=state(bg=(0.1, 0.2, -0.1), ba=[0.3, 0, 9.0 - 9.80665])
    )

    np.testing.assert_allclose(R[-1], np.eye(3), atol=1e-15)
    np.testing.assert_allclose([p[-1], v], 0.0, atol=1e-14)


def test_the_motion_does_not_depend_on_where_the_world_is():
    rng = np.random.default_rng(1)
    gyro, accel = rng.normal(0, 1, (21, 3)), rng.normal(0, 2, (21, 3))
    W, t = so3_exp([0.3, -1.0, 2.0]), np.array([5.0, -3.0, 1.0])
    here = state(p=(1, 2, 3), v=(0.3, 0, 1))
    there = state(p=W @ here[:3] + t, v=W @ here[3:6], g=W @ GRAVITY)

    R_here, p1, v1, _, _ = carry(gyro, accel, state0=here)
    R_there, p2, v2, _, _ = carry(gyro, accel, state0=there, R_start=W)

    np.testing.assert_allclose(R_there, W @ R_here, atol=1e-12)
    np.testing.assert_allclose(p2, p1 @ W.T + t, atol=1e-12)
    np.testing.assert_allclose(v2, W @ v1, atol=1e-12)


def test_the_transition_is_the_derivative():
    rng = np.random.default_rng(2)
    gyro, accel = rng.normal(0, 1.5, (21, 3)), rng.normal(0, 3, (21, 3)) - GRAVITY
    R_start, start = so3_exp([0.2, -0.5, 1.0]), state(v=(1, 0, 0), bg=(0.01, 0, 0), ba=(0, 0.1, 0))

    def end(delta):
        R, p, v, _, _ = carry(
            gyro, accel, R_start=so3_exp(delta[:3]) @ R_start, state0=start + delta[3:]
        )
        return R[-1], p[-1], v

    R_end, p_end, v_end = end(np.zeros(18))
    Phi = carry(gyro, accel, R_start=R_start, state0=start)[3]
    h = 1e-5
    numeric = np.zeros((18, 18))
    for k in range(18):
        R, p, v = end(h * np.eye(18)[k])
        rest = h * np.eye(18)[k][9:]
        numeric[:, k] = np.concatenate([so3_log(R @ R_end.T), p - p_end, v - v_end, rest]) / h

    np.testing.assert_allclose(Phi, numeric, atol=2e-3)
    assert np.abs(Phi - np.eye(18)).max() > 0.1


def test_the_transition_by_scale_axes_and_clock_is_the_derivative():
    t_s = np.linspace(0.0, 0.1, 101)
    gain = 0.01 * np.arange(-4.0, 5.0)
    start = np.concatenate([state(v=(1, 0, 0)), gain, [0.002]])
    noise = np.append(NOISE, [1e-5, 1e-4])

    def end(delta):
        whole = start + delta
        phase = np.outer(t_s + whole[24], [9.0, 7.0, 5.0]) + np.arange(3.0)
        samples = np.sin(phase), 2.0 * np.cos(phase) - GRAVITY
        return propagate(t_s, *samples, np.eye(3), whole, np.zeros((28, 28)), noise)

    R_end, p_end, v_end, Phi, P = end(np.zeros(25))
    h = 1e-6
    for k in range(15, 25):
        R, p, v, _, _ = end(h * np.eye(25)[k])
        numeric = np.concatenate([so3_log(R[-1] @ R_end[-1].T), p[-1] - p_end[-1], v - v_end]) / h
        # The first part of a row of the gain turns the force within a step: of second order.
        np.testing.assert_allclose(Phi[:9, k + 3], numeric, atol=5e-3)
        np.testing.assert_array_equal(Phi[9:, k + 3], np.eye(28)[9:, k + 3])
        assert np.abs(numeric[:3]).max() > 0.02
    walked = np.sqrt(0.1) * np.repeat([1e-5, 1e-4], [9, 1])
    np.testing.assert_allclose(np.sqrt(np.diag(P)[18:]), walked)


def test_uncertainty_grows_as_the_densities_say():
    still = np.zeros((201, 3))

    _, _, _, _, P = carry(still, still - GRAVITY, t_s=np.linspace(0, 1, 201))

    sd = np.sqrt(np.diag(P)).reshape(6, 3)
    np.testing.assert_allclose(sd[0], 3e-4, rtol=0.05)
    np.testing.assert_allclose(sd[2, 2], 1e-2, rtol=0.05)
    np.testing.assert_allclose(sd[1, 2], 1e-2 / np.sqrt(3), rtol=0.05)
    np.testing.assert_allclose(sd[3], 1e-4, rtol=1e-6)
    np.testing.assert_allclose(sd[4], 1e-3, rtol=1e-6)
    np.testing.assert_allclose(sd[5], 0.0, atol=1e-12)
    np.testing.assert_allclose(P, P.T, atol=1e-15)


def test_covariance_of_one_step_computed_by_hand():
    still = np.zeros((2, 3))

    cov = carry(still, still - GRAVITY, t_s=np.array([0.0, 0.1]))[4]

    # Integrated white noise of density q: q² dt, q² dt²/2, q² dt³/3.
    assert np.isclose(cov[8, 8], 1e-4 * 0.1)
    assert np.isclose(cov[5, 8], 1e-4 * 0.1**2 / 2)
    assert np.isclose(cov[5, 5], 1e-4 * 0.1**3 / 3)


def test_without_noise_certainty_stays():
    still = np.zeros((21, 3))

    assert not carry(still, still, noise=np.zeros(4))[4].any()


# -- placing points


def poses(count=12, seed=5):
    rng = np.random.default_rng(seed)
    t_ns = np.cumsum(rng.integers(1_000_000, 9_000_000, count)).astype(np.int64)
    steps = SE3.exp(rng.normal(0, 0.08, (count, 6)))
    T = [SE3.from_rpy(0.3, -0.2, 2.0, t=[5.0, 4.0, 3.0])]
    for k in range(count - 1):
        T.append(T[-1] @ steps[k])
    return Trajectory(t_ns, SE3.stack(T))


def test_each_point_is_placed_by_the_pose_at_its_time():
    trajectory = poses()
    rng = np.random.default_rng(3)
    points = rng.normal(0, 20, (500, 3))
    t_ns = rng.integers(trajectory.t_ns[0], trajectory.t_ns[-1] + 1, 500)
    T = trajectory.T_a_b

    placed = place_points(trajectory.t_ns * 1e-9, T.R, T.t, t_ns * 1e-9, points)

    np.testing.assert_allclose(placed, trajectory.at(t_ns) @ points, atol=1e-7)


def test_half_way_computed_by_hand():
    T = SE3.stack([SE3.identity(), SE3.from_rpy(0, 0, 0.4, t=[1.0, 0, 0])])

    placed = place_points(np.array([0.0, 0.1]), T.R, T.t, np.array([0.05]), np.array([[2.0, 0, 0]]))

    np.testing.assert_allclose(placed, [[0.5 + 2 * np.cos(0.2), 2 * np.sin(0.2), 0.0]], atol=1e-9)


def test_no_point_gives_no_point():
    T = poses().T_a_b

    placed = place_points(np.arange(12.0), T.R, T.t, np.empty(0), np.empty((0, 3)))

    assert placed.shape == (0, 3)
