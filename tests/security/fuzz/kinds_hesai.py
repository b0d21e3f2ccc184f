"""Packets of Hesai LiDARs, of every layout, and their tables of angles."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError
from recon4.recording.packets.family import Companion
from recon4.recording.packets.hesai import checksums
from recon4.recording.packets.hesai.angles import NotAngles, read_angles
from recon4.recording.packets.hesai.family import FAMILY as HESAI
from recon4.recording.packets.hesai.mirrors import read_mirrors
from recon4.recording.packets.hesai.models import MODELS
from recon4.recording.packets.sensor_clock import SensorClock
from tests.security.fuzz.kind import Kind, Reading
from tests.unit.recording.hesai_mirrors import mirror_table
from tests.unit.recording.hesai_packets import datagrams, packet_sensor, table_of
from tests.unit.recording.test_hesai_packets import spin

_PACKETS = 12
_NAMES = ("Pandar40P", "QT128", "JT128", "JT16", "AT128")
"""One of each way to lay out blocks and tails."""


@cache
def _seeds(name: str) -> tuple[bytes, ...]:
    model = MODELS[name]
    modes = (0x37,) if name == "JT16" else (0x37, 0x39)
    return tuple(spin(model, packets=_PACKETS, mode=mode)[2].tobytes() for mode in modes)


def _read(name: str, path: Path) -> Reading:
    """Data packets of one sensor, one behind the other; the first ones tell what they are."""
    data, size = path.read_bytes(), MODELS[name].layout.size
    payloads = np.frombuffer(data[: len(data) // size * size], np.uint8).reshape(-1, size)
    head = datagrams(payloads)
    found = HESAI.recognize(head, ())
    companions = (table_of(MODELS["OT128"].angles), mirror_table())
    model = name if found is None or found.kind != "data" else found.model
    sensor = packet_sensor(model, head=head, companions=companions)
    try:
        made = HESAI.open(sensor)
    except ConfigError:  # its first packets became those of another model
        return Reading(0, salvaged=True)
    payloads = payloads if made.size == size else np.zeros((0, made.size), np.uint8)
    sound = payloads[made.sound(payloads)]
    shots = made.decode(made.stamps_ns(sound), sound)
    clock = SensorClock("lidar", packet_s=made.packet_s, report=sensor.report)
    samples = made.samples(head, clock)
    assert samples is None or np.isfinite(samples.imu.accel_m_s2).all()
    layout, counts = made.packets.layout, sensor.report.counts
    assert np.isfinite(shots.xyz).all()
    outside = sum(counts[f"points_{key}"] for key in ("near", "far"))
    assert len(shots) + outside <= len(sound) * layout.blocks * layout.channels
    damaged = len(sound) * size < len(data)
    return Reading(len(shots), salvaged=damaged)


def _repair(name: str, data: bytes) -> bytes:
    """The same with right checksums."""
    layout = MODELS[name].layout
    whole = len(data) // layout.size * layout.size
    payloads = np.frombuffer(data[:whole], np.uint8).reshape(-1, layout.size).copy()
    checksums.write(payloads, layout)
    return payloads.tobytes() + data[whole:]


def _read_table(path: Path) -> Reading:
    """A file beside a recording as a table of angles, of text or of mirrors."""
    companion = Companion(path.name, path.read_bytes())
    HESAI.describes(companion)
    mirrors = read_mirrors(companion)
    if mirrors is not None:
        return Reading(len(mirrors.azimuth), salvaged=False)
    try:
        angles = read_angles(companion)
    except NotAngles:
        return Reading(0, salvaged=True)
    return Reading(0 if angles is None else len(angles.azimuth_rad), salvaged=angles is None)


KINDS = (
    *(
        Kind(
            name=f"hesai-{name}",
            file_name="packets.bin",
            seeds=partial(_seeds, name),
            read=partial(_read, name),
            repair=partial(_repair, name) if MODELS[name].layout.crc_at >= 0 else None,
            # A run of packets has no end mark.
            knows_end=False,
        )
        for name in _NAMES
    ),
    Kind(
        name="hesai-angles",
        file_name="angles.csv",
        seeds=lambda: (table_of(MODELS["XT16"].angles).content, mirror_table().content),
        read=_read_table,
        # A table has no end mark.
        knows_end=False,
    ),
)
"""Data packets and tables."""
