"""Velodynes whose firing takes several blocks of a packet: VLS-128 (Alpha Prime) and HDL-64E.

Sources: VLS-128 manual 63-9483, HDL-64E S2 and S3 manuals 63-HDL64ES2 and 63-9194. The blocks of a
firing have different flags. The sequence of a VLS-128 takes 55.27 µs in real packets, 20 slots
of which 16 fire 8 lasers; the manual has 53.3 µs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.spinning import BlockRoles, Layout
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.spinning import block_roles, variants
from recon4.recording.packets.velodyne.laser_calibration import LaserCalibration
from recon4.recording.packets.velodyne.models import BLOCKS, CHANNELS

_BLOCK = 100
_USED_BLOCKS = 8
"""Of a VLS-128 with two returns: one firing, each return of 32 lasers in a block."""


@dataclass(frozen=True, eq=False, kw_only=True)
class WideModel:
    """Beams and firing times of one model."""

    name: str
    """As in `recon4.model.lidars.LIDARS`."""
    flags: tuple[int, ...]
    """Flags of the blocks of one firing, in the order of the wire."""
    twins_beside: bool
    """Whether two returns of the same lasers lie in blocks side by side, not firing by firing."""
    distance_unit_m: float
    """Meters per unit of distance."""
    elevation_rad: Array
    """Elevation of each laser [rad], (L,)."""
    azimuth_cdeg: Array
    """Added to the azimuth of the block, clockwise [0.01°], (L,)."""
    origin_m: tuple[Array, Array, Array]
    """Where beams begin: along, to the right, above the center [m], (L,) each."""
    range_m: Array
    """Added to distances [m], (L,)."""
    laser_time_s: Array
    """When each laser fires after the first [s], (L,)."""
    sequence_s: float
    """From one firing to the next [s]."""
    early_ns: int = 0
    """The first shot of a packet is this much before its time stamp [ns]."""
    calibration: LaserCalibration | None = None
    """What the points are corrected by besides."""

    @property
    def lasers(self) -> int:
        """Number of beams L."""
        return len(self.elevation_rad)

    @property
    def rows(self) -> int:
        """Blocks of one return of one firing."""
        return len(self.flags)

    @property
    def layout(self) -> Layout:
        """Of packets whose blocks are merged by `merged`: a block a firing and return."""
        return Layout(
            blocks=BLOCKS // self.rows,
            channels=self.lasers,
            first=0,
            block=2 + 3 * self.lasers,
            azimuth=0,
            channel_first=2,
            channel=3,
            intensity=2,
            big_endian=False,
            min_step_cdeg=0,
            max_step_cdeg=1000,
        )

    def packet_s(self, *, dual: bool) -> float:
        """Time from one packet to the next [s]."""
        if dual and self.twins_beside:
            return self.sequence_s
        return self.sequence_s * BLOCKS / (self.rows * (2 if dual else 1))

    def roles(self) -> BlockRoles:
        """Of merged packets: one return, two returns."""
        blocks = BLOCKS // self.rows
        start_s = self.sequence_s * np.arange(blocks)[:, None]
        time_ns = 1e9 * (start_s + self.laser_time_s)
        single = block_roles(blocks, time_ns=time_ns)
        if not self.twins_beside:
            return variants(
                single, block_roles(blocks, time_ns=time_ns[: blocks // 2], twins=(0, 1))
            )
        one = block_roles(2, time_ns=time_ns[:1], twins=(0, 1))
        return variants(single, one._replace(group=np.array([blocks], np.int64)))

    def order_of(self, *, dual: bool) -> NDArray[np.int64]:
        """Blocks on the wire in the order of merged ones: all rows of a firing and return."""
        if dual and self.twins_beside:
            used = np.arange(_USED_BLOCKS).reshape(-1, 2).T.ravel()
            return np.concatenate([used, np.arange(_USED_BLOCKS, BLOCKS)])
        return np.arange(BLOCKS)

    def used_blocks(self, *, dual: bool) -> int:
        """Blocks of a packet that hold something."""
        return _USED_BLOCKS if dual and self.twins_beside else BLOCKS

    def wire_flags(self, *, dual: bool) -> NDArray[np.int64]:
        """The flag of each used block."""
        each = 2 if dual and self.twins_beside else 1
        flags = np.repeat(self.flags, each)
        return np.resize(flags, self.used_blocks(dual=dual)).astype(np.int64)


def merged(payloads: Payloads, model: WideModel, *, dual: bool) -> Payloads:
    """Packets with one block a firing and return: its azimuth, and all lasers."""
    blocks = payloads[:, : BLOCKS * _BLOCK].reshape(len(payloads), BLOCKS, _BLOCK)
    if dual and model.twins_beside:
        blocks = blocks[:, model.order_of(dual=dual)]
    firings, width = BLOCKS // model.rows, 3 * model.rows * CHANNELS
    azimuth = blocks[:, :: model.rows, 2:4]
    returns = blocks[:, :, 4:].reshape(len(payloads), firings, width)
    whole = np.concatenate([azimuth, returns], axis=2)
    return whole.reshape(len(payloads), firings * (2 + width))


_VLS128_MILLIDEG = np.array(
    [
        [-11742, -1990, 3400, -5290, -780, 4610, -4080, 1310],
        [-6500, -1110, 4280, -4410, 100, 6480, -3200, 2190],
        [-3860, 1530, -9244, -1770, 2740, -5950, -560, 4830],
        [-2980, 2410, -6280, -890, 3620, -5070, 320, 7580],
        [-340, 5180, -3640, 1750, -25000, -2430, 2960, -5730],
        [540, 9700, -2760, 2630, -7650, -1550, 3840, -4850],
        [3180, -5510, -120, 5730, -4300, 1090, -16042, -2210],
        [4060, -4630, 760, 15000, -3420, 1970, -6850, -1330],
        [-5620, -230, 5430, -3530, 980, -19582, -2320, 3070],
        [-4740, 650, 11750, -2650, 1860, -7150, -1440, 3950],
        [-2100, 3290, -5400, -10, 4500, -4190, 1200, -13565],
        [-1220, 4170, -4520, 870, 6080, -3310, 2080, -6650],
        [1420, -10346, -1880, 3510, -6060, -670, 4720, -3970],
        [2300, -6390, -1000, 4390, -5180, 210, 6980, -3090],
        [4980, -3750, 1640, -8352, -2540, 2850, -5840, -450],
        [8430, -2870, 2520, -6170, -1660, 3730, -4960, 430],
    ]
)
"""Elevations of the groups that fire together [0.001°]."""
_VLS128_ELEVATION_RAD = np.deg2rad(_VLS128_MILLIDEG.ravel() / 1000)
_VLS128_FOCUS_M = 0.05863
"""The beams cross this far from the axis; derived from velodyne-decoder's output."""
_VLS128_SEQUENCE_S = 55.274e-6
_VLS128_GROUP = np.repeat(np.arange(16.0), 8)
_NONE = np.zeros(128)

