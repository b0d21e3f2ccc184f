"""Datagrams that the network cut into IP fragments are joined; the others are counted."""

import struct

import numpy as np
import pytest

from recon4.recording.formats.pcap import read_pcap
from recon4.recording.report import ImportReport

SENDER, HOST = bytes([192, 168, 1, 201]), bytes([192, 168, 1, 100])
PAYLOAD = bytes(range(256)) * 20


def fragments(payload=PAYLOAD, *, number=7, port=7502, size=1480):
    """IPv4 packets of one datagram."""
    data = struct.pack(">HHHH", 7502, port, 8 + len(payload), 0) + payload
    packets = []
    for at in range(0, len(data), size):
        part = data[at : at + size]
        flags = (0x2000 if at + size < len(data) else 0) | at // 8
        header = struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(part), number, flags, 64, 17, 0)
        packets.append(header + SENDER + HOST + part)
    return packets


def capture(path, packets, step_s=0.001):
    """A capture of raw IP packets."""
    with path.open("wb") as file:
        file.write(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 101))
        for k, packet in enumerate(packets):
            seconds, rest = divmod(round(k * step_s * 1e6), 1_000_000)
            file.write(
                struct.pack("<IIII", 1_700_000_000 + seconds, rest, len(packet), len(packet))
            )
            file.write(packet)
    return path


def read(path):
    report = ImportReport()
    batches = list(read_pcap(path, report))
    rows = [(b.payload(k), int(b.port[k])) for b in batches for k in range(len(b))]
    return rows, report


@pytest.mark.parametrize("order", [[0, 1, 2, 3], [3, 2, 1, 0], [0, 2, 1, 3, 3]])
def test_fragments_in_any_order_give_the_datagram(tmp_path, order):
    parts = fragments()

    rows, report = read(capture(tmp_path / "a.pcap", [parts[k] for k in order]))

    assert rows == [(PAYLOAD, 7502)]
    assert report.counts["records_fragment"] == len(order) - 4


def test_joined_datagrams_stand_among_whole_ones_at_the_time_of_their_last_fragment(tmp_path):
    first, last = fragments(b"first", number=1), fragments(b"last", number=3)

    path = capture(tmp_path / "a.pcap", [*first, *fragments(), *last])
    rows, _ = read(path)
    (batch,) = read_pcap(path, ImportReport())

    assert [payload for payload, _ in rows] == [b"first", PAYLOAD, b"last"]
    np.testing.assert_array_equal((batch.t_ns - batch.t_ns[0]) // 1_000_000, [0, 4, 5])


def test_a_datagram_without_one_fragment_is_counted_with_its_port(tmp_path):
    rows, report = read(capture(tmp_path / "a.pcap", [*fragments()[:-1], *fragments(b"x")]))

    assert rows == [(b"x", 7502)]
    assert report.counts["records_fragment"] == 3
    assert "7502" in report.details["records_fragment"]


def test_a_number_that_repeats_much_later_is_another_datagram(tmp_path):
    parts = [*fragments()[:2], *fragments(PAYLOAD[::-1])]

    rows, report = read(capture(tmp_path / "a.pcap", parts, step_s=10.0 / 3))

    assert rows == []  # the fragments of one datagram do not come seconds apart
    assert report.counts["records_fragment"] == len(parts)


def test_fragments_that_overlap_or_reach_too_far_are_no_datagram(tmp_path):
    parts = fragments()
    overlapping = [parts[0], fragments(size=1472)[1], *parts[2:]]
    far = bytearray(parts[-1])
    far[6:8] = struct.pack(">H", 0x1FFF)

    rows, report = read(capture(tmp_path / "a.pcap", [*overlapping, bytes(far)]))

    assert rows == []
    assert report.counts["records_fragment"] == 5
