"""Clocks of stamps that are set by less than ten seconds, and messages that are held up."""

import numpy as np
import pytest

from recon4.recording.clocks.stamps import StampClock
from recon4.recording.info.describe import describe
from recon4.units import SECOND_NS
from tests.builders import T0_NS, Bag, bag_path, noisy, room_cloud
from tests.robot_bags import RobotBag
from tests.unit.recording.ingested import run
from tests.warned import K, warned, words

TABLE = room_cloud()
SHADE = TABLE["intensity"]


def write_bag(path, set_s):
    """4 s of clouds and IMU; the clock of a topic is set in the middle, that of recording never."""
    with Bag(path, "mcap") as bag:
        for k in range(400):
            bag.recorded_ns = T0_NS + k * SECOND_NS // 100
            late_ns = {topic: round(s * SECOND_NS) * (k >= 200) for topic, s in set_s.items()}
            gyro, accel = (noisy((0.0, 0.0, z), k) for z in (0.1, 9.8))
            bag.imu("/imu", bag.recorded_ns + late_ns.get("/imu", 0), gyro, accel)
            if k % 10 == 0:
                stamp_ns = bag.recorded_ns + late_ns.get("/points", 0)
                bag.cloud("/points", stamp_ns, TABLE | {"intensity": np.full_like(SHADE, k)})
    return path


@pytest.mark.parametrize(
    "set_s",
    [
        {"/points": 0.5},
        {"/points": -0.3},
        {"/imu": 0.5},
        {"/imu": -0.3},
        {"/imu": 1.5, "/points": 1.5},
        {"/imu": -0.2, "/points": -0.2},
    ],
    ids=str,
)
def test_stamps_that_step_while_messages_arrive_evenly_go_on_without_it(tmp_path, set_s):
    store = run(write_bag(tmp_path / "bag", set_s), out=tmp_path / "o")

    assert np.ptp(np.diff(store.index["t_ns"])) < 1_000_000 and len(store) == 40
    np.testing.assert_allclose(np.diff(store.imu.t_ns), 10_000_000, atol=1_000_000)
    assert warned(store.report, K.CLOCK_JUMP, whose="sensor", times="without-it")
    assert store.report["counts"]["clock_jumps"] == 1
    assert not store.report["gaps"]


def held_up(rng, hz, *, queue):
    """Stamps and times of recording of a minute; a busy recorder keeps the newest of a queue."""
    stamps = T0_NS + np.arange(60 * hz) * SECOND_NS // hz
    recorded = stamps + rng.exponential(0.004 * SECOND_NS, len(stamps)).astype(np.int64)
    kept = np.ones(len(stamps), np.bool_)
    for start_ns in T0_NS + (rng.uniform(2.0, 58.0, 12) * SECOND_NS).astype(np.int64):
        end_ns = start_ns + int(rng.uniform(0.05, 1.5) * SECOND_NS)
        rows = np.flatnonzero((recorded >= start_ns) & (recorded < end_ns))
        recorded[rows] = end_ns + np.arange(len(rows)) * 200_000
        dropped = rows[:-queue] if rng.random() < 0.5 else rows[queue:]
        kept[dropped] = False
    recorded = np.maximum.accumulate(recorded[kept])
    return zip(stamps[kept].tolist(), recorded.tolist(), strict=True)


@pytest.mark.parametrize("queue", [2, 10, 1000])
@pytest.mark.parametrize("hz", [5, 10, 100, 400])
def test_messages_that_are_held_up_or_dropped_set_no_clock(hz, queue):
    for seed in range(20):
        times = list(held_up(np.random.default_rng(seed), hz, queue=queue))
        clock = StampClock(times[:9])

        unsound = [stamp for stamp, recorded in times if not clock.is_sound(stamp, recorded)]

        assert clock.shift_ns == 0 and not unsound


def test_a_clock_that_is_set_while_messages_are_held_up_now_and_then_is_found():
    found = []
    for seed in range(20):
        times = list(held_up(np.random.default_rng(seed), 100, queue=1000))
        clock, set_ns = StampClock(times[:9]), T0_NS + 30 * SECOND_NS
        for stamp, recorded in times:
            clock.is_sound(stamp + SECOND_NS // 2 * (stamp > set_ns), recorded)
        found.append(clock.shift_ns)

    assert np.mean(np.abs(np.array(found) + SECOND_NS // 2) < 50_000_000) > 0.8


@pytest.mark.parametrize("ahead_s", [0.0, 0.1, 0.3, -3.0])
def test_two_lidars_whose_clocks_differ_are_named(tmp_path, ahead_s):
    path = bag_path(tmp_path, "mcap")
    with RobotBag(path, "mcap") as bag:
        bag.tf(*(("base_link", name, (0, 0, z, 0, 0, 0, 1)) for z, name in enumerate("ab", 1)))
        for k in range(40):
            for bag.frame, late_s in (("a", 0.0), ("b", ahead_s)):
                bag.recorded_ns = T0_NS + k * SECOND_NS // 10
                stamp_ns = bag.recorded_ns + round(late_s * SECOND_NS)
                bag.cloud(f"/{bag.frame}", stamp_ns, TABLE | {"intensity": np.full_like(SHADE, k)})

    for where in (run(path, out=tmp_path / "o").report, describe(path)):
        said = warned(where, K.CLOCK_LIDARS, sensor="/b", other="/a")
        assert said == (abs(ahead_s) > 0.25)
        assert not said or f"Give /b time_offset_s = about {-ahead_s:.3f}" in words(where)
