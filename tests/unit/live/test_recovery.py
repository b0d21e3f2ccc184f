"""Where somebody can be who was lost: by motion, and by what was seen."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.live.mapper.last_known import LastKnown, Reach
from recon4.live.mapper.place_index import PlaceIndex
from recon4.live.mapper.recovery import Recovery
from recon4.live.mapper.tuning import LAST_KNOWN
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.settings import preset

HERE = SE3.identity()


def room(length_m, count=6000, seed=3):
    """Points of a room that is 5 m wide, with a cabinet beside its door; the sensor at (0, 0)."""
    rng = np.random.default_rng(seed)
    low, high = np.array([-2.0, -2.0, -1.2]), np.array([length_m - 2.0, 3.0, 1.3])
    p = rng.uniform(low, high, (count, 3))
    side = rng.integers(0, 6, count)
    rows = np.arange(count)
    p[rows, side // 2] = np.where(side % 2, high[side // 2], low[side // 2])
    cabinet = rng.uniform([-2.0, -1.0, -1.2], [-1.2, 0.5, 0.9], (count // 6, 3))
    cabinet[:, 0] = -1.2
    return np.concatenate([p, cabinet])


@pytest.fixture
def places():
    found = PlaceIndex(preset("indoor"))
    for x in (0.0, 1.0, 2.0):
        at = SE3(np.eye(3), np.array([x, 0.0, 0.0]))
        found.keep(at, at.inverse() @ room(6.0, seed=int(x)))
    return found


def searched(places, seen, reach, times=12):
    recovery = Recovery(places, reach)
    for _ in range(times):
        found = recovery.search(seen, HERE)
        if found is not None:
            return found
    return None


def anywhere(**known):
    return Reach(HERE, from_m=np.zeros(3), within_m=50.0, **known)


def test_who_sees_the_room_again_is_found(places):
    found = searched(places, room(6.0, seed=9), anywhere())

    np.testing.assert_allclose(found.t, 0.0, atol=0.05)


def test_a_longer_room_is_another_one(places):
    """All but one of its walls match, and one is seen through."""
    assert searched(places, room(10.0, seed=9), anywhere()) is None


def test_nobody_is_found_farther_away_than_he_can_have_walked(places):
    assert searched(places, room(6.0, seed=9), Reach(HERE, np.array([9.0, 0.0, 0.0]), 3.0)) is None


def test_a_room_that_is_turned_is_searched_where_the_gyroscope_says(places):
    R = so3_exp([0.0, 0.0, 2.0])
    seen = room(6.0, seed=9) @ R  # in the body, which has turned by 2 rad

    found = searched(places, seen, anywhere(turned=(R, 0.2)))

    np.testing.assert_allclose(found.R, R, atol=0.02)
    assert searched(places, seen, anywhere(turned=(np.eye(3), 0.2))) is None


def gyro(t_s, rate):
    t_ns = (np.asarray(t_s) * 1e9).astype(np.int64)
    return ImuSamples(t_ns, np.tile([0.0, 0.0, rate], (len(t_ns), 1)), np.zeros((len(t_ns), 3)))


@pytest.fixture
def known():
    last = LastKnown(load_rig("4recon"))
    last.extend(gyro([0.9, 1.0], 0.5))
    last.set(SE3(so3_exp([0.0, 0.0, 1.0]), np.array([4.0, 0.0, 0.0])), 1_000_000_000)
    return last


def test_reach_grows_with_the_time_and_turns_with_the_gyroscope(known):
    known.extend(gyro(np.arange(1.01, 3.005, 0.01), 0.5))

    reach = known.reach(HERE, 3_000_000_000, with_imu=True)

    assert reach.within_m == pytest.approx(LAST_KNOWN.slack_m + 2.0 * LAST_KNOWN.fastest_m_s)
    assert reach.heading()[0] == pytest.approx(2.0, abs=0.01)
    turned = so3_exp([0.0, 0.0, 2.0])
    assert reach.contains(SE3(turned, np.array([9.0, 0.0, 0.0])))
    assert not reach.contains(SE3(turned, np.array([12.0, 0.0, 0.0])))
    assert not reach.contains(SE3(so3_exp([0.0, 0.0, 1.0]), np.array([4.0, 0.0, 0.0])))


@pytest.mark.parametrize("silence", ["a hole in the samples", "an IMU that is not trusted"])
def test_without_a_gyroscope_any_heading_is_possible(known, silence):
    hole = silence.startswith("a hole")
    known.extend(gyro([1.01, 2.0 if hole else 1.02, 2.01 if hole else 1.03], 0.5))

    reach = known.reach(HERE, 3_000_000_000, with_imu=hole)

    assert reach.turned is None
    assert reach.contains(SE3(so3_exp([0.0, 0.0, 3.0]), np.array([4.0, 0.0, 0.0])))


def test_who_was_never_known_to_be_anywhere_has_no_reach():
    assert LastKnown(load_rig("4recon")).reach(HERE, 0, with_imu=False) is None
