"""Capture files of sensors: what is inside, and which packets belong to which sensor."""

import numpy as np
import pytest

from recon4.errors import ConfigError, EmptyRecording
from recon4.model.rig import parse_rig
from recon4.recording.assembly.shots import Shots
from recon4.recording.info.describe import describe
from recon4.recording.packets.capture import PacketCapture
from recon4.recording.packets.streams import scan_pcap
from recon4.recording.packets.velodyne.encode import PcapWriter, encode_position, rmc_sentence
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import rig_to_complete
from tests.unit.recording.packet_builders import LATENCY_NS, T0_NS, WIDE, rig, sensor, spin
from tests.warned import K, derivations, kinds, warned

FIRST, SECOND = "192.168.1.201", "192.168.1.202"


def capture(path, *parts):
    """Write (address, port, (times, payloads)) parts, merged by time."""
    rows = [
        (t, n, address, port, payloads[n : n + 1])
        for address, port, (t_ns, payloads) in parts
        for n, t in enumerate(t_ns.tolist())
    ]
    with PcapWriter(path) as file:
        for t, _, address, port, payload in sorted(rows, key=lambda row: row[:3]):
            file.write(np.array([t]), payload, source=address, port=port)
    return path


def read(paths, rig_given=rig_to_complete, settings=WIDE):
    report = ImportReport()
    recording = PacketCapture(paths, rig_given, settings=settings, report=report)
    points: dict[int, int] = {}
    samples = []
    for part in recording.read():
        if isinstance(part, Shots):
            points[part.sensor] = points.get(part.sensor, 0) + len(part)
        else:
            samples.append(part)
    return recording, points, samples, report


