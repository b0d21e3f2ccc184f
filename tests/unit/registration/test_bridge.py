"""A scan across a gap: laid onto the last scans, and only where one pose alone fits."""

import numpy as np
import pytest
from msgspec import structs

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.motion import Bridges
from recon4.geometry.se3 import SE3
from recon4.registration.bridge import RecentScans, SeenScan, sure_pose
from recon4.registration.scan_registration import lay_onto, make_scan
from recon4.registration.tuning import ScanTuning
from tests.said import texts

SCANS = ScanTuning()
UP_M = (-1.2, 1.8)
MOVED = SE3.from_rpy(0.0, 0.0, 0.4, t=[3.0, 1.5, 0.0])


def rectangle(rng, at_m, side_m, *, count):
    """Points on a vertical wall from one corner along a side, (N, 3)."""
    s, z = rng.uniform(size=count), rng.uniform(*UP_M, size=count)
    return np.column_stack([at_m + s[:, None] * np.asarray(side_m), z])


def hall(rng, *, period_m=5.0, half_m=20.0):
    """Floor and ceiling, and square columns in a grid."""
    flat = rng.uniform(-half_m, half_m, (24_000, 2))
    parts = [np.column_stack([flat, np.where(np.arange(len(flat)) % 2, *UP_M)])]
    grid = np.arange(-half_m + 0.5 * period_m, half_m, period_m)
    for corner in np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2):
        for begin, side in (
            ((0, 0), (1, 0)),
            ((1, 0), (0, 1)),
            ((1, 1), (-1, 0)),
            ((0, 1), (0, -1)),
        ):
            parts.append(rectangle(rng, corner + begin, side, count=250))
    return np.concatenate(parts)


def corridor(rng):
    """Two parallel walls and a floor, nothing else."""
    x, y = rng.uniform(-20.0, 20.0, 12_000), rng.uniform(-1.0, 1.0, 12_000)
    floor = np.column_stack([x, y, np.full_like(x, UP_M[0])])
    walls = [rectangle(rng, [-20.0, side], [40.0, 0.0], count=6000) for side in (-1.0, 1.0)]
    return np.concatenate([floor, *walls])


def marks(rng):
    """Walls that nothing else of the hall looks like."""
    sides = (([-9.0, 4.0], [7.0, 1.0]), ([6.0, -8.0], [1.0, 9.0]), ([-7.0, -6.5], [5.0, -4.0]))
    return np.concatenate([rectangle(rng, a, b, count=5000) for a, b in sides])


def seen(p_map, T_map_body, rng, *, range_m=15.0):
    """What a sensor at this pose sees of the points of a world."""
    p = T_map_body.inverse() @ (p_map + 0.005 * rng.standard_normal(p_map.shape))
    p = p[np.linalg.norm(p[:, :2], axis=1) < range_m]
    return SeenScan(make_scan(p, SCANS), p)


def found(world, T=MOVED, *, world_now=None, seed=1):
    rng = np.random.default_rng(seed)
    last = seen(world(rng), SE3.identity(), rng)
    now = seen((world_now or world)(rng), T, rng)
    return sure_pose(last.scan, now, last, initial=[SE3.identity()], settings=SCANS)


def yard(rng):
    """A floor with these walls."""
    flat = rng.uniform(-20.0, 20.0, (12_000, 2))
    return np.concatenate([np.column_stack([flat, np.full(len(flat), UP_M[0])]), marks(rng)])


def test_a_scan_meters_away_is_laid_onto_the_last_ones():
    T = found(yard)

    assert T is not None
    away = MOVED.inverse() @ T
    assert np.linalg.norm(away.t) < 0.05 and away.angle() < 0.01


@pytest.mark.parametrize("world", [hall, corridor], ids=["columns in a grid", "bare corridor"])
def test_where_several_poses_fit_none_is_sure(world):
    rng = np.random.default_rng(1)
    last, now = seen(world(rng), SE3.identity(), rng), seen(world(rng), MOVED, rng)

    best = lay_onto(last.scan, now.scan, initial=[SE3.identity()], settings=SCANS)[0]

    assert best.match_ratio > 0.3  # nothing but the other poses, or the weak direction, speaks
    assert found(world) is None


def test_a_direction_that_nothing_observes_is_not_sure():
    """Also if the only pose that is tried is the true one."""
    rng = np.random.default_rng(1)
    last, now = seen(corridor(rng), SE3.identity(), rng), seen(corridor(rng), MOVED, rng)
    one_start = structs.replace(SCANS, starts=0)

    assert sure_pose(last.scan, now, last, initial=[MOVED], settings=one_start) is None


def test_another_place_is_not_sure():
    assert found(yard, world_now=lambda rng: yard(rng) @ np.diag([1.7, 1.7, 1.0])) is None


def test_scans_from_before_are_not_joined():
    """On another storey that looks the same they would say that the body is still there."""
    rng = np.random.default_rng(1)
    old, last = seen(yard(rng), SE3.identity(), rng).scan, seen(yard(rng), MOVED, rng).scan
    recent = RecentScans(SCANS)
    recent.keep(old, SE3.identity(), 1_000)
    recent.keep(last, MOVED, 2_000)

    both = recent.joined(last, MOVED, since_ns=1_000)
    only_last = recent.joined(last, MOVED, since_ns=2_000)

    assert len(only_last) == pytest.approx(len(last), rel=0.02)
    assert len(both) > 1.1 * len(last)


def steps(bridges):
    """Columns of ``steps.npz`` in which the body stands but at bridges: time [s] and length [m]."""
    t_s = np.arange(0.0, 20.0, 0.1)
    bridged, x_m = np.zeros(len(t_s), bool), np.zeros(len(t_s))
    for at_s, length_m in bridges:
        row = round(10 * at_s)
        bridged[row] = True
        x_m[row:] += length_m
    t_m = np.stack([x_m, 0 * x_m, 0 * x_m], axis=1)
    return {
        "t_mid_ns": np.rint(1e9 * t_s).astype(np.int64),
        "lost": np.zeros(len(t_s), bool),
        "bridged": bridged,
        "t_m": t_m,
    }


def test_the_finding_says_where():
    (one,) = texts(Bridges().check(WalkRecord(steps=steps([(12.3, 2.5)]))))
    three = WalkRecord(steps=steps([(1.0, 2.0), (7.1, 8.2), (9.0, 1.0)]))
    (several,) = texts(Bridges().check(three))

    assert "once (12 s after the start, 2.5 m long)" in one
    assert "3 times (first 1 s after the start, the longest of 8.2 m at 7 s)" in several
