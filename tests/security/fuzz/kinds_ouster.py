"""Packets of Ouster LiDARs, one profile of each layout, their IMU, and their metadata."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path

import numpy as np

from recon4.recording.formats.datagrams import Datagrams, datagrams_of
from recon4.recording.packets.family import Companion, PacketFormat, PacketSensor, Payloads
from recon4.recording.packets.ouster.data_packets import checksums
from recon4.recording.packets.ouster.encode import (
    ColumnReturns,
    encode_imu,
    encode_packets,
    metadata_json,
)
from recon4.recording.packets.ouster.family import FAMILY as OUSTER
from recon4.recording.packets.ouster.metadata import OusterMetadata
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS
from tests.ouster_models import nominal_metadata
from tests.security.fuzz.kind import Kind, Reading
from tests.unit.recording.packet_builders import sensor

_PACKETS = 6
_PROFILES = ("LEGACY", "RNG19_RFL8_SIG16_NIR16_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL")


@cache
def metadata_of(profile: str, model: str = "OS1-32") -> OusterMetadata:
    """Of a sensor that sends a profile."""
    return nominal_metadata(model, profile=profile)


def packets_of(metadata: OusterMetadata, count: int = _PACKETS) -> Payloads:
    """Data packets in a room, a third of the shots without return."""
    layout = metadata.layout
    place = np.arange(count * layout.columns).reshape(count, layout.columns)
    shape = (len(layout.profile.echoes), *place.shape, layout.beams)
    rng = np.random.default_rng(4)
    range_mm = 3000 + 8 * rng.integers(0, 500, shape)
    range_mm[:, rng.random(shape[1:]) < 0.33] = 0
    step_ns = round(1e9 / (10.0 * metadata.columns_per_turn))
    returns = ColumnReturns(
        T0_NS + step_ns * place,
        place % metadata.columns_per_turn,
        range_mm,
        rng.integers(1, 200, shape),
    )
    return encode_packets(metadata, returns)


def opened(metadata: bytes, head: Datagrams, report: ImportReport) -> PacketFormat:
    """The format of the packets of a sensor with these metadata."""
    return OUSTER.open(
        PacketSensor(
            row=0,
            sensor=sensor(model="Ouster"),
            head=head,
            companions=(Companion("os.json", metadata),),
            settings=IngestSettings(),
            report=report,
        )
    )


def _rows(path: Path, size: int) -> Payloads:
    data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    return data[: len(data) // size * size].reshape(-1, size)


def _datagrams(payloads: Payloads) -> Datagrams:
    times = (T0_NS + 1_562_500 * np.arange(len(payloads))).tolist()
    return datagrams_of(times, [row.tobytes() for row in payloads])


def _read(profile: str, path: Path) -> Reading:
    """Data packets of one sensor, one behind the other."""
    metadata = metadata_of(profile)
    payloads = _rows(path, metadata.layout.size)
    head = _datagrams(payloads)
    OUSTER.recognize(head, ())
    report = ImportReport()
    # The sensor is known from its metadata, however damaged its first packets are.
    packets = opened(metadata_json(metadata), head.take(slice(0)), report)
    sound = payloads[packets.sound(payloads)]
    stamps_ns = packets.stamps_ns(sound)
    packets.azimuth_cdeg(sound)
    shots = packets.decode(stamps_ns, sound)
    assert np.isfinite(shots.xyz).all()
    assert (shots.t_ns >= 0).all()
    assert np.linalg.norm(shots.xyz, axis=1).max(initial=0.0) < 121.0
    left = path.stat().st_size % metadata.layout.size
    return Reading(len(shots), salvaged=len(sound) < len(payloads) or left > 0)


def _repaired(profile: str, data: bytes) -> bytes:
    """Make the sums right again."""
    layout = metadata_of(profile).layout
    whole = len(data) // layout.size * layout.size
    payloads = np.frombuffer(data[:whole], dtype=np.uint8).reshape(-1, layout.size).copy()
    if layout.profile.has_header and len(payloads):
        layout.records(payloads)["crc"] = checksums(payloads)
    return payloads.tobytes() + data[whole:]


def _read_imu(path: Path) -> Reading:
    payloads = _rows(path, 48)
    report = ImportReport()
    metadata = metadata_of("LEGACY")
    packets = opened(metadata_json(metadata), _datagrams(packets_of(metadata)), report)
    datagrams = _datagrams(payloads)
    OUSTER.recognize(datagrams, ())
    clock = SensorClock("os", packet_s=0.0016, report=report)
    clock.past_hour = False
    found = packets.samples(datagrams, clock)
    imu = found.imu if found is not None else None
    if imu is not None:
        assert (np.diff(imu.t_ns) > 0).all()
        assert np.isfinite(imu.accel_m_s2).all()
        assert np.isfinite(imu.gyro_rad_s).all()
    damaged = any(report.counts[name] for name in ("samples_damaged", "samples_out_of_order"))
    return Reading(
        len(imu) if imu is not None else 0, salvaged=damaged or path.stat().st_size % 48 > 0
    )


def _imu_seeds() -> tuple[bytes, ...]:
    t_ns = T0_NS + 10_000_000 * np.arange(20)
    rng = np.random.default_rng(2)
    return (encode_imu(t_ns, rng.normal(0, 5, (20, 3)), rng.normal(0, 1, (20, 3))).tobytes(),)


def _read_metadata(path: Path) -> Reading:
    metadata = metadata_of("RNG19_RFL8_SIG16_NIR16")
    payloads = packets_of(metadata)
    head = _datagrams(payloads)
    content = path.read_bytes()
    OUSTER.recognize(head, (Companion("os.json", content),))
    report = ImportReport()
    packets = opened(content, head, report)
    sound = payloads[packets.sound(payloads)]
    shots = packets.decode(packets.stamps_ns(sound), sound)
    assert np.isfinite(shots.xyz).all()
    return Reading(len(shots), salvaged=bool(report.findings or report.derived))


def _metadata_seeds() -> tuple[bytes, ...]:
    return (metadata_json(metadata_of("RNG19_RFL8_SIG16_NIR16")),)


KINDS = (
    *(
        Kind(
            name=f"ouster-{profile.split('_')[0].lower()}",
            file_name="packets.bin",
            seeds=lambda profile=profile: (packets_of(metadata_of(profile)).tobytes(),),
            read=partial(_read, profile),
            repair=partial(_repaired, profile),
            # A run of packets has no end mark.
            knows_end=False,
        )
        for profile in _PROFILES
    ),
    Kind(
        name="ouster-imu",
        file_name="imu.bin",
        seeds=_imu_seeds,
        read=_read_imu,
        knows_end=False,
    ),
    Kind(
        name="ouster-metadata",
        file_name="os.json",
        seeds=_metadata_seeds,
        read=_read_metadata,
        knows_end=False,
    ),
)
"""Data packets, inertial packets and metadata."""
