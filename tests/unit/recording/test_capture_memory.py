"""What of a capture is in memory at once: it grows neither with the file nor with its first second.

Captured datagrams are made up; what follows them is the reader of captures.
"""

import math
import weakref

import numpy as np
import pytest

from recon4.recording.assembly.assembler import Assembler
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.datagrams import Datagrams, datagrams_of, join_datagrams
from recon4.recording.packets.capture import PacketCapture
from recon4.recording.packets.slots import in_slots
from recon4.recording.packets.streams import scan_pcap
from recon4.recording.packets.tuning import SLOTS
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.packet_builders import T0_NS, rig, sensor, spin

SIZE = 60_000


def much(count=1000):
    """A sensor that sends 60 MB in its first second."""
    payloads = [bytes([k % 256]) * SIZE for k in range(count)]
    return datagrams_of([T0_NS + 1_000_000 * k for k in range(count)], payloads)


@pytest.mark.parametrize("piece", [1000, 64, 7])
def test_a_slot_has_at_most_so_many_bytes_however_the_file_is_read(piece):
    whole = much()
    rows = range(0, len(whole), piece)
    batches = (whole.take(slice(at, at + piece)).compact() for at in rows)

    slots = list(in_slots(batches))

    most = SLOTS.bytes // SIZE
    assert [len(slot) for slot in slots] == [most, 500 - most, *[100] * 5]
    assert [slot.payload(0)[0] for slot in slots[:3]] == [0, most % 256, 500 % 256]
    np.testing.assert_array_equal(join_datagrams(slots).t_ns, whole.t_ns)


def test_the_first_packets_of_a_sensor_keep_nothing_else_of_the_file(tmp_path):
    t_ns, payloads = spin(200)
    with PcapWriter(tmp_path / "a.pcap") as file:
        for rows in np.array_split(np.arange(200), 20):
            file.write(t_ns[rows], payloads[rows], source="192.168.1.201")
            file.write(t_ns[rows], np.zeros((10, 1400), np.uint8), source="192.168.1.9", port=99)

    streams = scan_pcap(tmp_path / "a.pcap")

    assert [stream.head.buffer.nbytes for stream in streams] == [200 * 1206, 200 * 1400]
    head: Datagrams = streams[0].head
    np.testing.assert_array_equal(head.payloads(np.arange(200), 1206), payloads)


def test_a_slot_that_was_read_is_gone(tmp_path):
    _, payloads = spin(9000)
    with PcapWriter(tmp_path / "a.pcap") as file:  # several reads of the file in a second
        file.write(T0_NS + 130_000 * np.arange(9000), payloads, source="192.168.1.201")
    capture = PacketCapture(
        [tmp_path / "a.pcap"],
        rig(sensor(port=2368)),
        settings=IngestSettings(),
        report=ImportReport(),
    )
    slots = capture._merged()

    first = weakref.ref(next(slots)[1].buffer)
    assert next(slots)[1].t_ns[0] > T0_NS

    assert first() is None


@pytest.mark.parametrize(("rotation_hz", "turns"), [(math.nan, 6), (10.0, 5)])
def test_of_many_points_few_wait_for_the_first_frame(rotation_hz, turns):
    """Half a second, or what shows that the frame is whole where the packets say the rotation."""
    assembler = Assembler(rig(sensor(port=2368)), settings=IngestSettings(), report=ImportReport())
    count, frames = 320_000 if math.isnan(rotation_hz) else 400_000, []
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    ring = np.stack([np.cos(angle), -np.sin(angle), np.zeros(count)], axis=1)
    for turn in range(turns):
        t_ns = T0_NS + 100_000_000 * turn + np.arange(count) * 100_000_000 // count
        columns = (np.zeros(count, dtype) for dtype in (np.uint16, np.uint8, np.uint8))
        shots = Shots(0, t_ns, (5.0 * ring).astype(np.float32), *columns, rotation_hz=rotation_hz)
        frames += assembler.push(shots)

    assert len(frames) >= 3
    assert assembler.rotation_hz == {"lidar": pytest.approx(10.0, rel=0.01)}
