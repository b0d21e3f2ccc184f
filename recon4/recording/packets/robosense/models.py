"""What RoboSense's manuals say of each model that spins: bytes, firing times, factory angles.

Sources: user manuals RS-Helios (1.5, appendix of firing times and DIFOP), RS-Bpearl (3.2 and V4),
RS-Ruby Plus (2.0), RS-Airy (1.0); the origins of the beams, the firing times of Bpearl V4, Ruby
Plus and Airy, and all of RS-16 and RS-32 are those of the maker's driver, rs_driver. Numbers are
big-endian. All device packets (DIFOP) have the return mode and, but for an RS-16, the measured
angles at the same places.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.spinning import Layout

SIZE = 1248
"""Bytes of a data packet, and of a device packet."""
DATA_ID = bytes.fromhex("55aa055a")
OLD_DATA_ID = bytes.fromhex("55aa050a5aa550a0")
"""First bytes of the data packets of RS-16, RS-32 and Bpearl."""
DEVICE_ID = bytes.fromhex("a5ff005a11115555")
"""First bytes of a device packet (DIFOP)."""
MODE_AT, ANGLES_AT = 300, 468
"""Offsets in a device packet: return mode; elevations, then azimuths of all lasers."""
INSTALLED_AT, ELEVATIONS_AT = 289, 1165
"""Offsets in a device packet: how an Airy is installed; elevations of an RS-16."""
ANGLE = np.dtype([("sign", "u1"), ("cdeg", ">u2")])
OLD_TYPE_AT = 30
"""Offset of the type in the header of the oldest models."""
OLD_TYPES = {1: "RS-16", 2: "RS-32", 3: "Bpearl"}
"""Type there -> model."""
TYPE_AT = 31
"""Offset of type and variant in the header: (3, 4) = Bpearl V4; the variant of an Airy."""
IMU_PACKET = np.dtype(
    [
        *[("id", "u1", 4), ("stamp", "u1", 10), ("accel", ">i4", 3), ("gyro", ">i4", 3)],
        *[("temperature", ">i4"), ("rate", "u1"), ("accel_range", "u1"), ("gyro_range", "u1")],
        *[("count", ">u4"), ("tail", ">u2")],
    ]
)
"""Ranges: ± 2, 4, 8, 16 g and ± 250, 500, 1000, 2000 °/s, for numbers of 16 bits."""
IMU_SIZE = IMU_PACKET.itemsize
IMU_LARGEST_RANGE = 3
IMU_FULL = 32768.0
"""Number of the largest angular rate and acceleration of a range."""
BPEARL_V4_TYPE = (3, 4)
AIRY_UNKNOWN_VARIANT = 0
DUAL_MODE = 0
"""Return mode in a device packet."""
LATEST_S = 2**32 - 2
"""Largest number of seconds in a stamp; one more says that there is none."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RoboSenseModel:
    """One model that spins."""

    name: str
    """As in `recon4.model.lidars.LIDARS`."""
    data_id: bytes = DATA_ID
    """First bytes of its data packets."""
    layout: Layout
    """Where the numbers lie in a data packet."""
    flag: bytes = b"\xff\xee"
    """First bytes of a block."""
    stamp_at: int = 20
    """Offset of the time stamp."""
    stamp: Literal["us", "ns", "date"] = "us"
    """Seconds of 6 bytes with µs or ns of 4 bytes; or year to second, ms and µs."""
    kind_at: int = -1
    """Offset of a byte that is 0 in packets with points; -1 = there is none."""
    device_angles: Literal["0.01 deg", "0.001 deg", "elevations"] = "0.01 deg"
    """How device packets state angles: in these units; elevations alone, 3 bytes in 0.0001°."""
    unit_m: float
    """Meters per unit of distance."""
    along_m: float
    """The beams leave the head this far from the axis [m]."""
    up_m: float = 0.0
    """And this far above the center [m]."""
    firing_us: float
    """From one firing of all lasers that a block (or two) holds to the next [µs]."""
    time_us: Array
    """Firing time of each channel after it, (T, C): T blocks make a firing."""
    lasers: int
    """Beams; a channel c of row t is of laser (t C + c) modulo this number."""
    factory_cdeg: NDArray[np.int64] | None = None
    """Elevation and azimuth of each laser as one sensor has them [0.01°], (lasers, 2)."""

    @property
    def rows(self) -> int:
        """Blocks with one return of one firing, T."""
        return len(self.time_us)


