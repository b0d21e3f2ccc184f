"""Fixes that aid the odometry: those that jump are left out."""

import numpy as np
import pytest

from recon4.georeference.crs import GeodeticOrigin, to_geodetic
from recon4.georeference.gnss_aiding import jumping, make_gnss_aiding
from recon4.model.rig import load_rig
from recon4.model.samples import GnssSamples
from recon4.settings import OdometrySettings

COUNT = 100
T_NS = np.arange(COUNT, dtype=np.int64) * 100_000_000


def walked(speed_m_s, *, turn_rad_s=0.0, seed=1):
    """Fixes of 2 cm along a circle, or a line."""
    t_s = 0.1 * np.arange(COUNT)
    heading = turn_rad_s * t_s
    step = 0.1 * speed_m_s * np.column_stack([np.cos(heading), np.sin(heading), 0.0 * t_s])
    noise = np.random.default_rng(seed).normal(0.0, 0.02, (COUNT, 3))
    return np.cumsum(step, axis=0) + noise


@pytest.mark.parametrize("rows", [[50], [50, 51], [20, 21, 22, 70]])
def test_single_fixes_that_jump_are_found(rows):
    p = walked(1.3)
    p[rows] += [0.4, -0.3, 0.1]

    assert np.flatnonzero(jumping(p, T_NS)).tolist() == rows


@pytest.mark.parametrize(
    ("speed_m_s", "turn_rad_s"), [(0.0, 0.0), (1.3, 0.0), (1.3, 1.5), (12.0, 0.4)]
)
def test_walks_turns_and_drives_do_not_jump(speed_m_s, turn_rad_s):
    assert not jumping(walked(speed_m_s, turn_rad_s=turn_rad_s), T_NS).any()


def test_a_lasting_change_is_no_jump():
    p = walked(1.3)
    p[50:] += [2.0, 0.0, 0.0]

    assert not jumping(p, T_NS).any()


def test_few_fixes_show_no_jump():
    p = walked(1.3)
    p[3] += 1.0

    assert not jumping(p[:8], T_NS[:8]).any()


def test_the_odometry_is_not_aided_by_a_fix_that_jumps():
    p = walked(1.3)
    p[40] += [1.8, 0.0, 0.0]
    lat, lon, height = to_geodetic(GeodeticOrigin(0.8, 0.2, 300.0), p)
    quality, rpy = np.full(COUNT, 4, np.uint8), np.zeros((COUNT, 3))
    gnss = GnssSamples(T_NS, lat, lon, height, np.full((COUNT, 3), 0.02), quality, rpy)

    aiding = make_gnss_aiding(gnss, load_rig("4recon"), OdometrySettings())

    assert aiding is not None
    assert np.setdiff1d(T_NS, aiding.t_ns).tolist() == [T_NS[40]]
