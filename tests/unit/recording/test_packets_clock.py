"""Microseconds past the hour become absolute times, whatever the clocks do."""

from itertools import pairwise

import numpy as np
import pytest

from recon4.recording.packets.hours import nearest_hour
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4.units import HOUR_NS, SECOND_NS
from tests.unit.recording.packet_builders import LATENCY_NS, T0_NS
from tests.warned import K, derivations, warned

PACKET_NS = 1_327_104


def packets(count, *, t0_ns=T0_NS, off_ns=0, drift=0.0):
    """True times, times of arrival, and stamps of a clock that is off and drifts."""
    t_ns = t0_ns + PACKET_NS * np.arange(count)
    jitter = np.random.default_rng(0).integers(0, 400_000, count)
    sensor_ns = t_ns + off_ns + np.rint(drift * (t_ns - t0_ns)).astype(np.int64)
    return t_ns, t_ns + LATENCY_NS + jitter, sensor_ns % HOUR_NS // 1000


def push_all(clock, arrival, stamps, *, batch=75):
    parts = [
        clock.push(arrival[at : at + batch], stamps[at : at + batch])
        for at in range(0, len(stamps), batch)
    ]
    t_ns, kept = (np.concatenate(column) for column in zip(*parts, strict=True))
    return t_ns, kept


def a_clock(report=None, **fields):
    return SensorClock("lidar", packet_s=PACKET_NS / 1e9, report=report or ImportReport(), **fields)


def test_the_hour_nearest_to_the_arrival_is_taken():
    assert nearest_hour(
        np.array([0, 3_599_999_999]), np.array([HOUR_NS - 5, HOUR_NS + 5])
    ).tolist() == [
        HOUR_NS,
        HOUR_NS - 1000,
    ]


def test_a_synchronized_sensor_keeps_its_own_time_to_the_microsecond():
    t_ns, arrival, stamps = packets(1000)
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert kept.all()
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)
    assert not report.findings


@pytest.mark.parametrize("off_ns", [0, 417 * SECOND_NS], ids=["synchronized", "free running"])
def test_the_times_do_not_depend_on_how_the_packets_are_batched(off_ns):
    _, arrival, stamps = packets(30_000, off_ns=off_ns, drift=5e-5)
    rng = np.random.default_rng(3)
    cuts = np.concatenate([[0, 700], 700 + np.cumsum(rng.integers(1, 90, 800)), [30_000]])
    cuts = np.unique(cuts[cuts <= 30_000])
    clock = a_clock()

    whole, _ = a_clock().push(arrival, stamps)
    parts = [clock.push(arrival[a:b], stamps[a:b])[0] for a, b in pairwise(cuts.tolist())]

    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_the_stamp_may_wrap_at_the_full_hour():
    hour = (T0_NS // HOUR_NS + 1) * HOUR_NS
    t_ns, arrival, stamps = packets(1000, t0_ns=hour - 500 * PACKET_NS)

    out, kept = push_all(a_clock(), arrival, stamps)

    assert kept.all()
    assert stamps[0] > stamps[-1]
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)


def test_a_free_running_sensor_is_shifted_to_the_clock_of_the_recorder():
    t_ns, arrival, stamps = packets(1000, off_ns=-1_430_577_000_000)
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert kept.all()
    # Known up to the shortest way of a packet: 1.5 ms here, of which 1.327 are the packet itself.
    assert np.abs(out - t_ns - (LATENCY_NS - PACKET_NS)).max() < 50_000
    np.testing.assert_array_equal(np.diff(out), np.diff(stamps) * 1000)
    assert report.findings == []
    assert derivations(report) == [
        "lidar: its clock is -1430.579 s off the recorder's and no GPS drives it: its times are "
        "shifted to the recorder's clock."
    ]


def test_two_free_running_sensors_agree_after_the_shift():
    out = [
        push_all(a_clock(), *packets(1000, off_ns=off)[1:])[0]
        for off in (-1_430_577_000_000, 777_000_050_000)
    ]

    assert np.abs(out[0] - out[1]).max() < 100_000


