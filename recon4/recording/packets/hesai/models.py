"""What the user manuals say of each Hesai: packets, beams, firing times.

The manuals are named in `layouts`, `firing_times` and `typical_angles`. The stamp of a packet is
that of its last block (of the first one for the PandarQT and QT128); the start of a block is
``first_us + step_us * k`` with k counted from there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.recording.packets.hesai import firing_times, typical_angles
from recon4.recording.packets.hesai.angles import Angles
from recon4.recording.packets.hesai.layouts import (
    FIRST_JT128,
    FIRST_OT128,
    PANDAR40P_BLOCK,
    HesaiLayout,
    read_layout,
)

RETURN_MODES = {
    0x33: ("first", 1),
    0x34: ("second", 1),
    0x37: ("strongest", 1),
    0x38: ("last", 1),
    0x39: ("dual: last, strongest", 2),
    0x3A: ("dual: first, second", 2),
    0x3B: ("dual: first, last", 2),
    0x3C: ("dual: first, strongest", 2),
    0x3D: ("triple: first, last, strongest", 3),
    0x3E: ("dual: strongest, second strongest", 2),
}
"""Return mode byte -> words, returns of a shot: as many blocks that follow each other."""
RETURNS = np.array([RETURN_MODES.get(mode, ("", 1))[1] for mode in range(256)])
"""Returns of a shot by return mode byte; 1 = unknown."""


@dataclass(frozen=True, eq=False, kw_only=True)
class HesaiModel:
    """One model."""

    name: str
    """As in `recon4.model.lidars.LIDARS`."""
    header: bytes
    """First bytes of its usual data packet: version, channels, blocks, unit, flags."""
    size: int
    """Bytes of its usual data packet."""
    first_us: float
    """Start of the block of the stamp after the stamp [µs]."""
    step_us: float
    """From the start of one block to the next in single return mode [µs]."""
    is_slower: bool = False
    """Whether it fires half as often unless it is in high resolution."""
    stamp_of_first: bool = False
    """Whether the stamp is that of the first block, not of the last."""
    firing_us: Array
    """When each channel fires after the start of its block [µs], one row a sequence, (Q, C)."""
    angles: Angles | None
    """Of a typical unit; None = none is known."""
    speed_rpm: float = 1.0
    """Revolutions a minute in one unit of the speed in the packets."""

    @property
    def layout(self) -> HesaiLayout:
        """Of its usual data packet."""
        packet = np.zeros(self.size, dtype=np.uint8)
        packet[: len(self.header)] = np.frombuffer(self.header, np.uint8)
        layout = read_layout(packet)
        assert layout is not None
        return layout

    @property
    def channels(self) -> int:
        """Number of beams."""
        return self.firing_us.shape[1]

    def round_us(self, *, high_resolution: bool) -> float:
        """From the start of one round of firing to the next [µs]."""
        return self.step_us * (2.0 if self.is_slower and not high_resolution else 1.0)

    def start_us(self, groups: int, *, high_resolution: bool = True) -> Array:
        """When the rounds of firing of a packet begin after its stamp [µs], (groups,)."""
        count = np.arange(groups) - (0 if self.stamp_of_first else groups - 1)
        step_us = self.round_us(high_resolution=high_resolution)
        return np.asarray(self.first_us + step_us * count, dtype=np.float64)


def _header(
    version: tuple[int, int], shape: tuple[int, int], flags: int, *, status: int = 0
) -> bytes:
    """Start of a packet of `shape` (channels, blocks) with distances in units of 4 mm."""
    return bytes((0xEE, 0xFF, *version, status, 0, *shape, 1, 4, 1, flags))


_XT16 = HesaiModel(
    name="XT16",
    header=_header((6, 1), (16, 8), 1),
    size=568,
    first_us=5.632,
    step_us=50.0,
    firing_us=firing_times.XT16[None],
    angles=typical_angles.XT16,
)
_XT32 = replace(
    _XT16,
    name="XT32",
    header=_header((6, 1), (32, 8), 1),
    size=1080,
    firing_us=firing_times.XT32[None],
    angles=typical_angles.XT32,
)
_XT32M2X = replace(
    _XT32,
    name="XT32M2X",
    header=_header((6, 1), (32, 6), 1),
    size=820,
    firing_us=firing_times.XT32M2X[None],
    angles=typical_angles.XT32M2X,
)
_PANDAR40P = HesaiModel(
    name="Pandar40P",
    header=PANDAR40P_BLOCK,
    size=1262,
    first_us=-28.58,
    step_us=55.56,
    firing_us=firing_times.PANDAR_40P[None],
    angles=typical_angles.PANDAR_40P,
)
_PANDAR64 = HesaiModel(
    name="Pandar64",
    header=bytes((0xEE, 0xFF, 64, 6, 0, 4, 0, 0)),
    size=1194,
    first_us=-42.58,
    step_us=55.56,
    firing_us=firing_times.PANDAR_64[None],
    angles=typical_angles.PANDAR_64,
)
_QT64 = HesaiModel(
    name="QT64",
    header=_header((3, 1), (64, 4), 1),
    size=1072,
    first_us=25.71,
    step_us=500.0 / 3.0,
    stamp_of_first=True,
    firing_us=firing_times.QT64[None],
    angles=typical_angles.QT64,
)
_QT128 = HesaiModel(
    name="QT128",
    header=_header((3, 2), (128, 2), 0x1D),
    size=1127,
    first_us=9.0,
    step_us=111.11,
    stamp_of_first=True,
    firing_us=firing_times.QT128_LOOPS,
    angles=typical_angles.QT128,
)
_PANDAR128 = HesaiModel(
    name="Pandar128",
    header=_header((1, 4), (128, 2), 0x07),
    size=861,
    first_us=3.148,
    step_us=27.778,
    is_slower=True,
    firing_us=firing_times.PANDAR_128,
    angles=None,
)
_OT128 = replace(
    _PANDAR128,
    name="OT128",
    header=_header((1, 4), (128, 2), 0x07, status=FIRST_OT128),
    first_us=43.346,
    firing_us=firing_times.OT_128,
    angles=typical_angles.OT128,
)
_JT128 = HesaiModel(
    name="JT128",
    header=_header((1, 4), (128, 2), 0x03, status=FIRST_JT128),
    size=844,
    first_us=-1888.0,
    step_us=111.0,
    firing_us=firing_times.JT128[None],
    angles=typical_angles.JT128,
    speed_rpm=0.1,
)
_JT16 = HesaiModel(
    name="JT16",
    header=_header((1, 8), (0, 0), 0),
    size=80,
    first_us=0.0,
    step_us=500.0 / 3.0,
    firing_us=np.zeros((1, 16)),
    angles=typical_angles.JT16,
)
_AT128 = HesaiModel(
    name="AT128",
    header=_header((4, 3), (128, 2), 1),
    size=1086,
    first_us=-9.249 - 41.666,
    step_us=41.666,
    firing_us=np.zeros((1, 128)),  # the maker withdrew the firing times of single channels
    angles=None,
)

MODELS = {
    model.name: model
    for model in (
        *(_XT16, _XT32, _XT32M2X, _PANDAR40P, _PANDAR64, _QT64, _QT128),
        *(_PANDAR128, _OT128, _AT128, _JT16, _JT128),
    )
}
"""Models whose packets are decoded, by name."""


def model_of(payload: NDArray[np.uint8], layout: HesaiLayout) -> HesaiModel | None:
    """The model that sends such packets; None = none of them.

    Args:
        payload: One of its data packets, (size,).
        layout: Of the packet.
    """
    version = (int(payload[2]), int(payload[3]))
    if version == (1, 4):
        status = int(payload[4])
        name = "Pandar128" if status < FIRST_OT128 else "OT128"
        name = name if status < FIRST_JT128 else "JT128"
        model: HesaiModel | None = MODELS[name]
    else:
        model = _BY_SHAPE.get((layout.tail, layout.channels, layout.blocks))
    return model if model is not None and model.channels == layout.channels else None


_BY_SHAPE = {
    (model.layout.tail, model.layout.channels, model.layout.blocks): model
    for model in MODELS.values()
    if model.name not in {"Pandar128", "OT128", "JT128"}
}
