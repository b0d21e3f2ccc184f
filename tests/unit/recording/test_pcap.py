"""Capture files: kinds, byte orders, headers, cuts, foreign files."""

import struct

import numpy as np
import pytest

from recon4.errors import EmptyRecording, UnknownFormat
from recon4.recording.formats.datagrams import address_text
from recon4.recording.formats.pcap import is_pcap, read_pcap
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from tests.unit.recording.packet_builders import spin
from tests.warned import K, warned

SECONDS, NANOSECONDS = 1_700_000_000, 123_456_789


def udp(payload=b"\x07" * 40, *, port=2368, options=b"", fragment=0, lengths=(None, None)):
    """IPv4 and UDP around a payload; ``lengths`` are those in their headers, if others."""
    words = 5 + len(options) // 4
    of_ip, of_udp = lengths
    of_ip = words * 4 + 8 + len(payload) if of_ip is None else of_ip
    of_udp = 8 + len(payload) if of_udp is None else of_udp
    ip = struct.pack(
        ">BBHHHBBH4s4s",
        0x40 | words, 0, of_ip, 1, fragment, 64, 17, 0, bytes((10, 0, 0, 7)), bytes((255,) * 4),
    )  # fmt: skip
    return ip + options + struct.pack(">HHHH", 2368, port, of_udp, 0) + payload


def ethernet(packet, *, tags=b"", ethertype=0x0800):
    return bytes(12) + tags + struct.pack(">H", ethertype) + packet


def classic(packets, *, order="<", magic=0xA1B2C3D4, link_type=1, fraction=123_456):
    text = struct.pack(order + "IHHiIII", magic, 2, 4, 0, 0, 65535, link_type)
    for packet in packets:
        text += struct.pack(order + "IIII", SECONDS, fraction, len(packet), len(packet)) + packet
    return text


def read(path):
    report = ImportReport()
    return list(read_pcap(path, report)), report


def written(tmp_path, content):
    path = tmp_path / "capture.pcap"
    path.write_bytes(content)
    return path


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(
    ("magic", "fraction", "expected_ns"),
    [(0xA1B2C3D4, 123_456, 123_456_000), (0xA1B23C4D, NANOSECONDS, NANOSECONDS)],
)
def test_both_byte_orders_and_both_units_of_time_are_read(
    tmp_path, order, magic, fraction, expected_ns
):
    path = written(
        tmp_path, classic([ethernet(udp())] * 3, order=order, magic=magic, fraction=fraction)
    )

    (batch,), report = read(path)

    assert batch.t_ns.tolist() == [SECONDS * 10**9 + expected_ns] * 3
    assert [address_text(s) for s in batch.source] == ["10.0.0.7"] * 3
    assert (batch.port.tolist(), batch.length.tolist()) == ([2368] * 3, [40] * 3)
    assert np.all(batch.payloads(np.arange(3), 40) == 7)
    assert (report.outcome, report.counts) == ("complete", {"records": 3})


@pytest.mark.parametrize(
    ("link_type", "packet"),
    [
        (1, ethernet(udp())),
        (1, ethernet(udp(), tags=b"\x81\x00\x00\x05")),
        (1, ethernet(udp(), tags=b"\x88\xa8\x00\x05\x81\x00\x00\x06")),
        (1, ethernet(udp(options=bytes(8)))),
        (1, ethernet(udp(), tags=b"\x91\x00\x00\x05" + b"\x81\x00\x00\x06" * 2)),
        (1 | 0x2400_0000, ethernet(udp()) + b"csum"),
        (101, udp()),
        (12, udp()),
        (0, struct.pack("<I", 2) + udp()),
        (113, bytes(14) + b"\x08\x00" + udp()),
        (276, b"\x08\x00" + bytes(18) + udp()),
    ],
    ids=[
        *("ethernet", "vlan", "two vlans", "ip options", "three vlans", "checksum", "raw ip"),
        *("raw ip of BSD", "loopback", "cooked", "cooked 2"),
    ],
)
def test_a_datagram_is_found_behind_every_kind_of_header(tmp_path, link_type, packet):
    path = written(tmp_path, classic([packet], link_type=link_type))

    (batch,), _ = read(path)

    assert (batch.port.tolist(), batch.length.tolist()) == ([2368], [40])
    assert np.all(batch.payloads(np.array([0]), 40) == 7)


