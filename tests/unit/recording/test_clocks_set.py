"""Clocks that are set during a capture, by less than a second and by more: nothing is lost."""

import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.recording.info.describe import describe
from recon4.recording.packets.packet_order import PacketOrder
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS
from tests.builders import T0_NS, noisy, room_packets
from tests.unit.recording.ingested import run
from tests.unit.recording.packet_builders import rig as rig_of
from tests.unit.recording.packet_builders import sensor
from tests.unit.recording.test_packets_clock import a_clock, packets, push_all
from tests.warned import K, warned

TURNED_AT = 900
"""Packet from which on the clocks are other ones: in the second second."""
RECORDER, SENSOR, BOTH = (True, False), (False, True), (True, True)


def capture(path, set_s, *, clocks=RECORDER, imu=False):
    """A VLP-16 in a room for 2 s, and an IMU that is stamped by the recorder's clock."""
    t_ns, payloads = room_packets(seconds=2.0)
    later = np.where(np.arange(len(t_ns)) < TURNED_AT, 0, round(set_s * SECOND_NS))
    recorder, sensor = clocks
    if sensor:
        stamps = (t_ns + later) // 1000 % 3_600_000_000
        payloads[:, 1200:1204] = stamps.astype("<u4")[:, None].view(np.uint8)
    arrival = t_ns + 2_000_000 + (later if recorder else 0)
    with PcapWriter(path) as writer:
        for k in range(0, len(t_ns), 10):
            rows = slice(k, k + 10)
            if imu:
                gyro, accel = (noisy((0.0, 0.0, z), k) for z in (0.1, 9.8))
                values = dict(zip(("gx_rad_s", "gy_rad_s", "gz_rad_s"), gyro, strict=True))
                values |= dict(zip(("ax_m_s2", "ay_m_s2", "az_m_s2"), accel, strict=True))
                text = json.dumps({"t_ns": int(t_ns[k] + later[k])} | values).encode()
                one = np.frombuffer(text, np.uint8)[None]
                writer.write(arrival[k : k + 1], one, source="192.168.1.50", port=10110)
            writer.write(arrival[rows], payloads[rows], source="192.168.1.201", port=2368)
    return path


@pytest.mark.parametrize("jump_s", [-0.6, -0.3, -0.15, 0.15, 0.6])
def test_a_step_of_the_sensors_clock_below_a_second_is_taken_out(jump_s):
    t_ns, arrival, stamps = packets(1000)
    stamps[500:] = (stamps[500:] + round(jump_s * 1e6)) % 3_600_000_000
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert kept.sum() == 993
    assert np.abs(out - t_ns)[kept].max() < 1_000_000
    assert warned(report, K.CLOCK_JUMP, whose="sensor")


@pytest.mark.parametrize("off_ns", [0, 417 * SECOND_NS], ids=["synchronized", "free running"])
@pytest.mark.parametrize("jump_s", [-0.6, -0.15, 0.15, 0.6])
def test_a_step_of_the_recorders_clock_below_a_second_is_said(jump_s, off_ns):
    t_ns, arrival, stamps = packets(6000, off_ns=off_ns)
    arrival[3000:] += round(jump_s * 1e9)
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert kept.all()
    assert np.abs(np.diff(out) - np.diff(t_ns)).max() < 10_000
    assert report.recorder_jumps_ns["lidar"] == [pytest.approx(jump_s * 1e9, abs=1e6)]
    assert warned(report, K.CLOCK_JUMP, whose="recorder")


@pytest.mark.parametrize("row", [450, 490, 511])
def test_a_recorder_that_is_set_back_is_noticed_within_a_second(row):
    _, arrival, stamps = packets(1000)
    arrival[row:] -= 600_000_000
    report = ImportReport()

    push_all(a_clock(report), arrival, stamps)

    assert warned(report, K.CLOCK_JUMP, whose="recorder")


@pytest.mark.parametrize("late_s", [0.3, 0.45])
def test_packets_that_are_held_up_are_no_step(late_s):
    """A recorder that stops for a moment every second: then all that waited comes at once."""
    t_ns, arrival, stamps = packets(6000)
    since_ns = (t_ns - t_ns[0]) % SECOND_NS
    held = since_ns < late_s * 1e9
    arrival[held] += (late_s * 1e9 - since_ns[held]).astype(np.int64)
    report = ImportReport()

    out, kept = push_all(a_clock(report), arrival, stamps)

    assert kept.all() and not report.findings
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)


def test_a_packet_of_the_imu_just_before_a_step_is_confirmed_is_left_out():
    _, arrival, stamps = packets(1000)
    stamps[500:] = (stamps[500:] + 600_000) % 3_600_000_000
    clock: SensorClock = a_clock()

    clock.push(arrival[:503], stamps[:503])

    assert clock.at(arrival[490:506], stamps[490:506])[1].tolist() == [True] * 10 + [False] * 6


