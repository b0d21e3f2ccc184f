"""Lever arm and clock of a GNSS receiver, corrected only if other parts of the walk confirm it."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.georeference.antenna_audit import audit_antenna
from recon4.georeference.antenna_calibration import calibrate_antenna
from recon4.georeference.tuning import GnssTuning
from recon4.model.calibration_figures import GnssOutcome
from tests.unit.georeference.test_antenna_audit import PLACE, RIG, drifting, fixes, walk

ARM = np.array([0.09, -0.08, 0.07])
WRONG = replace(RIG, p_body_antenna=RIG.p_body_antenna + ARM)


def with_attitudes(gnss, true, *, late_s):
    """The fixes with roll, pitch and heading of an INS whose stamps are ``late_s`` ahead."""
    rng = np.random.default_rng(8)
    roll, pitch, yaw = true.at(gnss.t_ns - round(1e9 * late_s)).rpy().T
    rpy = np.stack([roll, -pitch, 0.5 * np.pi - yaw], axis=1)
    return replace(gnss, rpy_ned_rad=rpy + 5e-4 * rng.standard_normal(rpy.shape))


def calibrate(true, gnss, rig=RIG):
    found = calibrate_antenna(drifting(true), gnss, rig, imu=None, settings=GnssTuning())
    assert found is not None
    return found


def status(found):
    return [row.status for row in found.rows]


def test_a_lever_arm_and_a_clock_that_are_off_are_corrected():
    true = walk()
    gnss = with_attitudes(fixes(true, late_s=0.05), true, late_s=0.05)

    found = calibrate(true, gnss, WRONG)

    assert found.refusal is None
    assert status(found)[:2] == ["off", "off"]
    off_m = np.abs(found.rig.p_body_antenna - RIG.p_body_antenna)
    assert np.all(off_m[:2] < 0.03)
    assert found.rig.gnss_time_offset_s == pytest.approx(-0.05, abs=0.001)
    error = np.array([row.change for row in found.rows]) - [*-ARM, -0.05]
    assert np.all(np.abs(error) < 3.0 * np.array([row.sd for row in found.rows]))


def test_attitudes_tell_the_clock_ten_times_better_than_positions():
    true = walk()
    gnss = fixes(true, late_s=0.05)

    alone = audit_antenna(drifting(true), gnss, RIG, origin=PLACE)
    found = audit_antenna(
        drifting(true), with_attitudes(gnss, true, late_s=0.05), RIG, origin=PLACE
    )

    assert alone is not None
    assert found is not None
    assert found.clock_sd_s < 0.2 * alone.clock_sd_s


def test_attitudes_with_a_latency_of_their_own_are_left_out():
    true = walk()
    gnss = with_attitudes(fixes(true), true, late_s=0.09)

    found = audit_antenna(drifting(true), gnss, RIG, origin=PLACE)

    assert found is not None
    assert abs(found.clock_s) < 0.01


def test_a_receiver_that_is_right_stays():
    true = walk()

    found = calibrate(true, with_attitudes(fixes(true), true, late_s=0.0))

    assert not found.is_off
    assert np.array_equal(found.rig.p_body_antenna, RIG.p_body_antenna)
    assert found.rig.gnss_time_offset_s == RIG.gnss_time_offset_s


def test_a_cart_that_goes_straight_on_shows_no_lever_arm():
    true = walk(turns=False)
    gnss = with_attitudes(fixes(true), true, late_s=0.0)

    found = calibrate(true, gnss, WRONG)

    assert status(found)[:3] == ["not observable"] * 3
    assert np.array_equal(found.rig.p_body_antenna, WRONG.p_body_antenna)


def test_a_clock_that_jumps_again_and_again_is_refused():
    true = walk()
    gnss = with_attitudes(fixes(true), true, late_s=0.0)
    odd = (gnss.t_ns - gnss.t_ns[0]) // 8_000_000_000 % 2 == 1
    jumping = replace(gnss, t_ns=gnss.t_ns + np.where(odd, 100_000_000, 20_000_000))

    found = calibrate(true, jumping)

    assert found.is_off
    assert found.refusal.outcome in (GnssOutcome.OTHER_VALUES, GnssOutcome.NO_BETTER)


def test_fixes_without_a_walk_around_them_say_nothing():
    true = walk(20.0)
    gnss = fixes(true)

    none = calibrate_antenna(drifting(true), None, RIG, imu=None, settings=GnssTuning())
    coarse = replace(gnss, quality=np.ones(len(gnss), np.uint8))

    assert none is None
    assert calibrate_antenna(drifting(true), coarse, RIG, imu=None, settings=GnssTuning()) is None