def positions(count=200, t0_ns=T0_NS):
    t_ns = t0_ns + 5_000_000 * np.arange(count)
    payloads = [
        encode_position(t // 1000, rmc_sentence(t // 10**9 * 10**9, lat_deg=49.2, lon_deg=16.6))
        for t in t_ns.tolist()
    ]
    return t_ns + 400_000, np.stack(payloads)


def test_the_streams_of_a_file_are_named_with_what_they_carry(tmp_path):
    path = capture(
        tmp_path / "two.pcap",
        (FIRST, 2368, spin(700)),
        (SECOND, 2369, spin(1200, model="HDL-32E", hz=12.5)),
        (FIRST, 8308, positions()),
        (FIRST, 5353, (np.array([T0_NS]), np.zeros((1, 77), np.uint8))),
    )

    streams = scan_pcap(path)

    assert [(s.kind, s.source, s.port, s.packets, s.model) for s in streams] == [
        ("data", FIRST, 2368, 700, "VLP-16"),
        ("data", SECOND, 2369, 1200, "HDL-32E"),
        ("samples", FIRST, 8308, 200, ""),
        ("other", FIRST, 5353, 1, ""),
    ]
    assert streams[0].found.rotation_hz == pytest.approx(10.0, rel=1e-3)
    assert streams[1].found.rotation_hz == pytest.approx(12.5, rel=1e-3)
    assert (streams[0].found.mode, streams[0].whole) == ("strongest", True)
    assert streams[0].utc_offset_ns == streams[2].utc_offset_ns == -400_000
    assert streams[1].utc_offset_ns is None


def test_a_hi_res_puck_is_told_from_a_vlp16_by_its_product_byte(tmp_path):
    path = capture(tmp_path / "hires.pcap", (FIRST, 2368, spin(200, model="VLP-16 Hi-Res")))

    (stream,) = scan_pcap(path)

    assert (stream.model, stream.findings) == ("VLP-16 Hi-Res", ())


def test_the_firing_pattern_outweighs_a_wrong_product_byte(tmp_path):
    t_ns, payloads = spin(200)
    payloads[:, -1] = 0x21
    path = capture(tmp_path / "wrong.pcap", (FIRST, 2368, (t_ns, payloads)))

    (stream,) = scan_pcap(path)
    _, points, _, report = read([path])

    assert stream.model == "VLP-16"
    assert points == {0: 200 * 384}
    assert warned(report, K.MODEL_BY_INTERVAL, model="VLP-16")


def test_only_the_head_of_a_long_file_is_scanned_and_its_end_estimated(tmp_path):
    path = capture(tmp_path / "long.pcap", (FIRST, 2368, spin(9000)))

    (stream,) = scan_pcap(path, max_packets=100)

    assert (stream.packets < 9000, stream.whole) == (True, False)
    seconds = (stream.t_end_ns - stream.t_first_ns) / 1e9
    assert seconds == pytest.approx(9000 * 1.327104e-3, rel=0.01)


def test_two_sensors_in_one_file_go_to_their_places_in_the_rig(tmp_path):
    path = capture(
        tmp_path / "two.pcap", (FIRST, 2369, spin(300)), (SECOND, 2368, spin(400)),
        (FIRST, 8308, positions(300)),
    )  # fmt: skip

    two = rig(sensor("a", port=2368), sensor("b", port=2369))
    recording, points, samples, report = read([path], two)

    assert points == {0: 400 * 384, 1: 300 * 384}
    assert recording.rig is two
    assert sum(len(part.gnss) for part in samples if part.gnss) == 2
    assert report.counts["packets_missing"] == 0


def test_addresses_tell_two_sensors_on_one_port_apart(tmp_path):
    path = capture(tmp_path / "two.pcap", (FIRST, 2368, spin(30)), (SECOND, 2368, spin(40)))

    two = rig(sensor("a", address=SECOND), sensor("b", address=FIRST))
    _, points, _, _ = read([path], two)

    assert points == {0: 40 * 384, 1: 30 * 384}


def test_two_lidars_on_one_port_end_with_a_rig_to_paste(tmp_path):
    path = capture(tmp_path / "two.pcap", (FIRST, 2368, spin(30)), (SECOND, 2368, spin(40)))

    (text,) = (text for text in describe(path).missing if text.startswith("rig:"))
    pasted = parse_rig(text[text.index('name = "my rig"') :], where="pasted")
    _, points, _, _ = read([path], pasted)

    assert points == {0: 30 * 384, 1: 40 * 384}


def test_without_a_rig_each_data_stream_is_a_sensor(tmp_path):
    path = capture(
        tmp_path / "two.pcap", (FIRST, 2368, spin(30)), (SECOND, 2368, spin(50, model="VLP-32C"))
    )

    recording, points, _, _ = read([path])

    assert [(s.name, s.model, s.address) for s in recording.rig.sensors] == [
        ("lidar0", "VLP-16", FIRST),
        ("lidar1", "VLP-32C", SECOND),
    ]
    assert points == {0: 30 * 384, 1: 50 * 384}


def test_two_files_of_the_same_time_are_two_sensors(tmp_path):
    one = capture(tmp_path / "one.pcap", (FIRST, 2368, spin(300)))
    other = capture(tmp_path / "other.pcap", (FIRST, 2368, spin(310, hz=9.9)))

    _, points, _, report = read([one, other], rig(sensor("a"), sensor("b", port=2369)))

    assert points == {0: 300 * 384, 1: 310 * 384}
    assert any(text.startswith("b: taken from") for text in derivations(report))


def test_files_that_follow_each_other_are_one_sensor(tmp_path):
    t_ns, payloads = spin(600)
    one = capture(tmp_path / "part0.pcap", (FIRST, 2368, (t_ns[:300], payloads[:300])))
    other = capture(tmp_path / "part1.pcap", (FIRST, 2368, (t_ns[300:], payloads[300:])))

    recording, points, _, report = read([other, one])

    assert len(recording.rig.sensors) == 1
    assert points == {0: 600 * 384}
    assert report.counts["packets_missing"] == report.counts["packets_late"] == 0


def test_files_that_overlap_are_one_sensor_whose_packets_are_read_once(tmp_path):
    t_ns, payloads = spin(600)
    begin, end = slice(0, 400), slice(300, 600)
    one = capture(tmp_path / "part0.pcap", (FIRST, 2368, (t_ns[begin], payloads[begin])))
    other = capture(tmp_path / "part1.pcap", (FIRST, 2368, (t_ns[end], payloads[end])))

    recording, points, _, report = read([other, one])

    assert len(recording.rig.sensors) == 1
    assert points == {0: 600 * 384}
    assert report.counts["packets_duplicate"] == 100


def test_a_file_that_ends_before_its_estimated_end_is_followed_by_the_next(tmp_path):
    t_ns, payloads = spin(3000)
    burst = t_ns[-400] + (t_ns - t_ns[0]) // 10
    one = capture(
        tmp_path / "a.pcap", (FIRST, 2368, (t_ns, payloads)), (SECOND, 9, (burst, payloads))
    )
    later = spin(300, t0_ns=int(t_ns[-1]) + 1_000_000)
    other = capture(tmp_path / "b.pcap", (FIRST, 2368, later))

    _, points, _, _ = read([one, other])

    assert scan_pcap(one)[0].t_end_ns > later[0][0]
    assert points[0] == 3300 * 384


def test_a_missing_second_sensor_is_warned_of_and_the_first_is_read(tmp_path):
    path = capture(tmp_path / "one.pcap", (FIRST, 2368, spin(30)))

    _, points, _, report = read([path], rig(sensor("a"), sensor("b", port=2369)))

    assert points == {0: 30 * 384}
    assert warned(report, K.PACKETS_MISSING, sensor="b", anywhere=True, port=2369)


def test_a_stream_without_a_place_in_the_rig_is_warned_of(tmp_path):
    path = capture(tmp_path / "two.pcap", (FIRST, 2368, spin(30)), (SECOND, 2369, spin(30)))

    _, points, _, report = read([path], rig(sensor("a")))

    assert points == {0: 30 * 384}
    assert warned(report, K.PACKETS_UNASSIGNED)


def test_packets_of_a_wrong_length_on_the_port_are_counted(tmp_path):
    junk = (T0_NS + 10_000_000 * np.arange(20), np.zeros((20, 300), np.uint8))
    path = capture(tmp_path / "junk.pcap", (FIRST, 2368, spin(200)), (FIRST, 2368, junk))

    _, points, _, report = read([path])

    assert points == {0: 200 * 384}
    assert report.counts["packets_wrong_length"] == 20


def test_a_cut_file_is_salvaged_to_its_last_packet(tmp_path):
    path = capture(tmp_path / "cut.pcap", (FIRST, 2368, spin(100)))
    path.write_bytes(path.read_bytes()[:-700])

    _, points, _, report = read([path])

    assert points == {0: 99 * 384}
    assert report.outcome == "lossy"


def test_a_capture_of_something_else_is_refused(tmp_path):
    path = capture(tmp_path / "dns.pcap", (FIRST, 53, (np.array([T0_NS]), np.ones((1, 60), "u1"))))

    with pytest.raises(
        EmptyRecording,
        match=r"no data packets of a LiDAR .*: 1 packets from .* to port 53 \(of 60 bytes",
    ):
        read([path])


def test_an_hdl64_is_named_and_refused(tmp_path):
    t_ns, payloads = spin(60)
    for block in range(1, 12, 2):
        payloads[:, 100 * block + 1] = 0xDD
    path = capture(tmp_path / "hdl64.pcap", (FIRST, 2368, (t_ns, payloads)))

    assert scan_pcap(path)[0].model == "HDL-64E"
    with pytest.raises(ConfigError, match="HDL-64E need the calibration"):
        read([path])


def test_both_sensors_are_on_one_clock_though_neither_has_gps(tmp_path):
    path = capture(
        tmp_path / "free.pcap",
        (FIRST, 2368, spin(300, clock_off_ns=500_000_000_000)),
        (SECOND, 2368, spin(300, clock_off_ns=-1_200_000_000_000)),
    )
    report = ImportReport()
    firsts = {}
    for part in PacketCapture([path], rig_to_complete, settings=WIDE, report=report).read():
        if isinstance(part, Shots) and len(part):
            firsts.setdefault(part.sensor, part.t_ns[0])

    assert abs(firsts[0] - firsts[1]) < 10_000
    assert abs(firsts[0] - T0_NS) < LATENCY_NS
    assert kinds(report).count(K.CLOCK_FREE) == 2


def late(t0_ns, count=300):
    return spin(count, t0_ns=t0_ns)


def test_a_sensor_that_wakes_up_late_is_read_from_then_on(tmp_path):
    path = capture(
        tmp_path / "late.pcap",
        (FIRST, 2368, spin(5500)),
        (SECOND, 2369, late(T0_NS + 7_000_000_000)),
    )

    _, points, _, report = read([path], rig(sensor("a"), sensor("b", port=2369)))

    assert points == {0: 5500 * 384, 1: 300 * 384}
    assert any("b: sends only later" in text for text in derivations(report))


def test_lidars_switched_on_after_the_imu_are_found(tmp_path):
    texts = np.zeros((4100, 20), np.uint8)
    path = capture(
        tmp_path / "late.pcap",
        (FIRST, 8309, (T0_NS + 5_000_000 * np.arange(4100), texts)),
        (SECOND, 2368, late(T0_NS + 21_000_000_000)),
    )

    assert read([path], rig(sensor("a")))[1] == {0: 300 * 384}


def test_a_few_packets_of_a_stranger_are_not_taken_for_a_silent_sensor(tmp_path):
    path = capture(
        tmp_path / "stranger.pcap",
        ("10.9.9.9", 2368, late(T0_NS - 100_000_000, count=20)),
        (FIRST, 2368, spin(1000)),
    )

    _, points, _, report = read([path], rig(sensor("a"), sensor("b", port=2369)))

    assert points == {0: 1000 * 384}
    assert warned(report, K.PACKETS_UNASSIGNED, sender="10.9.9.9")


def test_a_rig_with_addresses_keeps_a_third_lidar_out(tmp_path):
    path = capture(
        tmp_path / "third.pcap",
        ("10.9.9.9", 2368, spin(1000)),
        (FIRST, 2368, spin(900)),
        (SECOND, 2369, spin(800)),
    )

    _, points, _, _ = read(
        [path], rig(sensor("a", address=FIRST), sensor("b", port=2369, address=SECOND))
    )

    assert points == {0: 900 * 384, 1: 800 * 384}
