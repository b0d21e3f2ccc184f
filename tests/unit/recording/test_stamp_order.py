"""Messages that are recorded after those that follow them."""

import numpy as np
import pytest

from recon4.recording.clocks.stamp_order import StampOrder
from recon4.recording.info.describe import describe
from tests.builders import T0_NS, bag_path, room_cloud
from tests.robot_bags import RobotBag
from tests.unit.recording.ingested import run

PERIOD_NS = 100_000_000


def in_order(stamps):
    """Stamps as they are handed on, and how many were left out."""
    order = StampOrder()
    found = [one for k, stamp in enumerate(stamps) for one in order.push(stamp, k)]
    found += order.flush()
    return [stamp for stamp, _ in found], order.too_late


@pytest.mark.parametrize("late_by", [1, 3, 5])
def test_a_late_message_is_put_in_its_place(late_by):
    stamps = list(range(30))
    stamps.insert(12 + late_by, stamps.pop(12))

    assert in_order(stamps) == (list(range(30)), 0)


def test_a_message_later_than_many_is_left_out_and_counted():
    stamps = list(range(30))
    stamps.insert(24, stamps.pop(10))

    assert in_order(stamps) == ([k for k in range(30) if k != 10], 1)


def test_the_last_messages_may_be_late_too():
    assert in_order([0, 1, 2, 4, 5, 3]) == ([0, 1, 2, 3, 4, 5], 0)


@pytest.mark.parametrize("first", [[1, 0], [2, 3, 0, 1], [3, 0, 1, 2]])
def test_the_first_messages_may_be_late_too(first):
    later = list(range(len(first), 12))

    assert in_order([*first, *later]) == (list(range(12)), 0)


def test_after_a_clock_was_set_back_the_order_of_recording_is_kept():
    stamps = [*range(100, 120), *range(40, 60)]

    assert in_order(stamps) == (stamps, 0)


def test_late_messages_after_a_clock_was_set_back_are_put_in_their_place():
    stamps = [*range(100, 120), 40, 42, 41, *range(43, 60)]

    assert in_order(stamps) == ([*range(100, 120), *range(40, 60)], 0)


def bag_of_clouds(folder, delays_s):
    """A bag with a cloud each 0.1 s, each recorded so long after its stamp."""
    path = bag_path(folder, "mcap")
    with RobotBag(path, "mcap") as bag:
        recorded = [T0_NS + k * PERIOD_NS + round(s * 1e9) for k, s in enumerate(delays_s)]
        for k in np.argsort(recorded, kind="stable"):
            bag.recorded_ns = recorded[k]
            bag.cloud("/points", T0_NS + int(k) * PERIOD_NS, room_cloud())
    return path


def test_no_point_of_clouds_that_are_recorded_late_is_dropped(tmp_path):
    delays_s = [0.13 + 0.13 * (k % 7 == 3) for k in range(30)]

    store = run(bag_of_clouds(tmp_path, delays_s), out=tmp_path / "frames")

    assert "points_late" not in store.report["counts"]
    assert len(store) == 30
    assert {len(store[k]) for k in range(30)} == {len(room_cloud()["x"])}
    np.testing.assert_array_equal(np.diff([store[k].t_ns for k in range(30)]), PERIOD_NS)


def test_one_cloud_that_is_recorded_seconds_late_moves_no_other_one(tmp_path):
    delays_s = [0.1 + 2.0 * (k == 8) for k in range(40)]
    bag = bag_of_clouds(tmp_path, delays_s)

    store = run(bag, out=tmp_path / "frames")

    assert store.report["counts"]["clouds_late"] == 1
    assert "clock_jumps_back" not in store.report["counts"]
    assert store[len(store) - 1].t_ns == T0_NS + 39 * PERIOD_NS
    assert any("recorded after many later ones" in loss.text for loss in describe(bag).lost)
