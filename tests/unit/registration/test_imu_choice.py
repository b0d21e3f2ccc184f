"""The IMU is used if it is consistent with the LiDARs."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.samples import ImuSamples
from recon4.model.tried_hypotheses import Because
from recon4.registration import imu_choice
from recon4.registration.hypothesis import Hypothesis, ImuAssumption
from recon4.registration.imu_choice import (
    AS_RECORDED,
    TriedWindow,
    choose_imu,
    measured_turns,
    start_and_fastest_turn,
    unexplained_part,
)
from recon4.registration.motion import ImuMotion
from recon4.registration.score import Score
from recon4.settings import OdometrySettings, preset

SETTINGS = preset("indoor")


class Walk:
    """A recording with another IMU."""

    def __init__(self, frames, imu):
        self._frames, self.imu = frames, imu
        self.rig, self.t_mid_ns = frames.rig, frames.t_mid_ns

    def __len__(self):
        return len(self._frames)

    def __getitem__(self, k):
        return self._frames[k]


def windows_of(frames):
    return start_and_fastest_turn(frames.imu, frames.t_mid_ns)


def chosen(walk, **how):
    """The samples to use, and what is wrong with them."""
    found = choose_imu(walk, SETTINGS, windows_of(walk), **how).imu
    return found.samples, found.choice


def altered(frames, turn=lambda gyro: gyro, late_ns=0, force=1.0):
    imu = frames.imu
    return ImuSamples(imu.t_ns + late_ns, turn(imu.gyro_rad_s), force * imu.accel_m_s2)


def test_a_consistent_imu_is_used_unchanged(frames):
    imu, choice = chosen(frames)

    assert imu is frames.imu
    assert choice.outcome == "as recorded"


def test_the_bias_of_a_gyroscope_is_subtracted(frames):
    bias_rad_s = np.deg2rad([20.0, -5.0, -30.0])
    walk = Walk(frames, altered(frames, lambda gyro: gyro + bias_rad_s))

    imu, choice = chosen(walk)

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
@pytest.mark.study
def test_an_imu_that_contradicts_the_lidars_is_not_used(frames, fault):
    imu, choice = chosen(Walk(frames, altered(frames, **fault)))

    assert imu is None
    assert choice.outcome == "not used" and choice.with_m > choice.without_m


def test_an_imu_that_is_trusted_is_used_all_the_same(frames):
    walk = Walk(frames, altered(frames, turn=lambda gyro: 3.0 * gyro))

    assert chosen(walk, trusted=True) == (walk.imu, AS_RECORDED)


@pytest.mark.study
def test_of_an_imu_with_wrong_forces_the_gyroscope_is_used(frames):
    walk = Walk(frames, altered(frames, force=-1.0))

    imu, choice = chosen(walk)

    assert np.isnan(imu.accel_m_s2).all()
    np.testing.assert_array_equal(imu.gyro_rad_s, frames.imu.gyro_rad_s)
    assert choice.outcome == "accelerometer not used"


@pytest.mark.parametrize(("sign", "kept"), [(1.0, True), (-1.0, False)])
def test_a_gyroscope_that_explains_the_turns_is_not_dropped(monkeypatch, frames, sign, kept):
    # Errors of a walk with a LiDAR 1.4 deg off: without the IMU fewer multiframes are lost.
    motion = ImuMotion(altered(frames, lambda gyro: sign * gyro), frames.rig, SETTINGS.odometry)
    true = ImuMotion(frames.imu, frames.rig, SETTINGS.odometry)
    unexplained = unexplained_part(*measured_turns([turned(frames, true)], motion))
    worth = {Because.START: (8, 0.031), Because.LIDARS_ALONE: (1, 0.021)}
    monkeypatch.setattr(imu_choice, "_track", scored(worth, unexplained))

    imu, choice = chosen(Walk(frames, frames.imu))

    assert imu is (frames.imu if kept else None)
    assert (choice == AS_RECORDED) == kept


class Turned:
    """A step of an odometry, as far as turns are concerned."""

    lost = False

    def __init__(self, t_mid_ns, R):
        self.t_mid_ns, self.T_odom_body = t_mid_ns, SE3(R, np.zeros(3))


def turned(frames, motion):
    """Steps of an odometry that sees the turns of a gyroscope."""
    first, *later = frames.t_mid_ns[:10].tolist()
    return [Turned(first, np.eye(3)), *(Turned(t, motion.turn(first, t)) for t in later)]


def scored(worth, unexplained=0.07):
    """Tracks nothing: lost multiframes and residuals by the reason of a hypothesis."""

    def track(_, hypothesis, *, settings, windows):
        because = hypothesis.because
        key = (because, hypothesis.imu.choice.outcome) if because is Because.SETTLED else because
        lost, error_m = worth.get(key, (8, 0.031))
        score = Score(
            multiframes=9,
            lost=lost,
            residuals_m=np.full(9, error_m),
            unexplained=unexplained if because is Because.LIDARS_ALONE else None,
        )
        return imu_choice.TrackedWindows(score, None, None)

    return track


@pytest.mark.parametrize(("settled_m", "kept"), [(0.0105, True), (0.0158, False)])
def test_an_accelerometer_is_tried_again_after_it_settled(monkeypatch, frames, settled_m, kept):
    """Errors of corridor:2/3, whose second trial begins within its fastest turn."""
    worth = {
        Because.START: (0, 0.0158),
        Because.LIDARS_ALONE: (0, 0.0111),
        Because.GYROSCOPE_ALONE: (0, 0.0118),
        (Because.SETTLED, "as recorded"): (0, settled_m),
        (Because.SETTLED, "accelerometer not used"): (0, 0.0118),
    }
    monkeypatch.setattr(imu_choice, "_track", scored(worth))

    found = choose_imu(frames, SETTINGS, windows_of(frames))

    assert (found.imu.samples is frames.imu) == kept == (found.imu.choice == AS_RECORDED)
    assert [row.because for row in found.tried[-2:]] == [Because.SETTLED] * 2
    assert not any(row.whole for row in found.tried)


def test_multiframes_that_settle_do_not_count(frames):
    hypothesis = Hypothesis(because=Because.START, imu=ImuAssumption(frames.imu, AS_RECORDED))
    plain = [TriedWindow(rows) for rows in windows_of(frames)]
    settling = [imu_choice._begun_earlier(window, len(frames)) for window in plain]

    whole = imu_choice._track(frames, hypothesis, settings=SETTINGS, windows=plain).score
    settled = imu_choice._track(frames, hypothesis, settings=SETTINGS, windows=settling).score

    assert len(settled.residuals_m) == len(whole.residuals_m) == 18
    assert (whole.multiframes, settled.multiframes) == (20, 40)
    assert settling[0].rows == range(20)


def test_without_an_imu_or_with_use_imu_off_no_trial_runs(frames):
    never = replace(SETTINGS, odometry=OdometrySettings(use_imu=False))

    assert chosen(Walk(frames, None)) == (None, AS_RECORDED)
    assert choose_imu(frames, never, windows_of(frames)).tried == ()


def test_one_multiframe_is_enough(frames):
    class Single(Walk):
        def __len__(self):
            return 1

    imu, choice = chosen(Single(frames, frames.imu))

    assert imu is frames.imu
    assert choice.outcome == "as recorded"
