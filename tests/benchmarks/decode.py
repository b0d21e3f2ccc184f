"""One second of two VLP-16 decoded: recon4 against velodyne-decoder, in one run on one thread.

Run: ``python tests/benchmarks/decode.py [ROUNDS]``
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import velodyne_decoder

from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.velodyne.data_packets import PacketDecoder
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.packet_builders import sensor, spin

SENSORS = 2
PACKETS = 754
"""Packets of a VLP-16 per second."""
BATCH = 76
"""Packets of a revolution: as they come in the messages of a bag."""


def ours(t_ns: np.ndarray, payloads: np.ndarray, batch: int) -> int:
    """Filter, order, clock, decode; returns the points."""
    points = 0
    for row in range(SENSORS):
        decoder = PacketDecoder(
            row, sensor(), settings=IngestSettings(min_range_m=0.0), report=ImportReport()
        )
        for at in range(0, len(t_ns), batch):
            points += len(decoder.push(t_ns[at : at + batch], payloads[at : at + batch]))
        points += len(decoder.flush())
    return points


def theirs(packets: list[velodyne_decoder.VelodynePacket]) -> int:
    """Decode without filter, order and duplicates; returns the points."""
    points = 0
    for _ in range(SENSORS):
        config = velodyne_decoder.Config(model=velodyne_decoder.Model.VLP16, min_range=0)
        decoder = velodyne_decoder.ScanDecoder(config)
        for at in range(0, len(packets), BATCH):
            scan = velodyne_decoder.PacketVector(packets[at : at + BATCH])
            points += len(decoder.decode(scan)[1])
    return points


def from_file(path: Path) -> int:
    """Read a pcap of both sensors; returns the datagrams."""
    return sum(len(batch) for batch in read_pcap(path, ImportReport()))


def milliseconds(rounds: int, work: Callable[[], int]) -> tuple[float, float, int]:
    """Median and best CPU time of some rounds after one to warm up, and the result."""
    result = work()
    times = []
    for _ in range(rounds):
        start = time.process_time()
        work()
        times.append(1e3 * (time.process_time() - start))
    return float(np.median(times)), min(times), result


def main(rounds: int) -> None:
    """Measure and print."""
    t_ns, payloads = spin(PACKETS)
    packets = [
        velodyne_decoder.VelodynePacket(float(t) / 1e9, bytes(p))
        for t, p in zip(t_ns, payloads, strict=True)
    ]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "two.pcap"
        with PcapWriter(path) as file:
            file.write(t_ns, payloads, source="192.168.1.201")
            file.write(t_ns, payloads, source="192.168.1.202")
        rows = {
            "recon4, a revolution at a time": lambda: ours(t_ns, payloads, BATCH),
            "recon4, a second at a time": lambda: ours(t_ns, payloads, PACKETS),
            "velodyne-decoder": lambda: theirs(packets),
            "recon4, pcap to datagrams": lambda: from_file(path),
        }
        found = {name: milliseconds(rounds, work) for name, work in rows.items()}
    peer = found["velodyne-decoder"][0]
    print(f"{'':34} {'CPU ms':>9} {'best ms':>8} {'result':>8}  of velodyne-decoder")
    for name, (median, best, result) in found.items():
        print(f"{name:34} {median:9.2f} {best:8.2f} {result:8d}  {median / peer:.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 40)
