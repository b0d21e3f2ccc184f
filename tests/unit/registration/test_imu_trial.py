"""The IMU is used if it is consistent with the LiDARs."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.model.odometry_figures import ImuChoice
from recon4.model.samples import ImuSamples
from recon4.registration import imu_consistency
from recon4.registration.imu_consistency import Trial, consistent_imu
from recon4.registration.motion import ImuMotion
from recon4.settings import OdometrySettings, preset

SETTINGS = preset("indoor")

AS_RECORDED = ImuChoice(outcome="as recorded")


class Walk:
    """A recording with another IMU."""

    def __init__(self, frames, imu):
        self._frames, self.imu = frames, imu
        self.rig, self.t_mid_ns = frames.rig, frames.t_mid_ns

    def __len__(self):
        return len(self._frames)

    def __getitem__(self, k):
        return self._frames[k]


def altered(frames, turn=lambda gyro: gyro, late_ns=0, force=1.0):
    imu = frames.imu
    return ImuSamples(imu.t_ns + late_ns, turn(imu.gyro_rad_s), force * imu.accel_m_s2)


def test_a_consistent_imu_is_used_unchanged(frames):
    imu, choice = consistent_imu(frames, SETTINGS)

    assert imu is frames.imu
    assert choice.outcome == "as recorded"


def test_the_bias_of_a_gyroscope_is_subtracted(frames):
    bias_rad_s = np.deg2rad([20.0, -5.0, -30.0])
    walk = Walk(frames, altered(frames, lambda gyro: gyro + bias_rad_s))

    imu, choice = consistent_imu(walk, SETTINGS)

    assert np.allclose(imu.gyro_rad_s, frames.imu.gyro_rad_s, atol=np.deg2rad(1.0))
    assert choice.outcome == "bias removed"
    assert np.rad2deg(choice.bias_rad_s) == pytest.approx([20.0, -5.0, -30.0], abs=1.0)


@pytest.mark.parametrize(
    "fault",
    [
        {"turn": lambda gyro: gyro * [1.0, 1.0, -1.0]},
        {"turn": lambda gyro: gyro * 3.0},
        {"late_ns": 300_000_000},
    ],
    ids=["an axis the wrong way", "a wrong unit", "a late clock"],
)
def test_an_imu_that_contradicts_the_lidars_is_not_used(frames, fault):
    imu, choice = consistent_imu(Walk(frames, altered(frames, **fault)), SETTINGS)

    assert imu is None
    assert choice.outcome == "not used" and choice.with_m > choice.without_m


def test_an_imu_that_is_trusted_is_used_all_the_same(frames):
    walk = Walk(frames, altered(frames, turn=lambda gyro: 3.0 * gyro))

    assert consistent_imu(walk, SETTINGS, trusted=True) == (walk.imu, AS_RECORDED)


def test_of_an_imu_with_wrong_forces_the_gyroscope_is_used(frames):
    walk = Walk(frames, altered(frames, force=-1.0))

    imu, choice = consistent_imu(walk, SETTINGS)

    assert np.isnan(imu.accel_m_s2).all()
    np.testing.assert_array_equal(imu.gyro_rad_s, frames.imu.gyro_rad_s)
    assert choice.outcome == "accelerometer not used"


@pytest.mark.parametrize(("sign", "kept"), [(1.0, True), (-1.0, False)])
def test_a_gyroscope_that_explains_the_turns_is_not_dropped(monkeypatch, frames, sign, kept):
    # Errors of a walk with a LiDAR 1.4 deg off: without the IMU fewer multiframes are lost.
    motion = ImuMotion(altered(frames, lambda gyro: sign * gyro), frames.rig, SETTINGS.odometry)
    spans = [(first, first + 100_000_000) for first in frames.t_mid_ns[:10].tolist()]
    turns = [(first, last, motion.turn(first, last)) for first, last in spans]
    rotated = Trial(8, 0.031, turns)
    monkeypatch.setattr(
        imu_consistency,
        "_try",
        lambda _, imu, __, **settling: Trial(1, 0.021, turns) if imu is None else rotated,
    )

    imu, choice = consistent_imu(Walk(frames, frames.imu), SETTINGS)

    assert imu is (frames.imu if kept else None)
    assert (choice == AS_RECORDED) == kept


@pytest.mark.parametrize(("settled_m", "kept"), [(0.0105, True), (0.0158, False)])
def test_an_accelerometer_is_tried_again_after_it_settled(monkeypatch, frames, settled_m, kept):
    """Errors of corridor:2/3, whose second trial begins within its fastest turn."""
    asked = []

    def trial(_, imu, __, *, settling=0):
        asked.append(settling)
        if imu is None:
            return Trial(0, 0.0111, [])
        if np.isnan(imu.accel_m_s2).all():
            return Trial(0, 0.0118, [])
        return Trial(0, settled_m if settling else 0.0158, [])

    monkeypatch.setattr(imu_consistency, "_try", trial)
    monkeypatch.setattr(Trial, "unexplained", lambda *_: 0.07)

    imu, choice = consistent_imu(frames, SETTINGS)

    assert (imu is frames.imu) == kept == (choice == AS_RECORDED)
    assert max(asked) == 10


def test_multiframes_that_settle_do_not_count(frames):
    whole = imu_consistency._try(frames, frames.imu, SETTINGS)
    settled = imu_consistency._try(frames, frames.imu, SETTINGS, settling=10)

    assert len(settled.turns) == len(whole.turns) == 18
    first_ns = int(frames.t_mid_ns[0])
    assert whole.turns[0][0] == first_ns
    assert settled.turns[0][0] == int(frames.t_mid_ns[10])


def test_without_an_imu_or_with_use_imu_off_no_trial_runs(frames):
    never = replace(SETTINGS, odometry=OdometrySettings(use_imu=False))

    assert consistent_imu(Walk(frames, None), SETTINGS) == (None, AS_RECORDED)
    assert consistent_imu(frames, never) == (frames.imu, AS_RECORDED)


def test_one_multiframe_is_enough(frames):
    class Single(Walk):
        def __len__(self):
            return 1

    imu, choice = consistent_imu(Single(frames, frames.imu), SETTINGS)

    assert imu is frames.imu
    assert choice.outcome == "as recorded"
