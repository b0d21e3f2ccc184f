"""Every point by the pose at its own time."""

import numpy as np
import pytest

from recon4.errors import ConfigError, OutOfRange
from recon4.geometry.se3 import SE3
from recon4.mapping.undistort import place, place_with_origins
from recon4.model.multiframe import Multiframe
from recon4.model.rig import load_rig
from recon4.model.trajectory import Trajectory
from tests.room_walks import rig_of


def frame_of(xyz, dt_ns, sensor=None, t_ns=1_700_000_000_000_000_000):
    n = len(xyz)
    return Multiframe(
        frame_id=3,
        t_ns=t_ns,
        duration_ns=100_000_000,
        xyz=np.asarray(xyz, dtype=np.float32).reshape(n, 3),
        intensity=np.zeros(n, np.uint16),
        ring=np.zeros(n, np.uint8),
        sensor=np.zeros(n, np.uint8) if sensor is None else np.asarray(sensor, np.uint8),
        echo=np.zeros(n, np.uint8),
        dt_ns=np.asarray(dt_ns, np.int32),
    )


def walk(t_ns, rng, *, rate_hz=100.0, seconds=0.2):
    """A backpack that sways and turns at 250 deg/s."""
    t_s = np.arange(0.0, seconds, 1.0 / rate_hz)
    xi = rng.normal(size=6) * [0.3, 0.3, 0, 0.1, 0.1, 0.1]
    twists = np.sin(8 * t_s)[:, None] * xi + t_s[:, None] * [0, 0, 4.4, 1.4, 0.2, 0.0]
    return Trajectory(t_ns - 50_000_000 + (t_s * 1e9).astype(np.int64), SE3.exp(twists))


def test_a_point_half_way_between_two_poses_is_moved_half_way():
    frame = frame_of([[1.0, 0.0, 0.0]], [50_000_000])
    T_map_body = SE3.stack([SE3.identity(), SE3.from_rpy(0, 0, np.pi / 2, t=[2.0, 0, 0])])
    trajectory = Trajectory(np.array([frame.t_ns, frame.t_ns + 100_000_000]), T_map_body)

    p_map = place(frame, trajectory, rig_of(SE3.identity()))

    np.testing.assert_allclose(p_map, [[1 + np.sqrt(0.5), np.sqrt(0.5), 0]], atol=1e-12)


def test_thousands_of_points_agree_with_interpolating_each_pose():
    rng = np.random.default_rng(4)
    rig = rig_of(
        SE3.from_rpy(0.1, 0.2, 0.3, t=[0.1, 0, 0.4]), SE3.from_rpy(1.5, 0, 0, t=[0, 0.2, 0])
    )
    n = 5000
    dt_ns = np.concatenate([np.sort(rng.integers(0, 100_000_000, n // 2)) for _ in range(2)])
    frame = frame_of(rng.uniform(-60, 60, (n, 3)), dt_ns, np.repeat([0, 1], n // 2))
    trajectory = walk(frame.t_ns, rng)

    placed = place_with_origins(frame, trajectory, rig)

    T_map_sensor = (
        trajectory.at(frame.t_ns + frame.dt_ns.astype(np.int64)) @ rig.T_body_sensor[frame.sensor]
    )
    assert np.abs(placed.xyz_m - T_map_sensor @ frame.xyz.astype(float)).max() < 5e-4
    np.testing.assert_allclose(placed.origin_m, T_map_sensor.t, atol=1e-5)
    np.testing.assert_array_equal(placed.xyz_m, place(frame, trajectory, rig))


def test_order_of_points_does_not_matter():
    rng = np.random.default_rng(5)
    frame = frame_of(rng.normal(size=(500, 3)), rng.integers(-1_000_000, 99_000_000, 500))
    trajectory, rig = walk(frame.t_ns, rng), rig_of(SE3.identity())
    mixed = rng.permutation(500)

    p_map = place(frame.take(mixed), trajectory, rig)

    np.testing.assert_array_equal(p_map, place(frame, trajectory, rig)[mixed])


def test_a_trajectory_with_one_pose_per_frame_is_extrapolated_by_half_a_frame():
    frame = frame_of([[0.0, 0, 0], [0.0, 0, 0]], [0, 100_000_000])
    T_map_body = SE3(
        np.broadcast_to(np.eye(3), (2, 3, 3)).copy(), np.array([[0, 0, 0], [1.0, 0, 0]])
    )
    trajectory = Trajectory(np.array([frame.t_mid_ns, frame.t_mid_ns + 100_000_000]), T_map_body)

    p_map = place(frame, trajectory, rig_of(SE3.identity()))

    np.testing.assert_allclose(p_map[:, 0], [-0.5, 0.5], atol=1e-9)


def test_a_frame_the_trajectory_does_not_cover_is_refused():
    frame = frame_of([[1.0, 0, 0]], [0])
    far = Trajectory(np.array([0, 10**9]), SE3.identity(2))

    with pytest.raises(OutOfRange, match="outside the trajectory"):
        place(frame, far, rig_of(SE3.identity()))


def test_points_of_a_sensor_the_rig_lacks_are_refused():
    frame = frame_of([[1.0, 0, 0]], [0], [1])

    with pytest.raises(ConfigError, match=r"sensor 1, but rig 'test' has 1"):
        place(frame, walk(frame.t_ns, np.random.default_rng(0)), rig_of(SE3.identity()))


def test_an_empty_frame_has_no_points():
    frame = frame_of(np.empty((0, 3)), [])

    assert place(frame, walk(frame.t_ns, np.random.default_rng(0)), load_rig("4recon")).shape == (
        0,
        3,
    )
