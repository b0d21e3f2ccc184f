from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, Array
from recon4.georeference.floor import level_by_floor
from recon4.georeference.level import level, level_by_attitude, level_by_gravity, tilt_to
from recon4.model.rig import Rig, load_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory

TILT = SE3.from_rpy(np.deg2rad(4.0), np.deg2rad(-7.0), np.deg2rad(100.0), t=[3.0, -2.0, 1.0])
"""T_odom_level: how the odometry's frame hangs in the simulated walks."""


def walk(seconds: float = 60.0, rate_hz: float = 100.0) -> Trajectory:
    """Level frame: around a rectangle of rooms, bouncing and swaying."""
    t = np.arange(0.0, seconds, 1.0 / rate_hz)
    yaw = 0.3 * t + 0.5 * np.sin(0.7 * t)
    p = np.stack(
        [
            8 * np.sin(0.1 * t) + 0.02 * np.sin(6 * t),
            5 * np.sin(0.2 * t),
            1.2 + 0.03 * np.sin(12.0 * t),
        ],
        1,
    )
    roll, pitch = 0.05 * np.sin(6.0 * t), 0.1 + 0.04 * np.cos(12.0 * t)
    T = SE3.stack(
        SE3.from_rpy(r, q, y, t=x) for r, q, y, x in zip(roll, pitch, yaw, p, strict=True)
    )
    return Trajectory((t * 1e9).astype(np.int64) + 10**18, T)


def tilted(trajectory: Trajectory) -> Trajectory:
    return Trajectory(trajectory.t_ns, TILT @ trajectory.T_a_b)


def imu_of(true: Trajectory, rig: Rig, *, bias: Array, noise: float = 0.0) -> ImuSamples:
    """Specific force at the IMU, by differences of the true positions."""
    T = true.T_a_b @ rig.T_body_imu
    dt = np.diff(true.t_ns[:2])[0] / 1e9
    acceleration = (T.t[2:] - 2 * T.t[1:-1] + T.t[:-2]) / dt**2 + [0.0, 0.0, 9.81]
    R = T.R[1:-1]
    force = np.einsum("nji,nj->ni", R, acceleration) + bias
    force += noise * np.random.default_rng(1).normal(size=force.shape)
    return ImuSamples(true.t_ns[1:-1], np.zeros_like(force), force)


def tilt_error_deg(T_level_odom: SE3, T_odom_level: SE3 = TILT) -> float:
    up = (T_level_odom @ T_odom_level).R[:, 2]
    return float(np.rad2deg(np.arccos(np.clip(up[2], -1, 1))))


def gnss_of(true: Trajectory, rpy_ned_rad: Array) -> GnssSamples:
    n = len(true)
    return GnssSamples(
        true.t_ns,
        np.full(n, np.nan),
        np.full(n, np.nan),
        np.full(n, np.nan),
        np.full((n, 3), np.nan),
        np.zeros(n, dtype=np.uint8),
        rpy_ned_rad,
    )


def rpy_ned(T_enu_imu: SE3) -> Array:
    """Roll, pitch, heading as an INS reports them: x forward, y right, z down, from north."""
    swap = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])
    return SE3(swap @ T_enu_imu.R @ np.diag([1.0, -1, -1]), T_enu_imu.t).rpy()


def test_up_along_x_is_turned_by_pitch_alone() -> None:
    T = tilt_to(np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0))

    np.testing.assert_allclose(T.rpy(), [0.0, -np.pi / 4, 0.0], atol=1e-12)
    np.testing.assert_allclose(T @ np.array([1.0, 0, 1.0]), [0, 0, np.sqrt(2.0)], atol=1e-12)


def test_leveling_has_no_heading_and_no_shift() -> None:
    rng = np.random.default_rng(1)

    for up in rng.normal(size=(20, 3)):
        T = tilt_to(up / np.linalg.norm(up))

        np.testing.assert_allclose(T.R @ up / np.linalg.norm(up), [0, 0, 1], atol=1e-12)
        assert T.rpy()[2] == pytest.approx(0.0, abs=1e-12)
        assert not T.t.any()


def test_gravity_is_found_under_steps_turns_noise_and_bias() -> None:
    rig, true = load_rig("4recon"), walk()
    imu = imu_of(true, rig, bias=np.array([0.05, -0.04, 0.03]), noise=0.05)

    leveling = level_by_gravity(tilted(true), imu, rig)

    assert tilt_error_deg(leveling.T_level_odom) < 0.05
    assert leveling.source == "imu"
    assert 50 <= leveling.pairs + leveling.trimmed <= 60
    assert np.rad2deg(leveling.spread_rad) < 1.0


def test_a_speed_change_is_not_taken_for_gravity() -> None:
    rig = load_rig("4recon")
    t = np.arange(0.0, 20.0, 0.01)
    p = np.stack([0.25 * t**2, 0 * t, 0 * t], 1)  # 0.5 m/s² for 20 s would tilt by 2.9 degrees
    true = Trajectory((t * 1e9).astype(np.int64), SE3(np.tile(np.eye(3), (len(t), 1, 1)), p))

    leveling = level_by_gravity(true, imu_of(true, rig, bias=np.zeros(3)), rig)

    assert np.rad2deg(leveling.tilt_rad) < 0.3


