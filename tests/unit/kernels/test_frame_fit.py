import numpy as np

from recon4.geometry.se3 import SE3, interpolate, so3_exp
from recon4.kernels.frame_fit import corrected_poses
from recon4.kernels.imu import led_to, middle_pose, samples_at, turned
from recon4.kernels.selection import thin_near


def walked(count=12, seed=3):
    """Poses of a frame of a walk, a batch."""
    steps = 0.02 * np.random.default_rng(seed).standard_normal((count, 6))
    begin = np.array([0.3, -0.2, 1.0, 4.0, -2.0, 1.0])
    return SE3.exp(begin + np.cumsum(steps, axis=0))


def test_a_correction_turns_about_the_center_and_grows_along_the_frame():
    T, fraction = walked(), np.linspace(0.0, 1.0, 12)
    delta, center = np.random.default_rng(4).normal(0.0, 0.1, 34), T.t[-1]

    R, p = corrected_poses(fraction, T.R, T.t, delta, center)

    s = fraction[:, None]
    twist = (1.0 - s) * delta[:6] + s * delta[6:12]
    turn = so3_exp(twist[:, :3])
    np.testing.assert_allclose(R, turn @ T.R, atol=1e-14)
    arm = np.einsum("nij,nj->ni", turn, T.t - center)
    np.testing.assert_allclose(p, center + arm + twist[:, 3:], atol=1e-14)
    np.testing.assert_allclose(R @ np.swapaxes(R, 1, 2), np.tile(np.eye(3), (12, 1, 1)), atol=1e-14)


def test_the_pose_in_the_middle_is_halfway_in_time_between_two_poses():
    T, t_s = walked(), np.concatenate([[0.0], np.linspace(0.004, 0.1, 11)])

    R, p = middle_pose(t_s, T.R, T.t)

    k = np.searchsorted(t_s, 0.05) - 1
    between = interpolate(T[k], T[k + 1], (0.05 - t_s[k]) / (t_s[k + 1] - t_s[k]))
    np.testing.assert_allclose(R, between.R, atol=1e-12)
    np.testing.assert_allclose(p, between.t, atol=1e-12)


def test_a_frame_is_led_to_where_the_next_one_begins():
    T, part = walked(), np.linspace(0.0, 1.0, 12)
    end = SE3.exp([0.01, -0.02, 0.015, 0.1, 0.0, -0.1]) @ T[-1]

    R, p, turn, shift = led_to(part, T.R, T.t, end.R, end.t)

    np.testing.assert_allclose(R, so3_exp(part[:, None] * turn) @ T.R, atol=1e-12)
    np.testing.assert_allclose(p, T.t + part[:, None] * shift, atol=1e-14)
    np.testing.assert_allclose(R[-1], end.R, atol=1e-12)
    np.testing.assert_allclose(p[-1], end.t, atol=1e-14)


def test_a_rotation_that_is_turned_often_stays_one():
    R = so3_exp([0.3, -0.2, 1.0]) * (1.0 + 1e-7)

    once = turned(np.array([0.1, 0.2, -0.3]), R)

    np.testing.assert_allclose(once @ once.T, np.eye(3), atol=1e-13)
    np.testing.assert_allclose(once, so3_exp([0.1, 0.2, -0.3]) @ R, atol=1e-6)


def test_samples_are_linear_between_two_and_constant_beyond_the_ends():
    sample_ns = 1_700_000_000_000_000_000 + np.array([0, 5, 11, 30], np.int64) * 1_000_000
    values = np.random.default_rng(6).standard_normal((4, 3))
    t_ns = sample_ns[0] + np.array([-3, 0, 2, 5, 29, 30, 40], np.int64) * 1_000_000

    found = samples_at(t_ns, sample_ns, values)

    since = [(t - sample_ns[0]).astype(float) for t in (t_ns, sample_ns)]
    expected = np.stack([np.interp(*since, values[:, axis]) for axis in range(3)], axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-14)


def test_of_the_near_points_every_fourth_is_kept_in_time_or_ring_by_ring():
    rng = np.random.default_rng(5)
    xyz = rng.uniform(-5.0, 5.0, (2000, 3)).astype(np.float32)
    ring = rng.integers(0, 256, 2000).astype(np.uint8)
    sensor = rng.integers(0, 2, 2000).astype(np.uint8)

    in_time, by_ring = (thin_near(xyz, ring, sensor, 1, 2.5, 4, rings) for rings in (False, True))

    mine = np.flatnonzero(sensor == 1)
    far = np.linalg.norm(xyz[mine], axis=1) >= 2.5
    kept = mine[far | (np.arange(len(mine)) % 4 == 0)]
    np.testing.assert_array_equal(in_time, kept)
    np.testing.assert_array_equal(by_ring, kept[np.argsort(ring[kept], kind="stable")])
