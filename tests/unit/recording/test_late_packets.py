"""Packets that come late, from senders and networks that were busy: no clock has jumped."""

import numpy as np
import pytest

from recon4.recording.report import ImportReport
from recon4.units import HOUR_NS, SECOND_NS
from tests.unit.recording.test_packets_clock import PACKET_NS, a_clock, packets, push_all
from tests.warned import K, warned

OFF_NS = [0, 417 * SECOND_NS]
KEPT_CLOCKS = pytest.mark.parametrize("off_ns", OFF_NS, ids=["synchronized", "free running"])


def stalled(arrival, for_s, *, times=3.0):
    """Arrivals of a sender that stops after 5 s, then sends as many times as often as before."""
    at_ns = arrival[0] + 5 * SECOND_NS
    waited = np.flatnonzero(arrival >= at_ns)
    sent_ns = at_ns + for_s * 1e9 + np.arange(len(waited)) * PACKET_NS / times
    late = arrival.copy()
    late[waited] = np.maximum(arrival[waited], sent_ns.astype(np.int64))
    return late


def starved(arrival, seed):
    """Arrivals of a sender that has the processor in slices, 30 % of the time."""
    rng, late = np.random.default_rng(seed), arrival.copy()
    free_ns, end_ns = float(arrival[0]), float(arrival[0])
    for row, here_ns in enumerate(arrival.tolist()):
        free_ns = max(free_ns, here_ns) + 400_000
        while free_ns > end_ns:
            free_ns = max(free_ns, end_ns + rng.exponential(0.07e9))
            end_ns = free_ns + rng.exponential(0.03e9)
        late[row] = int(free_ns)
    return late


def judged(arrival, stamps, *, batch=75):
    report = ImportReport()
    clock = a_clock(report)
    out, kept = push_all(clock, arrival, stamps, batch=batch)
    clock.finish()
    return out, kept, report


@KEPT_CLOCKS
@pytest.mark.parametrize("times", [1.05, 3.0, 50.0])
@pytest.mark.parametrize("for_s", [0.5, 1.5, 10.0, 70.0, 4000.0])
def test_a_sender_that_stalls_and_then_sends_all_that_waited_is_no_jump(for_s, times, off_ns):
    t_ns, arrival, stamps = packets(20_000, off_ns=off_ns)

    out, kept, report = judged(stalled(arrival, for_s, times=times), stamps)

    assert kept.all() and not report.findings
    assert np.ptp(out - t_ns) < 100_000


@pytest.mark.parametrize("batch", [1, 75, 20_000])
def test_a_sender_with_too_little_processor_is_no_jump(batch):
    t_ns, arrival, stamps = packets(20_000)
    late = starved(arrival, 2)

    out, kept, report = judged(late, stamps, batch=batch)

    assert np.max(late - arrival) > 1.5 * SECOND_NS
    assert kept.all() and not report.findings
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)


@KEPT_CLOCKS
@pytest.mark.parametrize("jump_s", [-7200.0, -37.0, 37.0, 3600.0])
def test_a_recorder_that_is_set_while_the_sender_stalls_has_jumped(jump_s, off_ns):
    t_ns, arrival, stamps = packets(20_000, off_ns=off_ns)
    late = stalled(arrival, 1.5)
    late[arrival > arrival[0] + 5.2e9] += round(jump_s * 1e9)

    out, kept, report = judged(late, stamps)

    assert kept.all() and np.ptp(out - t_ns) < 3_000_000
    assert warned(report, K.CLOCK_JUMP, whose="recorder")
    assert sum(report.recorder_jumps_ns["lidar"]) == pytest.approx(jump_s * 1e9, abs=30e6)


def test_samples_beside_the_points_are_of_their_hour_before_the_jump_is_confirmed():
    t_ns, arrival, stamps = packets(1000)
    arrival[500:] += 2 * HOUR_NS
    clock = a_clock()
    clock.push(arrival[:560], stamps[:560])

    out, valid = clock.at(arrival[550:560], stamps[550:560])

    assert valid.all()
    np.testing.assert_array_equal(out, t_ns[550:560] // 1000 * 1000)


@pytest.mark.parametrize("jump_s", [-600.0, 900.0])
def test_a_sensor_that_is_set_while_its_sender_is_starved_leaves_no_gap(jump_s):
    """Where packets come late and in pieces: 8 of them take longer than those of an even sender."""
    t_ns, arrival, stamps = packets(20_000)
    late = starved(arrival, 2)
    waits = late[8:] - late[:-8] > SECOND_NS // 5
    row = 8 + int(np.argmax(np.where(waits, (late - arrival)[8:], 0)))
    stamps[row - 4 :] = (stamps[row - 4 :] + round(jump_s * 1e6)) % (HOUR_NS // 1000)

    out, kept, report = judged(late, stamps)

    assert (late - arrival)[row] > SECOND_NS and kept.sum() == len(kept) - 7
    assert np.abs(out - t_ns)[kept].max() < late[row + 4] - late[row - 5]
    assert warned(report, K.CLOCK_JUMP, whose="sensor")


@KEPT_CLOCKS
@pytest.mark.parametrize("late_s", [0.15, 0.31])
def test_packets_that_come_late_at_the_start_are_no_jump(late_s, off_ns):
    t_ns, arrival, stamps = packets(3000, off_ns=off_ns)
    waited = np.arange(len(arrival)) * 20_000 + round(late_s * 1e9)

    out, kept, report = judged(np.maximum(arrival, arrival[0] + waited), stamps, batch=754)

    assert kept.all() and not report.findings
    np.testing.assert_allclose(np.diff(out), np.diff(t_ns), atol=1000)
