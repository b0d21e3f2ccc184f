"""A capture without data says what was found, and why each part of it was refused."""

import struct

import numpy as np
import pytest

from recon4.errors import ConfigError, EmptyRecording
from recon4.findings.wording import whole_text
from recon4.model.rig import parse_rig
from recon4.recording.info.describe import describe
from recon4.recording.packets.capture import PacketCapture
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import rig_to_complete
from tests.builders import write_room_bag
from tests.unit.recording.ingested import run
from tests.unit.recording.packet_builders import T0_NS, WIDE, rig, sensor, spin
from tests.unit.recording.test_pcap_streams import FIRST, SECOND, capture, read
from tests.warned import K, warned, words


def cut_to(path, snap_length):
    """The capture as tcpdump writes it with a snap length."""
    data, at, out = path.read_bytes(), 24, [path.read_bytes()[:24]]
    while at < len(data):
        seconds, fraction, captured, sent = struct.unpack_from("<IIII", data, at)
        kept = min(captured, snap_length)
        out.append(struct.pack("<IIII", seconds, fraction, kept, sent))
        out.append(data[at + 16 : at + 16 + kept])
        at += 16 + captured
    path.write_bytes(b"".join(out))
    return path


def why(path):
    with pytest.raises(EmptyRecording) as raised:
        read([path])
    return str(raised.value)


def samples(text, count=100):
    payload = np.frombuffer(text, np.uint8)
    return T0_NS + 10_000_000 * np.arange(count), np.tile(payload, (count, 1))


def test_packets_cut_by_the_snap_length_are_named_with_their_port(tmp_path):
    path = cut_to(capture(tmp_path / "cut.pcap", (FIRST, 2368, spin(100))), 1000)

    text = why(path)

    assert "100 of 100 captured packets: cut when they were captured (snap length)" in text
    assert "tcpdump -s 0 (to 1000 bytes, to port 2368)" in text


def test_a_snap_length_inside_the_headers_is_a_snap_length(tmp_path):
    path = cut_to(capture(tmp_path / "cut.pcap", (FIRST, 2368, spin(100))), 40)

    assert "100 of 100 captured packets: cut" in why(path)


def test_one_lidar_that_is_cut_is_a_warning_beside_the_other(tmp_path):
    path = capture(
        tmp_path / "two.pcap", (FIRST, 2368, spin(100)), (SECOND, 2369, spin(100, hz=20.0))
    )
    data = bytearray(path.read_bytes())
    at = 24
    while at < len(data):
        captured = struct.unpack_from("<I", data, at + 8)[0]
        if struct.unpack_from(">H", data, at + 16 + 36)[0] == 2369:
            struct.pack_into("<I", data, at + 8, 900)
            del data[at + 16 + 900 : at + 16 + captured]
            captured = 900
        at += 16 + captured
    path.write_bytes(data)

    _, points, _, report = read([path])

    assert points[0] > 0 and set(points) == {0}
    report.warn_of_losses()
    assert warned(report, K.DATA_LOST, count="records_cut", number=100, total=200)
    lost = describe(path).lost
    assert any("(to 900 bytes, to port 2369)" in loss.text for loss in lost)
    assert any("(auf 900 Byte, an Port 2369)" in loss.said("de") for loss in lost)
    (finding,) = (one for one in report.findings if one.kind is K.DATA_LOST)
    assert "(auf 900 Byte, an Port 2369)" in whole_text(finding, "de")


def test_damaged_flags_are_the_reason_and_not_the_length(tmp_path):
    t_ns, payloads = spin(80)
    payloads[:60, 300] = 0

    text = why(capture(tmp_path / "flags.pcap", (FIRST, 2368, (t_ns, payloads))))

    assert "60 of 80 data packets: blocks without their flag" in text


def test_packets_of_another_make_are_named_by_their_length(tmp_path):
    other = T0_NS + 1_000_000 * np.arange(90), np.ones((90, 1248), np.uint8)

    text = why(capture(tmp_path / "other.pcap", (FIRST, 6699, other)))

    assert (
        f"90 packets from {FIRST} to port 6699 (of 1248 bytes: not those of a known LiDAR)" in text
    )


def test_a_second_lidar_of_another_make_is_a_warning(tmp_path):
    other = T0_NS + 1_300_000 * np.arange(90), np.ones((90, 1248), np.uint8)
    path = capture(tmp_path / "two.pcap", (FIRST, 2368, spin(100)), (SECOND, 6699, other))

    _, _, _, report = read([path])

    assert warned(report, K.PACKETS_UNREAD, packets=90, sender=f"{SECOND} to port 6699")
    assert describe(path).unread


def test_a_few_datagrams_of_other_programs_are_no_warning(tmp_path):
    other = T0_NS + 50_000_000 * np.arange(3), np.ones((3, 77), np.uint8)
    path = capture(tmp_path / "mdns.pcap", (FIRST, 2368, spin(100)), (SECOND, 5353, other))

    _, _, _, report = read([path])

    assert not warned(report, K.PACKETS_UNREAD)


def test_an_imu_at_a_port_that_the_rig_does_not_name_is_a_warning(tmp_path):
    imu = samples(b'{"t_ns": 5, "gx_rad_s": 0.1, "gy_rad_s": 0, "gz_rad_s": 0}')
    path = capture(tmp_path / "imu.pcap", (FIRST, 2368, spin(700)), (SECOND, 7777, imu))

    _, _, _, report = read([path])

    assert warned(report, K.SAMPLES_PORT, table="imu", port=7777)
    assert "Give [imu] port = 7777 in the rig file." in words(report)