def _layout(blocks: int, channels: int, *, first: int = 42, mask: int = 0xFFFF) -> Layout:
    return Layout(
        blocks=blocks,
        channels=channels,
        first=first,
        block=4 + 3 * channels,
        azimuth=2,
        channel_first=4,
        channel=3,
        intensity=2,
        big_endian=True,
        distance_mask=mask,
        min_step_cdeg=0,
        max_step_cdeg=300,
    )


def _angles(text: str) -> NDArray[np.int64]:
    """Rows of elevation and azimuth [0.01°]."""
    return np.array([pair.split(",") for pair in text.split()], dtype=np.int64)


_HELIOS_US = np.concatenate(
    [
        [0.0, 1.57, 3.15, 4.72, 6.30, 7.87, 9.45, 11.36, 13.26, 15.17, 17.08, 18.99, 20.56, 22.14],
        [23.71, 25.29, 26.53, 29.01, 27.77, 30.25, 31.49, 32.73, 33.98, 35.22, 36.46, 37.70, 38.94],
        [40.18, 41.42, 42.67, 43.91, 45.15],
    ]
)
_HELIOS_16P_US = np.concatenate(
    [
        [0.0, 3.15, 6.30, 9.45, 13.26, 17.08, 20.56, 23.71, 26.53, 27.77, 31.49, 32.73, 36.46],
        [38.94, 41.42, 43.91],
    ]
)
_HELIOS_16P_SECOND_US = 55.56
"""From the first firing of a block to the second."""


def of_two_returns(model: RoboSenseModel) -> RoboSenseModel:
    """A model with 16 lasers, of two returns: a block holds both returns of one firing, see
    `recon4.recording.packets.robosense.packets.split_blocks`.
    """
    return replace(
        model,
        layout=_layout(2 * model.layout.blocks, model.lasers, first=0),
        firing_us=model.firing_us / 2,
        time_us=model.time_us[:, : model.lasers],
    )


_HELIOS_32 = RoboSenseModel(
    name="Helios 32",
    layout=_layout(12, 32),
    unit_m=0.0025,
    along_m=0.03498,
    firing_us=55.56,
    time_us=_HELIOS_US[None],
    lasers=32,
)
_HELIOS_5515 = replace(
    _HELIOS_32,
    name="Helios 5515",
    factory_cdeg=_angles(
        "1494,-407 1303,363 1092,-402 889,360 696,-399 546,358 398,-398 267,357 133,-397 0,357 "
        "-133,-397 -267,357 -396,-398 -513,358 -653,-399 -791,359 -989,-401 -1597,366 -1290,-404 "
        "-1908,370 -2202,-419 -2797,388 -2516,-426 -3115,397 -3409,-452 -3729,414 -4025,-476 "
        "-4371,438 -4670,-503 -4975,461 -5270,-532 -5460,480"
    ),
)
_HELIOS_16P = replace(
    _HELIOS_32,
    name="Helios 16P",
    firing_us=2 * _HELIOS_16P_SECOND_US,
    time_us=np.concatenate([_HELIOS_16P_US, _HELIOS_16P_SECOND_US + _HELIOS_16P_US])[None],
    lasers=16,
    factory_cdeg=_angles(
        "1494,-405 1303,361 1092,-400 890,358 696,-397 546,356 398,-396 267,355 133,-395 0,355 "
        "-133,-395 -267,355 -396,-396 -523,356 -663,-397 -801,357"
    ),
)

_RS16_SECOND_US = 55.5
_RS16_US = 2.8 * np.arange(16.0)
_RS16 = RoboSenseModel(
    name="RS-16",
    data_id=OLD_DATA_ID,
    layout=_layout(12, 32),
    stamp="date",
    device_angles="elevations",
    unit_m=0.005,
    along_m=0.03825,
    firing_us=2 * _RS16_SECOND_US,
    time_us=np.concatenate([_RS16_US, _RS16_SECOND_US + _RS16_US])[None],
    lasers=16,
    factory_cdeg=_angles(
        "-1500,0 -1300,0 -1100,0 -900,0 -700,0 -500,0 -300,0 -100,0 "
        "1500,0 1300,0 1100,0 900,0 700,0 500,0 300,0 100,0"
    ),
)
_RS32_US = np.concatenate([2.88 * np.arange(15.0), [44.64]])
_RS32 = replace(
    _RS16,
    name="RS-32",
    device_angles="0.001 deg",
    along_m=0.03997,
    firing_us=55.52,
    time_us=np.concatenate([_RS32_US, 1.44 + _RS32_US])[None],
    lasers=32,
    factory_cdeg=None,
)

