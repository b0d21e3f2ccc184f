"""What the data sheets say of each Velodyne: beams, firing times, bytes on the wire.

Sources: VLP-16 user manual 63-9243 rev. D (§6, §9, appendix C; also of the Hi-Res), VLP-32C user
manual 63-9325 (§9.3, appendix D), HDL-32E user manual 63-9113 (appendix B and E).
The order of the lasers is the order on the wire; ring 0 is the lowest.
The beams of one model cross in a focal point at the distance f from the axis of rotation while
ranges count from the axis; so a beam of elevation e leaves the axis at the height ``-f tan e``.
The VLP-16's manual lists these heights (f = 41.8 mm); for the VLP-32C (42.4 mm) and the HDL-32E
(28.96 mm) f was derived from velodyne-decoder's output.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.kernels.spinning import Layout
from recon4.locales.coded import CodedText
from recon4.units import STANDARD_GRAVITY_M_S2

RETURN = np.dtype([("distance", "<u2"), ("intensity", "u1")])
BLOCK = np.dtype([("flag", "<u2"), ("azimuth_cdeg", "<u2"), ("returns", RETURN, 32)])
DATA_PACKET = np.dtype(
    [("blocks", BLOCK, 12), ("time_us", "<u4"), ("return_mode", "u1"), ("product", "u1")]
)
"""A data packet as it lies on the wire."""

DATA_SIZE = DATA_PACKET.itemsize
"""Bytes of a data packet: 1206."""
POSITION_SIZE = 512
"""Bytes of a position packet."""
BLOCKS = 12
CHANNELS = 32
"""Returns in a block."""
BLOCK_FLAG = 0xEEFF
"""First two bytes of a block (FF EE on the wire)."""
LOWER_BLOCK_FLAG = 0xDDFF
"""The same in blocks of the lower lasers of an HDL-64E."""

LAYOUT = Layout(
    blocks=BLOCKS,
    channels=CHANNELS,
    first=0,
    block=BLOCK.itemsize,
    azimuth=2,
    channel_first=4,
    channel=RETURN.itemsize,
    intensity=2,
    big_endian=False,
    min_step_cdeg=0,
    max_step_cdeg=1000,
)
"""A data packet for the kernel."""

STRONGEST, LAST, DUAL = 0x37, 0x38, 0x39
RETURN_MODES = {STRONGEST: "strongest", LAST: "last", DUAL: "dual"}
GYRO_UNIT_RAD_S = np.deg2rad(0.09766)
ACCEL_UNIT_M_S2 = 0.001221 * STANDARD_GRAVITY_M_S2
"""Units of the samples of position packets."""


@dataclass(frozen=True, eq=False, kw_only=True)
class VelodyneModel:
    """Beams and firing times of one model."""

    name: str
    """As in `recon4.model.rig.SENSOR_MODELS`."""
    product: int
    """Product byte at the end of a data packet."""
    distance_unit_m: float
    """Meters per unit of distance."""
    elevation_rad: Array
    """Elevation of each laser [rad], (L,)."""
    azimuth_offset_cdeg: NDArray[np.int32]
    """Added to the azimuth of the block, clockwise [0.01°], (L,)."""
    height_m: Array
    """How far above the center each beam leaves the sensor [m], (L,)."""
    laser_time_s: Array
    """When each laser fires after the start of its firing sequence [s], (L,)."""
    sequence_s: float
    """From the start of one firing sequence to the next [s]."""

    @property
    def lasers(self) -> int:
        """Number of beams L."""
        return len(self.elevation_rad)

    @property
    def sequences_per_block(self) -> int:
        """Firing sequences per transmitted azimuth: 2 for 16 beams, else 1."""
        return CHANNELS // self.lasers

    @property
    def block_s(self) -> float:
        """Time covered by one block [s]."""
        return self.sequence_s * self.sequences_per_block

    def packet_s(self, return_mode: int) -> float:
        """Time from one packet to the next [s]."""
        return self.block_s * (BLOCKS // 2 if return_mode == DUAL else BLOCKS)

    @cached_property
    def ring(self) -> NDArray[np.uint8]:
        """Ring of each laser, 0 = lowest elevation, (L,)."""
        return np.argsort(np.argsort(self.elevation_rad)).astype(np.uint8)

    @cached_property
    def channel_time_s(self) -> Array:
        """When each of the 32 returns of a block is fired after the block's start [s], (32,)."""
        starts = self.sequence_s * np.arange(self.sequences_per_block)
        return (starts[:, None] + self.laser_time_s).ravel()

    def firing_time_s(self, return_mode: int = STRONGEST) -> Array:
        """When each return of a packet is fired after the packet's time stamp [s], (12, 32).

        ``block * block_s + sequence * sequence_s + laser_time_s``; in dual return mode two
        blocks that follow each other hold the two returns of the same shots.
        """
        block = np.arange(BLOCKS) // (2 if return_mode == DUAL else 1)
        return block[:, None] * self.block_s + self.channel_time_s