VLS128 = WideModel(
    name="VLS-128",
    flags=(0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF),
    twins_beside=True,
    distance_unit_m=0.004,
    elevation_rad=_VLS128_ELEVATION_RAD,
    azimuth_cdeg=np.tile([635.4, 454.8, 273.2, 91.1, -91.1, -273.2, -454.8, -635.4], 16),
    origin_m=(_NONE, _NONE, -_VLS128_FOCUS_M * np.tan(_VLS128_ELEVATION_RAD)),
    range_m=_NONE,
    laser_time_s=_VLS128_SEQUENCE_S / 20 * (_VLS128_GROUP + np.repeat([0.0, 1.0], 64)),
    sequence_s=_VLS128_SEQUENCE_S,
    early_ns=8700,
)
VLS128_PRODUCT = 0xA1
"""Product byte at the end of its packets."""

HDL64_FLAGS = (0xEEFF, 0xDDFF)
_S2_US = np.array([0.0, 1.26, 2.46, 3.66])
_S3_US = np.array([0.0, 1.3, 2.5, 3.7])


def hdl64_model(calibration: LaserCalibration, *, s3: bool) -> WideModel:
    """An HDL-64E: the blocks of upper and lower lasers fire together, in 8 groups of 4.

    Offsets are vertical and horizontal, as in the manual and VeloView. The ROS driver tilts the
    vertical one with the laser, which moves the points of the lowest lasers by 6 cm.

    Args:
        calibration: Of the very sensor.
        s3: Whether it is an S3, which takes 57.6 µs a firing, not 48.
    """
    sequence_us, first_us = (57.6, _S3_US) if s3 else (48.0, _S2_US)
    groups_us = sequence_us / 8 * np.arange(8)[:, None]
    elevation = calibration.elevation_rad
    return WideModel(
        name="HDL-64E",
        flags=HDL64_FLAGS,
        twins_beside=False,
        distance_unit_m=0.002,
        elevation_rad=elevation,
        azimuth_cdeg=-100 * np.rad2deg(calibration.rot_rad),
        origin_m=(np.zeros(len(elevation)), -calibration.aside_m, calibration.up_m),
        range_m=calibration.far_m,
        laser_time_s=np.tile(1e-6 * (groups_us + first_us).ravel(), 2).astype(np.float64),
        sequence_s=1e-6 * sequence_us,
        calibration=calibration,
    )