def test_shaken_seconds_are_trimmed() -> None:
    rig, true = load_rig("4recon"), walk()
    imu = imu_of(true, rig, bias=np.zeros(3), noise=0.02)
    imu.accel_m_s2[1000:1400] += [30.0, 0.0, 0.0]

    leveling = level_by_gravity(tilted(true), imu, rig)

    assert tilt_error_deg(leveling.T_level_odom) < 0.1
    assert leveling.trimmed >= 4


def test_a_turned_imu_levels_all_the_same() -> None:
    rig = replace(load_rig("4recon"), T_body_imu=SE3.from_rpy(np.pi, 0.2, 0.7, t=[0.1, 0.0, -0.2]))
    true = walk()

    leveling = level_by_gravity(tilted(true), imu_of(true, rig, bias=np.zeros(3)), rig)

    assert tilt_error_deg(leveling.T_level_odom) < 0.05


def test_attitudes_of_an_ins_level_by_the_texts_equations() -> None:
    rig, true = load_rig("4recon"), walk()
    rng = np.random.default_rng(2)
    rpy = rpy_ned(true.T_a_b @ rig.T_body_imu) + np.deg2rad(1.0) * rng.normal(size=(len(true), 3))
    rpy[:, 2] = rng.uniform(-3, 3, len(true))  # indoors the heading means nothing
    rpy[::7] = np.nan

    leveling = level_by_attitude(tilted(true), gnss_of(true, rpy), rig)

    assert tilt_error_deg(leveling.T_level_odom) < 0.1
    assert leveling.source == "ins"
    assert np.rad2deg(leveling.spread_rad) == pytest.approx(np.sqrt(2.0), rel=0.1)


@pytest.mark.parametrize("of_body", [True, False])
def test_gravity_tells_whether_attitudes_are_of_the_body_or_of_a_turned_imu(of_body) -> None:
    rig = replace(load_rig("4recon"), T_body_imu=SE3.from_rpy(0.5 * np.pi, 0.0, 0.0, t=[0] * 3))
    true = walk()
    T = true.T_a_b if of_body else true.T_a_b @ rig.T_body_imu
    imu = imu_of(true, rig, bias=np.zeros(3))

    leveling = level(tilted(true), imu, rig, gnss=gnss_of(true, rpy_ned(T)))

    assert leveling.source == "ins"
    assert tilt_error_deg(leveling.T_level_odom) < 0.1


def test_without_any_source_nothing_is_turned() -> None:
    rig, true = load_rig("4recon"), walk(5.0)
    silent = ImuSamples(true.t_ns, np.zeros((len(true), 3)), np.full((len(true), 3), np.nan))

    for imu in (None, silent):
        leveling = level(true, imu, rig)

        assert leveling.source == "none"
        assert leveling.tilt_rad == 0.0
        assert leveling.record().spread_deg is None


def floor_points(rng: np.random.Generator, tilt: SE3) -> tuple[Array, Array]:
    """Floor, table, walls and a ramp around a sensor 1.5 m up, two storeys."""
    n = 20_000
    floor = np.c_[rng.uniform(-6, 6, (n, 2)), rng.normal(0, 0.01, n)]
    upstairs = floor + np.array([0.0, 0.0, 3.0])
    wall = np.c_[rng.uniform(-6, 6, n), np.full(n, 4.0), rng.uniform(0, 3, n)]
    ramp = np.c_[rng.uniform(0, 2, (n // 4, 2)), np.zeros(n // 4)] + [3.0, 3.0, 0.2]
    ramp[:, 2] += 0.15 * ramp[:, 0]
    p = np.concatenate([floor, upstairs, wall, ramp])
    origin = np.zeros_like(p)
    origin[:, 2] = 1.5
    origin[n : 2 * n, 2] = 4.5
    return tilt @ p, tilt @ origin


def test_the_dominant_floor_levels_a_map_without_imu() -> None:
    tilt = SE3.from_rpy(np.deg2rad(3.0), np.deg2rad(-2.0), 0.5, t=[1.0, 2.0, 3.0])
    p, origin = floor_points(np.random.default_rng(3), tilt)

    leveling = level_by_floor(p, origin)

    assert tilt_error_deg(leveling.T_level_odom, tilt) < 0.01
    assert leveling.source == "floor"


@pytest.mark.parametrize("step_m", [0.03, 0.12])
def test_a_threshold_or_kerb_along_the_walk_tilts_no_map(step_m: float) -> None:
    tilt = SE3.from_rpy(np.deg2rad(3.0), np.deg2rad(-2.0), 0.5, t=[1.0, 2.0, 3.0])
    rng = np.random.default_rng(5)
    p = np.c_[rng.uniform(-20, 20, 40_000), rng.uniform(-4, 4, 40_000), rng.normal(0, 0.01, 40_000)]
    p[p[:, 1] > 0.0, 2] += step_m
    origin = np.c_[p[:, 0], np.zeros(len(p)), np.full(len(p), 1.5)]

    leveling = level_by_floor(tilt @ p, tilt @ origin)

    assert tilt_error_deg(leveling.T_level_odom, tilt) < 0.02


def test_without_floor_nothing_is_turned() -> None:
    p, origin = floor_points(np.random.default_rng(4), SE3.identity())

    assert level_by_floor(p, p).source == "none"
    assert level_by_floor(p[:0], origin[:0]).source == "none"
