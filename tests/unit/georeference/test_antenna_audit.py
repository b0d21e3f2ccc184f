"""The audit of lever arm and clock of a GNSS receiver, on walks with known errors."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.placing import Antenna
from recon4.geometry.se3 import SE3
from recon4.georeference.antenna_audit import (
    audit_antenna,
    coarse_clock_s,
    turn_by_antenna,
)
from recon4.georeference.crs import GeodeticOrigin, to_geodetic
from recon4.model.figures import AntennaFigures, LevelFigures
from recon4.model.rig import Rig, load_rig
from recon4.model.samples import GnssSamples
from recon4.model.trajectory import Trajectory
from tests.said import texts

PLACE = GeodeticOrigin(np.deg2rad(49.2), np.deg2rad(16.6), 250.0)
RIG = replace(load_rig("4recon"), p_body_antenna=np.array([-0.3, 0.1, 0.8]))


def walk(seconds: float = 60.0, *, turns: bool = True) -> Trajectory:
    """True poses at 50 Hz: a person who sways, turns and stops, or a cart that goes straight on."""
    t = np.arange(0.0, seconds, 0.02)
    yaw = 1.5 * np.sin(0.15 * t) if turns else np.zeros_like(t)
    speed = 1.3 * np.clip(1.5 * np.sin(0.2 * t) + 0.7, 0.0, 1.0) if turns else np.full_like(t, 1.3)
    step = 0.02 * speed[:, None] * np.stack([np.cos(yaw), np.sin(yaw), 0 * t], axis=1)
    sway = (0.035 if turns else 0.0) * np.stack([np.sin(5.7 * t), np.sin(11.3 * t)], axis=1)
    T = SE3.stack(
        SE3.from_rpy(roll, pitch, angle, t=place)
        for (roll, pitch), angle, place in zip(sway, yaw, np.cumsum(step, axis=0), strict=True)
    )
    return Trajectory((t * 1e9).astype(np.int64) + 10**18, T)


def fixes(true: Trajectory, *, late_s: float = 0.0) -> GnssSamples:
    """RTK fixes at 10 Hz with noise of 8 and 15 mm; ``late_s``: the receiver's clock is ahead."""
    rng = np.random.default_rng(3)
    t_ns = np.arange(true.t_ns[0] + 10**8, true.t_ns[-1] - 10**8, 10**8)
    p = true.at(t_ns) @ np.tile(RIG.p_body_antenna, (len(t_ns), 1))
    p += rng.standard_normal(p.shape) * [0.008, 0.008, 0.015]
    lat, lon, height = to_geodetic(PLACE, p)
    sd_m = np.tile([0.008, 0.008, 0.015], (len(t_ns), 1))
    quality = np.full(len(t_ns), 4, np.uint8)
    stamps = t_ns + round(1e9 * late_s)
    return GnssSamples(stamps, lat, lon, height, sd_m, quality, np.full((len(t_ns), 3), np.nan))


def drifting(true: Trajectory) -> Trajectory:
    """The walk as odometry sees it: 5 mm/sqrt(s) of drift."""
    rng = np.random.default_rng(5)
    drift = np.cumsum(0.005 * np.sqrt(0.02) * rng.standard_normal((len(true), 3)), axis=0)
    return Trajectory(true.t_ns, SE3(true.T_a_b.R, true.T_a_b.t + drift))


def said(found: AntennaFigures) -> list[str]:
    """What is said of an antenna."""
    level = LevelFigures(leveled_by="imu", tilt_deg=0.0, crs="EPSG:1", local="", antenna=found)
    return texts(Antenna().check(WalkRecord(level=level)))


def audit(true: Trajectory, gnss: GnssSamples, rig: Rig = RIG) -> AntennaFigures:
    found = audit_antenna(drifting(true), gnss, rig, origin=PLACE)
    assert found is not None
    return found


def test_a_right_rig_is_not_contradicted() -> None:
    true = walk()

    assert said(audit(true, fixes(true))) == []


@pytest.mark.parametrize("error", [(0.1, 0.0, 0.0), (0.0, -0.1, 0.0), (0.03, 0.02, 0.15)])
def test_a_wrong_lever_arm_is_measured_and_named(error: tuple[float, ...]) -> None:
    true = walk()
    wrong = replace(RIG, p_body_antenna=RIG.p_body_antenna + error)

    found = audit(true, fixes(true), wrong)

    off = np.array(found.arm_m) + error
    assert np.all(np.abs(off) < np.maximum(3.0 * np.array(found.arm_sd_m), 0.01))
    assert np.linalg.norm(off[:2]) < 0.02
    (text,) = said(found)
    assert "the antenna differs from it by x" in text


@pytest.mark.parametrize("late_s", [0.05, -0.1])
def test_a_clock_that_is_off_is_measured_and_named(late_s: float) -> None:
    true = walk()

    found = audit(true, fixes(true, late_s=late_s))

    assert found.clock_s == pytest.approx(-late_s, abs=0.01)
    (text,) = said(found)
    assert f"their clock differs by {1e3 * found.clock_s:.0f} ms" in text