_BPEARL_US = 2.56 * np.arange(8.0)
_BPEARL = RoboSenseModel(
    name="Bpearl",
    data_id=OLD_DATA_ID,
    layout=_layout(12, 32),
    stamp="date",
    unit_m=0.005,
    along_m=0.01473,
    up_m=0.09427,
    firing_us=55.52,
    time_us=np.concatenate([_BPEARL_US, 25.68 + _BPEARL_US, 1.28 + _BPEARL_US, 26.96 + _BPEARL_US])[
        None
    ],
    lasers=32,
    factory_cdeg=_angles(
        "231,-3 4732,-67 512,-5 5013,-74 793,-9 5295,-81 1074,-12 5577,-90 1355,-15 5859,-100 "
        "1635,-18 6140,-112 1916,-21 6421,-127 2197,-25 6703,-145 2478,-28 6983,-167 2759,-32 "
        "7264,-196 3041,-36 7544,-234 3322,-40 7825,-295 3604,-45 8106,-450 3886,-49 8387,-671 "
        "4168,-55 8669,-1140 4450,-60 8950,-5340"
    ),
)
_BPEARL_V4 = replace(
    _BPEARL,
    name="Bpearl V4",
    stamp="us",
    unit_m=0.0025,
    along_m=0.01619,
    up_m=0.09571,
    firing_us=55.56,
    time_us=1.668 * np.arange(32.0)[None],
)

_RUBY_US = np.concatenate(
    [
        [0.0, 1.217, 2.434, 3.652, 4.869, 6.086, 7.304, 8.521, 9.739, 11.323, 12.907, 14.924],
        [16.941, 18.959, 20.976, 23.127, 25.278, 27.428, 29.579, 31.963, 34.347, 36.498, 38.648],
        [40.666, 42.683, 44.267, 45.851, 47.435, 49.019, 50.603, 52.187, 53.771],
    ]
)
_RUBY_PLUS = RoboSenseModel(
    name="Ruby Plus",
    layout=_layout(3, 128, first=80),
    flag=b"\xfe",
    stamp_at=10,
    stamp="ns",
    unit_m=0.005,
    along_m=0.02892,
    firing_us=55.56,
    time_us=np.repeat(_RUBY_US, 4)[None],
    lasers=128,
)

_AIRY_US = np.array(
    [0.0, 7.616, 16.184, 24.752, 33.32, 42.84, 52.36, 61.88, 71.4, 79.968, 88.536, 97.104]
)
_AIRY = RoboSenseModel(
    name="Airy",
    layout=_layout(8, 48, mask=0x3FFF),
    kind_at=16,
    unit_m=0.005,
    along_m=float(np.hypot(0.0075, 0.00664)),
    up_m=0.04532,
    firing_us=111.08,
    time_us=np.repeat(_AIRY_US, 8).reshape(2, 48),
    lasers=96,
)
_AIRY_UPRIGHT_US = np.array(
    [0.0, 5.712, 12.376, 19.04, 25.704, 33.32, 41.888, 50.456, 59.024, 70.448, 81.872, 93.296]
)
_AIRY_SIDE_US = np.array(
    [0.0, 11.424, 22.848, 34.272, 45.696, 54.264, 62.832, 71.4, 79.016, 85.68, 92.344, 99.008]
)
AIRY_INSTALLED = {
    0: replace(_AIRY, time_us=np.repeat(_AIRY_UPRIGHT_US, 8).reshape(2, 48)),
    1: replace(_AIRY, time_us=np.repeat(_AIRY_SIDE_US, 8).reshape(2, 48)),
}
"""How it is installed, as device packets say (upright; on its side) -> firing times; else those
of the table."""
AIRY_VARIANT = 2
"""Of 96 lines; 1 = 48, 3 = 192 lines, which are packed in another order."""

MODELS = {
    model.name: model
    for model in (
        *(_HELIOS_32, _HELIOS_5515, _HELIOS_16P),
        *(_BPEARL, _BPEARL_V4, _RS16, _RS32, _RUBY_PLUS, _AIRY),
    )
}
"""Models that spin, by name."""