def test_the_drift_of_a_free_running_sensor_is_followed():
    t_ns, arrival, stamps = packets(100_000, off_ns=50 * SECOND_NS, drift=6e-5)

    out, kept = push_all(a_clock(), arrival, stamps)

    error = out - t_ns
    assert kept.all()
    assert np.all(np.diff(out) > 0)
    # Without following it would be 8 ms after these 133 s.
    assert np.abs(error[20_000:] - (LATENCY_NS - PACKET_NS)).max() < 1_500_000
    assert abs(error[-1] - error[60_000]) < 300_000


def test_gps_tells_the_hour_when_the_recorder_is_hours_off():
    t_ns, arrival, stamps = packets(500)
    late = 2 * HOUR_NS + 123 * SECOND_NS
    report = ImportReport()
    clock = a_clock(report, utc_offset_ns=-late)

    out, kept = push_all(clock, arrival + late, stamps)

    assert kept.all()
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)
    assert clock.is_utc
    assert "+7323.002 s off UTC" in derivations(report)[0]


@pytest.mark.parametrize("count", [1000, 4000], ids=["at the end", "in the middle"])
@pytest.mark.parametrize("jump_s", [-7200.0, -1234.5, -3.0, 3.0, 3600.0, 5000.0])
def test_a_jump_of_the_recorders_clock_is_not_taken_over(jump_s, count):
    t_ns, arrival, stamps = packets(count)
    arrival[500:] += round(jump_s * 1e9)
    report = ImportReport()
    clock = a_clock(report)

    out, kept = push_all(clock, arrival, stamps)
    if count == 1000:
        clock.finish()

    assert kept.all()
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)
    assert report.counts["clock_jumps"] == 1
    assert warned(report, K.CLOCK_JUMP, whose="recorder")
    assert report.recorder_jumps_ns["lidar"] == [pytest.approx(jump_s * 1e9, abs=1e6)]


@pytest.mark.parametrize("jump_s", [-600.0, -1.5, 1.5, 900.0])
def test_a_jump_of_the_sensors_clock_leaves_the_times_continuous(jump_s):
    t_ns, arrival, stamps = packets(1000)
    stamps[500:] = (stamps[500:] + round(jump_s * 1e6)) % 3_600_000_000
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert kept.sum() == 993
    assert np.abs(out - t_ns)[kept].max() < 1_000_000
    assert np.all(np.diff(out[kept]) > 0)
    assert report.counts["clock_jumps"] == report.counts["clock_jumps_of_lidar"] == 1
    assert warned(report, K.CLOCK_JUMP, whose="sensor")


