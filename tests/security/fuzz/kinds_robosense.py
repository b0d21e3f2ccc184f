"""Packets of RoboSense LiDARs: each way to pack blocks, device packets among them."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path

import numpy as np

from recon4.model.rig import Sensor
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.packets.family import PacketSensor, Payloads
from recon4.recording.packets.robosense.encode import (
    SpinningBlocks,
    encode_device,
    encode_solid,
    encode_spinning,
)
from recon4.recording.packets.robosense.family import FAMILY as ROBOSENSE
from recon4.recording.packets.robosense.models import MODELS
from recon4.recording.packets.robosense.packets import packet_s
from recon4.recording.packets.robosense.solid import MIDDLE, SOLID_MODELS
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS
from tests.security.fuzz import seeds_tables as tables
from tests.security.fuzz.kind import Kind, Reading

_PACKETS = 12
_NAMES = ("Helios 5515", "Bpearl", "Ruby Plus", "Airy", "M1", "E1")


def packets_of(name: str) -> Payloads:
    """Data packets of a wall, with a device packet in the middle if it has angles."""
    if name in SOLID_MODELS:
        solid = SOLID_MODELS[name]
        blocks = np.zeros((_PACKETS, solid.blocks), solid.block)
        blocks["points"]["distance"] = 1000
        for field in {"yaw", "pitch", "vector"} & set(solid.block["points"].base.names or ()):
            blocks["points"][field] = MIDDLE // 2
        return encode_solid(T0_NS + 1000 * np.arange(_PACKETS), blocks, solid)
    model = MODELS[name]
    layout = model.layout
    t_ns = T0_NS + np.rint(np.arange(_PACKETS) * packet_s(model, dual=False) * 1e9).astype(np.int64)
    block = np.arange(layout.blocks)
    azimuth = 40 * (np.arange(_PACKETS)[:, None] * layout.blocks + block) // model.rows
    shape = (_PACKETS, layout.blocks, layout.channels)
    data = encode_spinning(
        t_ns, SpinningBlocks(azimuth, np.full(shape, 2000), np.full(shape, 90)), model
    )
    laser = np.arange(model.lasers)
    device = encode_device(np.column_stack([10 * laser, 5 - 10 * laser]), model)
    return np.concatenate([data[:6], device, data[6:]])


@cache
def _seeds(name: str) -> tuple[bytes, ...]:
    return (packets_of(name).tobytes(),)


def _read(name: str, path: Path) -> Reading:
    """Packets of one sensor, one behind the other."""
    size = SOLID_MODELS[name].size if name in SOLID_MODELS else 1248
    data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    payloads = data[: len(data) // size * size].reshape(-1, size)
    head = datagrams_of([T0_NS] * len(payloads), [row.tobytes() for row in payloads])
    ROBOSENSE.recognize(head, ())
    report = ImportReport()
    base: Sensor = tables.rig().sensors[0]
    sensor = Sensor(name=base.name, model=name, T_body_sensor=base.T_body_sensor)
    settings = IngestSettings()
    layout = ROBOSENSE.open(
        PacketSensor(row=0, sensor=sensor, head=head, settings=settings, report=report)
    )
    sound = payloads[layout.sound(payloads)]
    shots = layout.decode(layout.stamps_ns(sound), sound)
    assert np.isfinite(shots.xyz).all()
    assert np.abs(shots.xyz).max(initial=0) <= 2 * settings.max_range_m
    return Reading(len(shots), salvaged=len(sound) < _PACKETS or len(data) % size > 0)


KINDS = tuple(
    Kind(
        name=f"robosense-{name.lower().replace(' ', '-')}",
        file_name="packets.bin",
        seeds=partial(_seeds, name),
        read=partial(_read, name),
        # A run of packets has no end mark.
        knows_end=False,
    )
    for name in _NAMES
)
"""Data packets."""
