"""Clocks of the sensors of a bag, and single messages with the stamp of another time."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.model.finding_kinds import CLOCK_DOUBTS
from recon4.recording.clocks.compare import clock_offset_s, warn_of_free_clocks
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from tests.builders import T0_NS, Bag, noisy, room_cloud
from tests.unit.recording.ingested import run
from tests.unit.recording.packet_builders import rig, sensor
from tests.warned import K, kinds, warned, words

STEP_NS = 100_000_000
BOOT_NS = 60_000_000_000


class RecordedBag(Bag):
    """A bag whose messages are recorded at other times than their stamps."""

    def __init__(self, path, recorded):
        super().__init__(path, "mcap")
        self.recorded = recorded

    def write(self, topic, kind, t_ns, message):
        super().write(topic, kind, self.recorded(topic, t_ns), message)


def write_bag(folder, *, imu_ahead_ns=0, fix_ahead_ns=0, t0_ns=T0_NS, stamps=None, recorded=None):
    """1.5 s of clouds at 10 Hz, IMU at 100 Hz and fixes at 5 Hz; ``stamps`` of some clouds."""
    ahead = {"/imu": imu_ahead_ns, "/fix": fix_ahead_ns}
    usual = recorded or (lambda topic, t_ns: t_ns - ahead.get(topic, 0) - t0_ns + T0_NS)
    table = room_cloud()
    path = folder / "bag"
    with RecordedBag(path, usual) as bag:
        for k in range(15):
            t_ns = t0_ns + k * STEP_NS
            stamp_ns = (stamps or {}).get(k, t_ns)
            bag.recorded = lambda topic, _, t_ns=t_ns: usual(topic, t_ns) + STEP_NS
            bag.cloud("/points", stamp_ns, table)
            bag.recorded = usual
            for m in range(10):
                gyro, accel = (noisy((0.0, 0.0, z), 10 * k + m) for z in (0.1, 9.8))
                bag.imu("/imu", t_ns + m * 10_000_000 + imu_ahead_ns, gyro, accel)
            if k % 2:
                bag.fix("/fix", t_ns + fix_ahead_ns, 50.0, 14.0, 300.0)
    return path


@pytest.mark.parametrize(
    ("ahead_s", "looks", "remedy"),
    [
        (18, "gps-utc", "= -18.000"),
        (-37, "tai-utc", "= 37.000"),
        (3600, "time-zone", "= -3600.000"),
        (-1_790_000_000, "power-on", "= about 1790000000"),
    ],
)
def test_an_imu_on_another_clock_is_not_used_and_the_remedy_is_said(
    tmp_path, ahead_s, looks, remedy
):
    t0_ns = 1_800_000_000_000_000_000
    path = write_bag(tmp_path, imu_ahead_ns=ahead_s * 10**9, t0_ns=t0_ns)

    store = run(path, out=tmp_path / "o")

    assert store.imu is None
    for where in (store.report, describe(path)):
        assert warned(where, K.CLOCK_FOREIGN, what="IMU", table="imu", looks=looks)
        assert f"Give [imu] time_offset_s {remedy}" in words(where)


def test_with_the_offset_in_the_rig_the_imu_is_used_without_a_word(tmp_path):
    path = write_bag(tmp_path, imu_ahead_ns=18 * 10**9)
    given = replace(rig(sensor(topic="/points")), imu_time_offset_s=-18.0)

    store = run(path, out=tmp_path / "o", rig=given)

    assert len(store.imu) == 150
    assert abs(int(store.imu.t_ns[0]) - T0_NS) < STEP_NS
    assert CLOCK_DOUBTS.isdisjoint(kinds(store.report))


def test_positions_on_another_clock_are_said_too(tmp_path):
    path = write_bag(tmp_path, fix_ahead_ns=18 * 10**9)

    store = run(path, out=tmp_path / "o")

    assert store.gnss is None and store.imu is not None
    assert warned(store.report, K.CLOCK_FOREIGN, what="GNSS", table="gnss", offset_s=-18.0)


def test_sensors_that_all_count_from_power_on_are_one_clock(tmp_path):
    path = write_bag(tmp_path, t0_ns=BOOT_NS)

    store = run(path, out=tmp_path / "o")

    assert len(store.imu) == 150 and CLOCK_DOUBTS.isdisjoint(kinds(store.report))
    assert store[0].t_ns == BOOT_NS
    assert CLOCK_DOUBTS.isdisjoint(kinds(describe(path)))


def test_a_converted_bag_says_nothing_of_clocks(tmp_path):
    """All messages of one topic were written at once."""
    start = {"/points": T0_NS, "/imu": T0_NS + 50 * 10**9, "/fix": T0_NS + 90 * 10**9}
    path = write_bag(tmp_path, recorded=lambda topic, t_ns: start[topic] + (t_ns - T0_NS) // 1000)

    store = run(path, out=tmp_path / "o")

    assert len(store.imu) == 150 and CLOCK_DOUBTS.isdisjoint(kinds(store.report))


@pytest.mark.parametrize("wrong_ns", [0, 5 * 10**9, 2_147_483_647 * 10**9, T0_NS - 86_400 * 10**9])
@pytest.mark.parametrize("which", [(0,), (7,), (3, 4), (14,)])
def test_single_clouds_with_the_stamp_of_another_time_stay_in_their_place(
    tmp_path, wrong_ns, which
):
    path = write_bag(tmp_path, stamps=dict.fromkeys(which, wrong_ns))

    store = run(path, out=tmp_path / "o")

    starts = np.array([store[k].t_ns for k in range(len(store))])
    assert len(store) >= 14 and np.ptp(starts) <= 15 * STEP_NS
    assert np.abs(starts - T0_NS).max() <= 15 * STEP_NS
    name = "stamps_missing" if wrong_ns == 0 else "stamps_wrong"
    assert store.report["counts"][name] == len(which)
    assert "gaps" not in store.report["counts"]


def test_single_imu_samples_of_another_time_are_dropped_and_counted():
    clock = StampClock([(T0_NS, T0_NS), (5, T0_NS + 1), (T0_NS + 2, T0_NS + 2)])

    sound = [clock.is_sound(T0_NS + k + (k == 5) * 10**12, T0_NS + k) for k in range(10)]

    assert sound == [k != 5 for k in range(10)]


def test_a_clock_that_is_set_for_good_is_followed():
    clock = StampClock([(T0_NS, T0_NS)])

    sound = [clock.is_sound(k + 10**12, k + 10) for k in range(5)]

    assert sound == [False, False, True, True, True]


def test_clocks_are_compared_by_when_messages_were_recorded():
    report = ImportReport()
    for _ in range(5):
        report.note_lag("LiDAR", 100_000_000)
        report.note_lag("IMU", -18_000_000_000)

    assert clock_offset_s("IMU", report) == pytest.approx(18.1)
    assert np.isnan(clock_offset_s("GNSS", report))


@pytest.mark.parametrize(
    ("imu_lag_ns", "imu_file", "values"),
    [
        (2_000_000, False, None),
        (-400_000_000, False, {"unknown": False, "ahead_s": 0.401}),
        (None, False, None),
        (None, True, {"unknown": True}),
    ],
)
def test_a_lidar_without_gps_is_warned_of_where_its_imu_may_be_on_another_clock(
    imu_lag_ns, imu_file, values
):
    report = ImportReport()
    report.count("clock_runs_freely_lidar")
    for _ in range(5):
        report.note_lag("LiDAR", 1_000_000)
        if imu_lag_ns is not None:
            report.note_lag("IMU", imu_lag_ns)

    warn_of_free_clocks(report, imu_file=imu_file)

    assert len(report.findings) == (values is not None)
    assert values is None or warned(report, K.CLOCK_FREE_IMU, sensors="lidar", **values)


def test_a_lidar_with_gps_and_an_imu_file_are_not_warned_of():
    report = ImportReport()

    warn_of_free_clocks(report, imu_file=True)

    assert report.findings == []