@pytest.mark.parametrize("clocks", [RECORDER, SENSOR, BOTH], ids=["recorder", "sensor", "both"])
@pytest.mark.parametrize("set_s", [-1.1, -0.6])
def test_a_capture_whose_clocks_are_set_loses_nothing(tmp_path, set_s, clocks):
    whole = run(capture(tmp_path / "whole.pcap", 0.0), out=tmp_path / "once")

    file = capture(tmp_path / "set.pcap", set_s, clocks=clocks)
    found = run(file, out=tmp_path / "out")

    steps = np.diff(found.index["t_ns"])
    assert len(found) == len(whole) and np.ptp(steps) < 1_000_000
    assert found.report["points"] > 0.99 * whole.report["points"]
    said = {one["kind"] for one in found.report["findings"]}
    assert said & {"CLOCK-JUMP", "CLOCK-BACK"}
    assert "DATA-LOST" not in said
    assert "MODEL-UNLIKELY" not in said


@pytest.mark.parametrize(("set_s", "clocks"), [(-37.0, RECORDER), (37.0, RECORDER), (-1.1, BOTH)])
def test_info_gives_the_duration_without_the_step_of_the_clocks(tmp_path, set_s, clocks):
    info = describe(capture(tmp_path / "set.pcap", set_s, clocks=clocks))

    assert info.seconds == pytest.approx(2.0, abs=0.02)


@pytest.mark.parametrize("set_s", [-37.0, -0.6, 37.0])
def test_an_imu_on_the_recorders_clock_goes_on_when_that_is_set(tmp_path, set_s):
    file = capture(tmp_path / "set.pcap", set_s, imu=True)

    rig = replace(rig_of(sensor(port=2368)), imu_port=10110)
    found = run(file, out=tmp_path / "out", rig=rig)

    t_ns = found.imu.t_ns
    assert len(t_ns) == len(range(0, len(room_packets(seconds=2.0)[0]), 10))
    assert np.diff(t_ns).max() < 30_000_000
    assert t_ns[-1] - T0_NS == pytest.approx(2e9, abs=0.05e9)


@pytest.mark.parametrize("size", [50, 100, 500, 3000])
def test_the_packets_before_which_clocks_went_back_are_marked_however_few_come_at_once(size):
    t_ns = SECOND_NS + np.arange(3000) * 1_327_000
    t_ns[1520:] -= SECOND_NS // 3
    order, last_ns, marked = PacketOrder(SECOND_NS // 5, ImportReport(), step_ns=1_327_000), 0, []
    for k in range(0, len(t_ns), size):
        part = t_ns[k : k + size]
        given, _ = order.push_arrived(part, np.zeros((len(part), 1), np.uint8), part + 2_000_000)
        goes_back = bool(np.any(np.diff(given, prepend=last_ns) < 0))
        assert order.is_set_back == goes_back
        marked.append(goes_back)
        order.is_set_back, last_ns = False, given[-1] if len(given) else last_ns

    assert sum(marked) == 1


def falling_behind(arrival, late_s):
    """Arrivals of a sender that falls behind for 2 s and then sends all that waited."""
    since_ns = arrival - arrival[1000]
    sent = arrival + (np.clip(since_ns / (2.0 * SECOND_NS), 0.0, 1.0) * late_s * 1e9).astype(int)
    caught_up = arrival > arrival[1000] + 2.5 * SECOND_NS
    sent[caught_up] = np.maximum(arrival, np.max(sent[~caught_up]) + 1000)[caught_up]
    return sent


@pytest.mark.parametrize("late_s", [0.9, 1.4, 4.0])
def test_a_sender_that_falls_behind_loses_no_packets_and_has_no_jump(late_s):
    t_ns, arrival, stamps = packets(8000)
    report = ImportReport()

    out, kept = push_all(a_clock(report), falling_behind(arrival, late_s), stamps)

    assert kept.all() and not report.findings
    np.testing.assert_array_equal(out, t_ns // 1000 * 1000)


@pytest.mark.parametrize("jump_s", [-600.0, -0.3, 0.3, 900.0])
def test_a_sensor_that_is_set_while_its_packets_come_late_goes_on(jump_s):
    t_ns, arrival, stamps = packets(8000)
    late = falling_behind(arrival, 0.8)
    row = int(np.argmax(late - arrival))
    stamps[row:] = (stamps[row:] + round(jump_s * 1e6)) % 3_600_000_000
    report = ImportReport()

    out, kept = push_all(a_clock(report), late, stamps)

    assert kept.sum() == len(kept) - 7
    assert np.abs(out - t_ns)[kept].max() < 15_000_000
    assert warned(report, K.CLOCK_JUMP, whose="sensor")


def test_packets_of_the_imu_are_as_late_as_those_of_the_points():
    _, arrival, stamps = packets(8000)
    late = falling_behind(arrival, 4.0)
    row = int(np.argmax(late - arrival))
    clock: SensorClock = a_clock()
    clock.push(late[:row], stamps[:row])

    assert clock.at(late[row - 40 : row + 40], stamps[row - 40 : row + 40])[1].all()
