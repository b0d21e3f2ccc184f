"""One second of packets decoded, in one run on one thread.

Two VLP-16: recon4 against velodyne-decoder. Other families: how many times faster than real time.

Run: ``python tests/benchmarks/decode.py [ROUNDS]``
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import velodyne_decoder

from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import PacketFormat, PacketSensor
from recon4.recording.packets.hesai.models import MODELS as HESAI_MODELS
from recon4.recording.packets.livox.models import LAYOUTS, PointLayout
from recon4.recording.packets.livox.points import LivoxSource, decode_points
from recon4.recording.packets.livox.sound import sound_points
from recon4.recording.packets.livox.sound import stamps_ns as livox_stamps_ns
from recon4.recording.packets.ouster.encode import metadata_json
from recon4.recording.packets.robosense.models import MODELS as ROBOSENSE_MODELS
from recon4.recording.packets.robosense.packets import packet_s as robosense_packet_s
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.packets.velodyne.laser_calibration import calibration_of_file
from recon4.recording.packets.velodyne.wide_encode import encode_wide
from recon4.recording.packets.velodyne.wide_models import VLS128, WideModel, hdl64_model
from recon4.recording.report import ImportReport
from recon4.sandbox.freed_memory import return_freed_memory
from recon4.sandbox.tuning import CONFINEMENT
from recon4.settings import IngestSettings
from tests.security.fuzz.kinds_livox import model_of as livox_model
from tests.security.fuzz.kinds_livox import packets_of as livox_packets
from tests.security.fuzz.kinds_ouster import metadata_of as ouster_metadata
from tests.security.fuzz.kinds_ouster import opened as ouster_format
from tests.security.fuzz.kinds_ouster import packets_of as ouster_packets
from tests.unit.recording.packet_builders import sensor, spin
from tests.unit.recording.test_hesai_packets import opened as hesai_opened
from tests.unit.recording.test_hesai_packets import spin as hesai_spin
from tests.unit.recording.test_robosense_packets import datagrams, device_of
from tests.unit.recording.test_robosense_packets import opened as robosense_opened
from tests.unit.recording.test_robosense_packets import spin as robosense_spin
from tests.unit.recording.test_velodyne_wide import decoded as wide_decoded
from tests.unit.recording.test_velodyne_wide import hdl64_yaml, wall

SENSORS = 2
PACKETS = 754
"""Packets of a VLP-16 per second."""
LIVOX_PACKETS = 100
"""Different packets of a Livox, sent again and again."""
OUSTERS = (
    ("LEGACY", "OS0-32", 1024),
    ("RNG19_RFL8_SIG16_NIR16", "OS1-64", 1024),
    ("RNG15_RFL8_NIR8", "OS1-128", 1024),
    ("RNG15_RFL8_NIR8", "OS1-128", 2048),
    ("RNG19_RFL8_SIG16_NIR16", "OS0-128", 1024),
    ("RNG19_RFL8_SIG16_NIR16", "OS0-128", 2048),
    ("RNG19_RFL8_SIG16_NIR16_DUAL", "OS1-128", 1024),
    ("RNG19_RFL8_SIG16_NIR16_DUAL", "OS1-128", 2048),
)
"""Profile, model and columns of a revolution; 2048 at 10 Hz are as many as 1024 at 20 Hz."""
BATCH = 76
"""Packets of a revolution: as they come in the messages of a bag."""


def ours(t_ns: np.ndarray, payloads: np.ndarray, batch: int) -> int:
    """Filter, order, clock, decode; returns the points."""
    points = 0
    for row in range(SENSORS):
        decoder = open_decoder(
            PacketSensor(
                row=row,
                sensor=sensor(),
                settings=IngestSettings(min_range_m=0.0),
                report=ImportReport(),
            )
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


def livox(layout: PointLayout) -> Callable[[], int]:
    """One second of a Mid-360 (SDK2) or an Avia (SDK1): filter and decode."""
    source = LivoxSource(0, livox_model(layout), layout, IngestSettings())
    seconds = LIVOX_PACKETS * layout.shots * source.model.shot_s
    payloads = np.tile(livox_packets(layout, LIVOX_PACKETS), (round(1.0 / seconds), 1))

    def work() -> int:
        report = ImportReport()
        points = 0
        for batch in np.array_split(payloads, 10):
            assert sound_points(batch, layout, report, by_crc=layout.sdk == 2).all()
            t_ns = livox_stamps_ns(batch, layout.sdk)
            points += len(decode_points(t_ns, batch, source, report=report))
        return points

    return work


def ouster(profile: str, model: str, columns: int) -> Callable[[], int]:
    """One second of an Ouster at 10 Hz: filter, clock's stamps and decode."""
    metadata = replace(ouster_metadata(profile, model), columns_per_turn=columns)
    packets = round(10 * metadata.columns_per_turn / metadata.layout.columns)
    payloads = ouster_packets(metadata, packets)
    head = datagrams_of(range(8), [row.tobytes() for row in payloads[:8]])
    layout = ouster_format(metadata_json(metadata), head, ImportReport())

    def work() -> int:
        points = 0
        for batch in np.array_split(payloads, 10):
            assert layout.sound(batch).all()
            layout.azimuth_cdeg(batch)
            points += len(layout.decode(layout.stamps_ns(batch), batch))
        return points

    return work


