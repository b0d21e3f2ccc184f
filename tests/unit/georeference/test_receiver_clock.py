"""The clock of a GNSS/INS by the turns that the gyroscope measures, too."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.georeference.gnss_aiding import make_gnss_aiding, receiver_clock_s
from recon4.georeference.ins_attitudes import attitudes
from recon4.model.rig import Rig, load_rig
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.settings import OdometrySettings

RIG = load_rig("4recon")
START_NS = 1_780_308_000_000_000_000


def angles(t_s: Array, sway: float) -> Array:
    """Roll, pitch, heading (NED) of a person who sways and walks along a bend [rad], (N, 3)."""
    return np.stack(
        [sway * np.sin(5.6 * t_s), sway * np.sin(11.3 * t_s + 1.0), 0.6 + 0.3 * np.sin(0.4 * t_s)],
        axis=1,
    )


def gyro(t_s: Array, sway: float) -> Array:
    R = attitudes(angles(t_s, sway))
    step = np.median(np.diff(t_s))
    turns = SE3(np.swapaxes(R[:-1], 1, 2) @ R[1:], np.zeros((len(R) - 1, 3))).log()[:, :3]
    return np.vstack([turns, turns[-1:]]) / step


def recorded(
    *, late_s: float = 0.0, sway: float = 0.035, seconds: float = 20.0, bias: float = 0.01
) -> tuple[GnssSamples, ImuSamples]:
    """A gyroscope at 200 Hz with a bias, and attitudes at 10 Hz with the noise of an INS."""
    rng = np.random.default_rng(7)
    t_s = np.arange(0.0, seconds, 0.005)
    rate = gyro(t_s, sway) + bias + 0.003 * rng.standard_normal((len(t_s), 3))
    R_imu_body = RIG.T_body_imu.R.T
    stamps = START_NS + np.rint(1e9 * t_s).astype(np.int64)
    imu = ImuSamples(stamps, rate @ R_imu_body.T, np.tile([0.0, 0.0, 9.81], (len(t_s), 1)))
    at_s = np.arange(0.0, seconds, 0.1)
    rpy = angles(at_s, sway) + np.deg2rad([0.03, 0.03, 0.06]) * rng.standard_normal((len(at_s), 3))
    t_ns = START_NS + np.rint(1e9 * (at_s + late_s)).astype(np.int64)
    one = np.ones(len(at_s))
    gnss = GnssSamples(
        t_ns, 0.85 * one, 0.29 * one, 270.0 * one, 0.01 * np.ones((len(at_s), 3)),
        np.full(len(at_s), GnssQuality.RTK_FIXED, np.uint8), rpy,
    )  # fmt: skip
    return gnss, imu


def found_s(gnss: GnssSamples, imu: ImuSamples, rig: Rig = RIG) -> float:
    return receiver_clock_s(gnss.t_ns, attitudes(gnss.rpy_ned_rad), imu=imu, rig=rig)


@pytest.mark.parametrize("late_s", [0.1, -0.1, 0.05, 0.34])
def test_a_clock_that_is_off_is_found(late_s: float) -> None:
    assert found_s(*recorded(late_s=late_s)) == pytest.approx(-late_s, abs=0.006)


@pytest.mark.parametrize("late_s", [0.0, 0.02, -0.02])
def test_a_clock_in_order_or_nearly_so_is_left_alone(late_s: float) -> None:
    assert found_s(*recorded(late_s=late_s)) == 0.0


def test_a_cart_that_hardly_turns_shows_no_clock() -> None:
    gnss, imu = recorded(late_s=0.1, sway=0.0)
    straight = np.tile(gnss.rpy_ned_rad[:1], (len(gnss), 1))
    noise = 1e-3 * np.random.default_rng(1).standard_normal(straight.shape)
    still = ImuSamples(imu.t_ns, np.zeros_like(imu.gyro_rad_s), imu.accel_m_s2)

    assert receiver_clock_s(gnss.t_ns, attitudes(straight + noise), imu=still, rig=RIG) == 0.0


def test_another_imu_than_that_of_the_body_shows_no_clock() -> None:
    gnss, imu = recorded(late_s=0.1)
    turned = ImuSamples(imu.t_ns, imu.gyro_rad_s @ so3_exp(np.array([0, 0, 2.0])), imu.accel_m_s2)

    assert found_s(gnss, turned) == 0.0
    assert found_s(*recorded(late_s=0.1, seconds=4.0)) == 0.0  # too short
    assert found_s(gnss, ImuSamples(imu.t_ns[:1], imu.gyro_rad_s[:1], imu.accel_m_s2[:1])) == 0.0


def test_odometry_is_aided_at_the_times_of_the_gyroscope() -> None:
    gnss, imu = recorded(late_s=0.1)

    blind, seen = (make_gnss_aiding(gnss, RIG, OdometrySettings(), imu=one) for one in (None, imu))

    assert blind is not None and seen is not None
    np.testing.assert_array_equal(blind.t_ns, gnss.t_ns)
    off_s = (seen.t_ns - gnss.t_ns) / 1e9
    np.testing.assert_allclose(off_s, -0.1, atol=0.006)