def test_single_damaged_stamps_are_dropped_without_moving_the_clock():
    t_ns, arrival, stamps = packets(1000)
    rows = np.arange(30, 1000, 90)
    stamps[rows] = np.random.default_rng(5).integers(0, 3_600_000_000, len(rows))
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert np.flatnonzero(~kept).tolist() == rows.tolist()
    np.testing.assert_array_equal(out[kept], (t_ns // 1000 * 1000)[kept])
    assert report.counts["clock_jumps"] == 0


def test_a_pause_of_45_minutes_is_a_pause():
    _, arrival, stamps = packets(1000)
    pause = 45 * 60 * SECOND_NS
    arrival[500:] += pause
    stamps[500:] = (stamps[500:] + pause // 1000) % 3_600_000_000

    out, kept = push_all(a_clock(), arrival, stamps)

    assert kept.all()
    assert out[500] - out[499] == pytest.approx(pause + PACKET_NS, abs=2000)


def test_a_damaged_first_packet_does_not_set_the_clock():
    t_ns, arrival, stamps = packets(300)
    stamps[0] = (stamps[0] + 1_700_000_000) % 3_600_000_000

    out, kept = push_all(a_clock(), arrival, stamps)

    assert kept[1:].all()
    np.testing.assert_array_equal(out[1:], (t_ns // 1000 * 1000)[1:])


def test_one_packet_at_a_time_as_from_a_socket_gives_the_same():
    t_ns, arrival, stamps = packets(200)

    out, kept = push_all(a_clock(), arrival, stamps, batch=1)

    assert kept.all()
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)


@pytest.mark.parametrize("half", [20, 60, 100])
def test_a_jump_among_the_very_first_packets_is_a_jump(half):
    _, arrival, stamps = packets(200, off_ns=90 * SECOND_NS)
    stamps = stamps.copy()
    stamps[half:] = (stamps[half:] + 30_000_000) % 3_600_000_000
    report = ImportReport()

    t_ns, trusted = a_clock(report).push(arrival, stamps)

    assert np.count_nonzero(~trusted) <= 60
    assert np.all(np.abs(np.diff(t_ns[trusted])) < SECOND_NS // 10)
    assert report.counts["clock_jumps"] >= 1


@pytest.mark.parametrize("wrong_s", [-7.3, 7.3, 5 * 3600.0, -1900.0])
def test_beside_a_sensor_on_gps_one_that_runs_freely_is_put_on_utc_too(wrong_s):
    t_ns, arrival, stamps = packets(20_000)
    _, _, free_stamps = packets(20_000, off_ns=417 * SECOND_NS, drift=5e-5)
    arrival = arrival + round(wrong_s * SECOND_NS)
    report = ImportReport()
    on_gps = a_clock(report, utc_offset_ns=-round(wrong_s * SECOND_NS))
    free = SensorClock("free", packet_s=PACKET_NS / 1e9, report=report, alone=False)

    first, _ = push_all(on_gps, arrival, stamps)
    second, _ = push_all(free, arrival, free_stamps)

    np.testing.assert_array_equal(first, t_ns // 1000 * 1000)
    assert np.abs(second - t_ns).max() < 3_000_000
    ahead_s = np.array([report.ahead_ns["lidar"], report.ahead_ns["free"]]) / SECOND_NS
    np.testing.assert_allclose(ahead_s, -wrong_s, atol=0.003)
    assert warned(report, K.CLOCK_FREE, sensor="free")


@pytest.mark.parametrize("wrap_us", [1 << 32, 3_600_000_000])
@pytest.mark.parametrize("batch", [1000, 97, 1])
def test_a_counter_that_runs_on_past_the_hour_is_continued(wrap_us, batch):
    """Up to 2^32 µs, or up to the hour as by the manual."""
    t_ns, arrival, _ = packets(1000)
    stamps = (wrap_us - 660_000 + (t_ns - t_ns[0]) // 1000) % wrap_us
    report = ImportReport()
    clock = a_clock(report)

    parts = [
        clock.push(arrival[at : at + batch], stamps[at : at + batch])
        for at in range(0, 1000, batch)
    ]

    out, kept = (np.concatenate(part) for part in zip(*parts, strict=True))
    assert kept.all()
    np.testing.assert_allclose(np.diff(out), np.diff(t_ns), atol=100_000)
    assert report.counts["clock_jumps"] == 0
    past = 0 if wrap_us == 3_600_000_000 else int((stamps >= 3_600_000_000).sum())
    assert report.counts["packets_past_hour"] == past


def test_packets_out_of_order_around_the_wrap_of_a_counter_keep_their_places():
    t_ns, arrival, _ = packets(1000)
    stamps = ((1 << 32) - 660_000 + (t_ns - t_ns[0]) // 1000) % (1 << 32)
    order = np.arange(1000)
    order[490:510] = order[490:510][::-1]
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps[order])

    assert kept.all() and report.counts["clock_jumps"] == 0
    np.testing.assert_allclose(np.diff(out[np.argsort(order)]), np.diff(t_ns), atol=100_000)


def test_damaged_stamps_past_the_hour_are_dropped_one_by_one():
    t_ns, arrival, stamps = packets(1000)
    rows = np.arange(600, 1000, 40)
    stamps[rows] = 0xFFFFFFFF
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert np.flatnonzero(~kept).tolist() == rows.tolist()
    np.testing.assert_array_equal(out[kept], (t_ns // 1000 * 1000)[kept])
    assert report.counts["packets_past_hour"] == 0


def test_a_sensor_that_starts_again_goes_on_after_the_pause():
    """Its counter begins at 0 after 20 s without power."""
    t_ns, arrival, _ = packets(1000)
    arrival[500:] += 20 * SECOND_NS
    since_us = (t_ns - t_ns[0]) // 1000
    stamps = np.where(np.arange(1000) < 500, 3_700_000_000 + since_us, since_us - since_us[500])
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert kept.sum() == 993 and report.counts["clock_jumps"] == 1
    assert (out - t_ns)[-1] - (out - t_ns)[0] == pytest.approx(20e9, abs=10_000_000)