def hesai(name: str) -> Callable[[], int]:
    """One second of a Hesai: filter and decode."""
    model = HESAI_MODELS[name]
    packet_s = np.diff(hesai_spin(model, packets=2)[0])[0] * 1e-6
    payloads = hesai_spin(model, packets=round(1.0 / packet_s))[2]
    made, _ = hesai_opened(model, payloads[:100])

    def work() -> int:
        points = 0
        for batch in np.array_split(payloads, 10):
            assert made.sound(batch).all()
            points += len(made.decode(made.stamps_ns(batch), batch))
        return points

    return work


def robosense(name: str) -> Callable[[], int]:
    """One second of a RoboSense that spins: filter, stamps and decode."""
    model = ROBOSENSE_MODELS[name]
    payloads = robosense_spin(model, round(1.0 / robosense_packet_s(model, dual=False)))[1]
    return _decoding(robosense_opened(name, beside=datagrams(device_of(model))), payloads)


def wide(model: WideModel) -> Callable[[], int]:
    """One second of a Velodyne whose firing takes several blocks: filter, stamps and decode."""
    payloads = encode_wide(*wall(round(1.0 / model.packet_s(dual=False)), model), model=model)
    layout, _, _ = wide_decoded(model.name, payloads[:100], [hdl64_yaml()])
    return _decoding(layout, payloads)


def _decoding(layout: PacketFormat, payloads: np.ndarray) -> Callable[[], int]:
    def work() -> int:
        points = 0
        for batch in np.array_split(payloads, 10):
            assert layout.sound(batch).all()
            points += len(layout.decode(layout.stamps_ns(batch), batch))
        return points

    return work


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
    """Measure and print, with the memory of a process that reads multiframes."""
    return_freed_memory(above=CONFINEMENT.returned_packet_bytes)
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
    print(f"\n{'':34} {'CPU ms':>9} {'best ms':>8} {'points':>8}  times real time")
    for layout in LAYOUTS:
        median, best, result = milliseconds(rounds, livox(layout))
        name = f"Livox SDK{layout.sdk}, data type {layout.data_type}"
        print(f"{name:34} {median:9.2f} {best:8.2f} {result:8d}  {1e3 / median:.0f}")
    for profile, kind, columns in OUSTERS:
        median, best, result = milliseconds(rounds, ouster(profile, kind, columns))
        name = f"{kind} {columns} {profile}"
        print(f"{name:34} {median:9.2f} {best:8.2f} {result:8d}  {1e3 / median:.0f}")
    for name in HESAI_MODELS:
        median, best, result = milliseconds(max(rounds // 4, 1), hesai(name))
        print(f"{'Hesai ' + name:34} {median:9.2f} {best:8.2f} {result:8d}  {1e3 / median:.0f}")
    for name in ROBOSENSE_MODELS:
        median, best, result = milliseconds(max(rounds // 4, 1), robosense(name))
        print(f"{'RoboSense ' + name:34} {median:9.2f} {best:8.2f} {result:8d}  {1e3 / median:.0f}")
    for model in (VLS128, hdl64_model(calibration_of_file(hdl64_yaml()), s3=True)):
        median, best, result = milliseconds(max(rounds // 4, 1), wide(model))
        print(f"{model.name:34} {median:9.2f} {best:8.2f} {result:8d}  {1e3 / median:.0f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 40)