def test_a_cart_that_goes_straight_on_shows_no_lever_arm_and_says_so() -> None:
    true = walk(turns=False)

    (text,) = said(audit(true, fixes(true)))

    assert "could not be checked" in text


def test_a_single_gross_error_changes_little() -> None:
    true = walk()
    gnss = fixes(true)
    gnss.height_m[100] += 3.0
    gnss.lat_rad[200] += 1e-6  # six meters

    assert said(audit(true, gnss)) == []


def test_few_or_coarse_fixes_are_not_compared() -> None:
    true = walk()
    coarse = fixes(true)
    coarse.sd_enu_m[:] = 0.5
    few = fixes(walk(4.0))

    assert audit_antenna(true, coarse, RIG, origin=PLACE) is None
    assert audit_antenna(walk(4.0), few, RIG, origin=PLACE) is None


def test_an_error_of_the_antenna_turns_the_map_that_is_fitted_to_the_fixes() -> None:
    """Worked out by a fit of the walk to the places of the wrong antenna."""
    true = walk(20.0)
    error = AntennaFigures(
        arm_m=(-0.15, 0.02, 0.0), arm_sd_m=(0.01, 0.01, 0.01), arm_sigmas=15.0,
        clock_s=-0.1, clock_sd_s=0.001, fixes=190,
    )  # fmt: skip
    T = true.T_a_b
    late = true.at(np.clip(true.t_ns - 10**8, true.t_ns[0], None)).t
    seen = T.R @ np.array(error.arm_m) + late
    place, seen = T.t - T.t.mean(axis=0), seen - seen.mean(axis=0)
    U, _, Vt = np.linalg.svd(place[:, :2].T @ seen[:, :2])
    R = (U @ Vt).T

    turn = turn_by_antenna(true, error)

    assert abs(turn) > 0.005
    assert turn == pytest.approx(np.arctan2(R[1, 0], R[0, 0]), rel=0.05)
    assert turn_by_antenna(true, replace_error(error, arm_m=(0.0, 0.0, 0.3))) == pytest.approx(
        0.0, abs=1e-3
    )


def replace_error(error: AntennaFigures, *, arm_m: tuple[float, float, float]) -> AntennaFigures:
    """Another lever arm, and a clock that is right."""
    return msgspec.structs.replace(error, arm_m=arm_m, clock_s=0.0)


@pytest.mark.parametrize("late_s", [18.0, -18.0, 1.0, 7.3])
def test_a_clock_that_is_off_by_seconds_is_found_by_the_shape_of_the_walk(late_s):
    true = walk(90.0)

    found = audit(true, fixes(true, late_s=late_s))

    assert found.clock_s == pytest.approx(-late_s, abs=0.01)
    (text,) = said(found)
    assert f"their clock differs by {-late_s:.2f} s" in text
    assert ("GPS time is 18 s ahead of UTC" in text) == (abs(late_s) == 18.0)


def test_a_straight_walk_at_one_speed_shows_no_clock():
    true = walk(90.0, turns=False)

    found = audit(true, fixes(true, late_s=5.0))

    assert abs(found.clock_s) < 0.5


def test_ways_across_gaps_between_fixes_are_not_taken_for_straight():
    """Between fixes at 8 to 16 s and 24 to 32 s of a walk along a street with corners."""
    t = np.arange(0.0, 40.0, 0.02)
    corners = np.random.default_rng(6).choice([-1, 0, 1], size=10)
    yaw = np.repeat(0.5 * np.pi * np.cumsum(corners), 200)
    step = 0.02 * 1.2 * np.stack([np.cos(yaw), np.sin(yaw), 0.0 * t], axis=1)
    still = SE3.identity(len(t)).R
    true = Trajectory((t * 1e9).astype(np.int64), SE3(still, np.cumsum(step, axis=0)))
    t_ns = true.t_ns[::5]
    t_ns = t_ns[t_ns // 8_000_000_000 % 2 == 1]
    noise_m = np.random.default_rng(1).normal(0.0, 0.01, (len(t_ns), 2))

    assert coarse_clock_s(true, t_ns, true.at(t_ns).t[:, :2] + noise_m) == 0.0


def test_a_clock_that_leaves_out_poor_fixes_is_not_taken_for_better():
    """Out along a street and back at the same speed; the fixes on the second half are poor."""
    t = np.arange(0.0, 44.0, 0.02)
    leg_s = t % 22.0
    speed = 1.2 * np.clip(np.minimum(leg_s, 22.0 - leg_s) - 1.0, 0.0, 1.0)
    x = np.cumsum(0.02 * np.where(t < 22.0, speed, -speed))
    still = SE3.identity(len(t)).R
    true = Trajectory((t * 1e9).astype(np.int64), SE3(still, np.outer(x, [1.0, 0.0, 0.0])))
    t_ns = true.t_ns[::5]
    sd_m = np.where(t_ns < 22_000_000_000, 0.01, 0.2)
    noise_m = sd_m[:, None] * np.random.default_rng(1).standard_normal((len(t_ns), 2))

    assert coarse_clock_s(true, t_ns, true.at(t_ns).t[:, :2] + noise_m) == 0.0