@pytest.mark.parametrize(
    ("packet", "counter"),
    [
        (ethernet(udp(fragment=0x2000)), "records_fragment"),
        (ethernet(udp(fragment=0x0010)), "records_fragment"),
        (ethernet(udp())[:60], "records_cut"),
        (ethernet(udp(), ethertype=0x86DD), "records_not_udp"),
        (ethernet(bytes(46), ethertype=0x0806), "records_not_udp"),
        (b"\x00" * 9, "records_not_udp"),
    ],
    ids=["first fragment", "later fragment", "snap length", "ipv6", "arp", "runt"],
)
def test_other_packets_are_counted_and_left_out(tmp_path, packet, counter):
    path = written(tmp_path, classic([packet, ethernet(udp())]))

    (batch,), report = read(path)

    assert len(batch) == 1
    assert report.counts == {"records": 2, counter: 1}


def test_a_file_cut_anywhere_yields_all_whole_packets_before_the_cut(tmp_path):
    packets = [ethernet(udp(bytes([n]) * 50)) for n in range(3)]
    content = classic(packets)
    one = 16 + len(packets[0])

    for cut in range(24 + one, len(content)):
        batches, report = read(written(tmp_path, content[:cut]))

        whole, rest = divmod(cut - 24, one)
        assert sum(len(batch) for batch in batches) == whole
        assert report.outcome == ("lossy" if rest else "complete")
        assert report.counts["files_cut"] == (1 if rest else 0)


def test_a_record_header_of_nonsense_ends_the_reading(tmp_path):
    content = classic([ethernet(udp())] * 2) + b"\xff" * 16 + classic([ethernet(udp())] * 2)[24:]

    batches, report = read(written(tmp_path, content))

    assert sum(len(batch) for batch in batches) == 2
    assert report.outcome == "lossy"
    assert warned(report, K.CAPTURE_SALVAGED, at=220, most=262144)


@pytest.mark.parametrize("size", [0, 4, 23])
def test_an_empty_file_is_refused_in_words(tmp_path, size):
    path = written(tmp_path, classic([])[:size])

    with pytest.raises(EmptyRecording, match=r"capture\.pcap: (the file is empty|cut inside)"):
        read(path)


def test_a_capture_without_packets_is_refused(tmp_path):
    with pytest.raises(EmptyRecording, match="without any packet"):
        read(written(tmp_path, classic([])))


def test_another_kind_of_file_is_refused_with_its_first_bytes(tmp_path):
    path = written(tmp_path, b"# .PCD v0.7 - Point Cloud Data")

    assert not is_pcap(path)
    with pytest.raises(
        UnknownFormat, match=r"expected a capture file.*got first bytes 23 20 2e 50"
    ):
        read(path)


def test_a_capture_of_another_network_is_refused(tmp_path):
    with pytest.raises(UnknownFormat, match="got link type 105"):
        read(written(tmp_path, classic([bytes(60)], link_type=105)))


def next_generation(packets):
    import io

    import dpkt

    file = io.BytesIO()
    writer = dpkt.pcapng.Writer(file)
    for packet in packets:
        writer.writepkt(packet, ts=SECONDS + 0.25)
    return file.getvalue()


def test_a_pcapng_file_is_read_and_salvaged(tmp_path):
    content = next_generation([ethernet(udp())] * 5)

    (batch,), report = read(written(tmp_path, content))
    (cut,), cut_report = read(written(tmp_path, content[:-20]))

    assert is_pcap(tmp_path / "capture.pcap")
    assert batch.t_ns.tolist() == [SECONDS * 10**9 + 250_000_000] * 5
    assert np.all(batch.payloads(np.arange(5), 40) == 7)
    assert report.outcome == "complete"
    assert (len(cut), cut_report.outcome) == (4, "lossy")


def block(kind, body):
    size = struct.pack("<I", len(body) + 12)
    return struct.pack("<I", kind) + size + body + size


def interfaces(*link_types):
    """The begin of a pcapng file with some interfaces."""
    section = block(0x0A0D0D0A, struct.pack("<IHHq", 0x1A2B3C4D, 1, 0, -1))
    return section + b"".join(block(1, struct.pack("<HHI", link, 0, 0)) for link in link_types)