def test_a_sensor_of_the_rig_whose_packets_are_refused_says_why(tmp_path):
    t_ns, payloads = spin(80, hz=20.0)
    payloads[:, 300] = 0
    path = capture(
        tmp_path / "two.pcap", (FIRST, 2368, spin(100)), (SECOND, 2369, (t_ns, payloads))
    )

    _, _, _, report = read([path], rig(sensor("a", port=2368), sensor("b", port=2369)))

    flags = "80 of 80 data packets: blocks without their flag"
    assert warned(report, K.PACKETS_MISSING, sensor="b", found=flags)


@pytest.mark.parametrize("model", ["XT32", "OS1-64", "Mid-360"])
def test_a_capture_against_the_rig_of_another_make_says_what_sends_and_what_is_expected(
    tmp_path, model
):
    path = capture(tmp_path / "v.pcap", (FIRST, 2370, spin(100)))
    other = rig(sensor("top", model=model, port=2368, address="10.0.0.5"))

    with pytest.raises(EmptyRecording) as caught:
        run(path, out=tmp_path / "o", rig=other)

    text = str(caught.value)
    assert f"expects top: {model} from 10.0.0.5 to port 2368; the recording has" in text
    assert "100 packets from 192.168.1.201 to port 2370 (data packets of a VLP-16)" in text
    assert "recon4 info RECORDING --rig-out rig.toml" in text


def test_packets_of_another_make_are_none_of_a_sensor_beside_others(tmp_path):
    path = capture(tmp_path / "v.pcap", (FIRST, 2368, spin(100)), (SECOND, 2369, spin(100)))

    _, points, _, report = read(
        [path], rig(sensor("a", port=2368), sensor("b", model="XT32", port=2369))
    )

    assert points == {0: 100 * 384}
    assert warned(report, K.MODEL_CONTRADICTED, sensor="b", says="VLP-16", expected="XT32")
    assert not warned(report, K.PACKETS_MISSING) and not warned(report, K.PACKETS_UNASSIGNED)


@pytest.mark.parametrize(
    ("model", "topic"), [("VLP-16", "/other/packets"), ("XT32", "/velodyne_packets")]
)
def test_a_bag_against_another_rig_says_its_topics_and_those_expected(tmp_path, model, topic):
    bag = write_room_bag(tmp_path, "mcap", seconds=0.3)
    other = parse_rig(f'[[sensor]]\nname = "top"\nmodel = "{model}"\ntopic = "{topic}"', where="r")

    with pytest.raises(ConfigError) as caught:
        run(bag, out=tmp_path / "o", rig=other)

    text = str(caught.value)
    assert f"expects top: {model} in {topic}; the recording has /velodyne_packets" in text
    assert "VLP-16; correct the rig" in text


def test_a_capture_of_other_protocols_names_them(tmp_path):
    path = capture(tmp_path / "tcp.pcap", (FIRST, 2368, spin(20)))
    data = bytearray(path.read_bytes())
    for at in range(24, len(data), 16 + 42 + 1206):
        data[at + 16 + 23] = 6
    path.write_bytes(data)

    assert "20 of 20 captured packets: no UDP over IPv4, not read (TCP)" in why(path)


@pytest.mark.parametrize(
    ("link_type", "head"), [(0, b"\x1e\0\0\0"), (108, b"\0\0\0\x1e"), (101, b"")]
)
def test_packets_of_ipv6_are_named_on_links_without_ethertype(tmp_path, link_type, head):
    packet = head + struct.pack(">IHBB", 0x60000000, 20, 17, 64) + bytes(32 + 20)
    record = struct.pack("<IIII", 1_700_000_000, 0, len(packet), len(packet)) + packet
    path = tmp_path / "ipv6.pcap"
    path.write_bytes(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, link_type) + 5 * record)

    assert "5 of 5 captured packets: no UDP over IPv4, not read (IPv6)" in why(path)


def test_a_counter_that_runs_past_the_hour_is_read_and_said(tmp_path):
    off_ns = 3_599_900_000_000 - T0_NS % 3_600_000_000_000
    t_ns, payloads = spin(700)
    stamps = (t_ns - t_ns[0]) // 1000 + (T0_NS % 3_600_000_000_000 + off_ns) // 1000
    payloads[:, 1200:1204] = stamps.astype("<u4")[:, None].view(np.uint8)
    path = capture(tmp_path / "past.pcap", (FIRST, 2368, (t_ns, payloads)))

    _, points, _, report = read([path])

    assert points == {0: 700 * 384}
    assert report.counts["packets_past_hour"] == int((stamps >= 3_600_000_000).sum()) > 500
    assert any("past the end of the hour" in one.text for one in describe(path).repaired)


def test_counts_of_the_head_are_not_counted_twice(tmp_path):
    path = cut_to(capture(tmp_path / "cut.pcap", (FIRST, 2368, spin(700))), 1300)
    report = ImportReport()

    list(PacketCapture([path], rig_to_complete, settings=WIDE, report=report).read())

    assert report.counts["records"] == report.counts["packets"] == 700
