"""Packets of RoboSense LiDARs: each way to pack blocks, device packets among them."""

from __future__ import annotations

from functools import cache, partial

import numpy as np

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.robosense.encode import (
    SpinningBlocks,
    encode_device,
    encode_solid,
    encode_spinning,
)
from recon4.recording.packets.robosense.family import FAMILY as ROBOSENSE
from recon4.recording.packets.robosense.models import MODELS, SIZE
from recon4.recording.packets.robosense.packets import packet_s
from recon4.recording.packets.robosense.solid import MIDDLE, SOLID_MODELS
from tests.builders import T0_NS
from tests.security.fuzz.kind import Kind
from tests.security.fuzz.packets import PacketRun

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


def _size(name: str) -> int:
    return SOLID_MODELS[name].size if name in SOLID_MODELS else SIZE


KINDS = tuple(
    Kind(
        name=f"robosense-{name.lower().replace(' ', '-')}",
        file_name="packets.bin",
        seeds=partial(_seeds, name),
        read=PacketRun(ROBOSENSE, name, _size(name), _PACKETS).read,
        # A run of packets has no end mark.
        knows_end=False,
    )
    for name in _NAMES
)
"""Data packets."""