def seen(interface, t_us, packet):
    """A packet that was captured by an interface."""
    size = len(packet)
    head = struct.pack("<IIIII", interface, t_us >> 32, t_us & 0xFFFF_FFFF, size, size)
    return block(6, head + packet + bytes(-size % 4))


def test_interfaces_that_are_written_in_bursts_are_read_in_order_of_time(tmp_path):
    bursts = [(k % 2, 10**9 + 2000 * step + 1000 * (k % 2)) for k in range(2) for step in range(5)]
    content = interfaces(1, 1) + b"".join(seen(*one, ethernet(udp())) for one in bursts)

    (batch,), _ = read(written(tmp_path, content))

    assert np.diff(batch.t_ns).tolist() == [1_000_000] * 9


def test_an_interface_of_another_network_hides_no_other_one(tmp_path):
    others = b"".join(seen(0, 10**9 + k, bytes(64)) for k in range(3000))
    content = interfaces(220, 1) + others + seen(1, 2 * 10**9, ethernet(udp()))

    batches, report = read(written(tmp_path, content))

    assert sum(map(len, batches)) == 1
    assert report.counts["records_not_udp"] == 3000
    with pytest.raises(UnknownFormat, match="got link type 220"):
        read(written(tmp_path, interfaces(220, 1) + others))


def test_a_pcapng_file_of_packets_without_times_says_so(tmp_path):
    content = next_generation([])
    packet = ethernet(udp())
    body = struct.pack("<I", len(packet)) + packet + bytes(-len(packet) % 4)
    size = struct.pack("<I", len(body) + 12)
    content += struct.pack("<I", 3) + size + body + size

    with pytest.raises(EmptyRecording, match="packet that has a time; 1 have none"):
        read(written(tmp_path, content))


def numbered(first, count):
    """Datagrams whose payloads are numbers."""
    return [ethernet(udp(bytes([first + k]) * 40)) for k in range(count)]


@pytest.mark.parametrize("first", [classic, next_generation])
@pytest.mark.parametrize("second", [classic, next_generation])
def test_captures_that_follow_each_other_in_a_file_are_read(tmp_path, first, second):
    content = first(numbered(0, 3)) + second(numbered(3, 2)) + classic(numbered(5, 1), order=">")

    batches, report = read(written(tmp_path, content))

    sections = first is second is next_generation  # which a pcapng file may have
    found = [b.payload(row)[0] for b in batches for row in range(len(b))]
    assert found == list(range(6))
    assert report.counts == {"records": 6, "captures_joined": 1 if sections else 2}
    assert report.outcome == "complete"


@pytest.mark.parametrize(
    ("second", "why"),
    [(classic([], link_type=147), "link type 147"), (classic([])[:20], "cut inside")],
)
def test_a_second_capture_that_is_none_is_named_with_its_place(tmp_path, second, why):
    first = classic(numbered(0, 3))

    batches, report = read(written(tmp_path, first + second))

    assert sum(map(len, batches)) == 3
    assert report.outcome == "lossy"
    (said,) = report.said()
    assert f"capture.pcap, capture at byte {len(first)}" in said and why in said


@pytest.mark.parametrize("lengths", [(None, 0), (0, 0)])
def test_a_length_that_was_left_to_the_network_card_is_that_of_the_packet(tmp_path, lengths):
    padding = bytes(6) if lengths[0] is None else b""
    packet = ethernet(udp(lengths=lengths)) + padding

    (batch,), report = read(written(tmp_path, classic([packet])))

    assert (batch.length.tolist(), report.counts) == ([40], {"records": 1})


def test_what_the_writer_writes_is_what_the_reader_reads(tmp_path):
    t_ns, payloads = spin(4000)
    path = tmp_path / "walk.pcap"
    with PcapWriter(path) as file:
        file.write(t_ns[:1], payloads[:1], source="192.168.1.201")
        file.write(t_ns[1:], payloads[1:], source="192.168.1.202", port=2369)

    batches, report = read(path)

    assert len(batches) > 1
    np.testing.assert_array_equal(np.concatenate([b.t_ns for b in batches]), t_ns)
    again = [b.payloads(np.arange(len(b)), 1206) for b in batches]
    np.testing.assert_array_equal(np.concatenate(again), payloads)
    assert address_text(batches[0].source[1]) == "192.168.1.202"
    assert batches[0].port[:2].tolist() == [2368, 2369]
    assert report.counts == {"records": 4000}