_VLP16 = VelodyneModel(
    name="VLP-16",
    product=0x22,
    distance_unit_m=0.002,
    elevation_rad=np.deg2rad(
        [-15.0, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15],
    ),
    azimuth_offset_cdeg=np.zeros(16, dtype=np.int32),
    height_m=1e-3
    * np.array(
        [11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1, 5.1, -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2]
    ),
    laser_time_s=2.304e-6 * np.arange(16.0),
    sequence_s=55.296e-6,
)

_HIRES_ELEVATION_RAD = np.deg2rad(
    np.column_stack([np.linspace(-30.0, -2.0, 8) / 3, np.linspace(2.0, 30.0, 8) / 3]).ravel()
)

_HIRES = replace(
    _VLP16,
    name="VLP-16 Hi-Res",
    product=0x24,
    elevation_rad=_HIRES_ELEVATION_RAD,
    height_m=-0.0418 * np.tan(_HIRES_ELEVATION_RAD),
)

_VLP32C_ELEVATION_RAD = np.deg2rad(
    np.ravel(
        [
            [-25.0, -1, -1.667, -15.639, -11.31, 0, -0.667, -8.843],
            [-7.254, 0.333, -0.333, -6.148, -5.333, 1.333, 0.667, -4],
            [-4.667, 1.667, 1, -3.667, -3.333, 3.333, 2.333, -2.667],
            [-3, 7, 4.667, -2.333, -2, 15, 10.333, -1.333],
        ]
    )
)

_VLP32C = VelodyneModel(
    name="VLP-32C",
    product=0x28,
    distance_unit_m=0.004,
    elevation_rad=_VLP32C_ELEVATION_RAD,
    azimuth_offset_cdeg=np.array(
        [
            [140, -420, 140, -140, 140, -140, 420, -140],
            [140, -420, 140, -140, 420, -140, 420, -140],
            [140, -420, 140, -420, 420, -140, 140, -140],
            [140, -140, 140, -420, 420, -140, 140, -140],
        ],
        dtype=np.int32,
    ).ravel(),
    height_m=-0.0424 * np.tan(_VLP32C_ELEVATION_RAD),
    laser_time_s=2.304e-6 * (np.arange(32.0) // 2),
    sequence_s=55.296e-6,
)

_HDL32E_ELEVATION_RAD = np.deg2rad(
    np.column_stack([np.linspace(-92.0, -32.0, 16) / 3, np.linspace(-28.0, 32.0, 16) / 3]).ravel()
)

_HDL32E = VelodyneModel(
    name="HDL-32E",
    product=0x21,
    distance_unit_m=0.002,
    elevation_rad=_HDL32E_ELEVATION_RAD,
    azimuth_offset_cdeg=np.zeros(32, dtype=np.int32),
    height_m=-0.02896 * np.tan(_HDL32E_ELEVATION_RAD),
    laser_time_s=1.152e-6 * np.arange(32.0),
    sequence_s=46.08e-6,
)

_PUCK_LITE = replace(_VLP16, name="Puck LITE")
"""The packets of a VLP-16; it is lighter."""

MODELS = {model.name: model for model in (_VLP16, _HIRES, _VLP32C, _HDL32E, _PUCK_LITE)}
"""Models whose blocks hold whole firings, by name."""
PRODUCTS = {model.product: model.name for model in (_VLP16, _HIRES, _VLP32C, _HDL32E)}
"""Product byte to name."""


def product_text(product: int) -> str:
    """``HDL-32E (0x21)`` for 0x21."""
    return f"{PRODUCTS.get(product, 'unknown product')} ({product:#04x})"


def velodyne_model(name: str) -> VelodyneModel:
    """The tables of a model.

    Raises:
        ConfigError: If its packets are not decoded here.
    """
    if name in MODELS:
        return MODELS[name]
    known = ", ".join(MODELS)
    raise ConfigError(CodedText("velodyne-no-decoder", name=name, known=known))


def models_of_interval(seconds: float, return_mode: int) -> tuple[str, ...]:
    """Names of the models whose packets follow each other at this interval; the usual one first.

    The interval is fixed by the firing sequence and does not depend on the rotation rate: 1.327 ms
    for a VLP-16 (also Hi-Res), 0.664 ms for a VLP-32C and 0.553 ms for an HDL-32E, half of it in
    dual mode.
    """
    return tuple(
        model.name
        for model in MODELS.values()
        if abs(seconds / model.packet_s(return_mode) - 1.0) < 0.03
    )


def likely_model(product: int, seconds: float, return_mode: int) -> str | None:
    """The model of packets at this interval; its product byte counts only if it fits, or alone."""
    stated = PRODUCTS.get(product)
    fits = models_of_interval(seconds, return_mode)
    return stated if stated in fits or not fits else fits[0]
