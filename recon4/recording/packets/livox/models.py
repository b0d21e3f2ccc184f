"""Livox models and the layouts of their packets.

Sources: Livox SDK Communication Protocol V1.3.0 (2020-10-26; Mid-40, Mid-70, Mid-100, Tele-15,
Horizon, Avia: SDK1), Livox LiDAR Communication Protocol Mid-360 v1.4.11 (2024-02-22) and HAP v1.4.8
(2024-02-18; both SDK2), the user manuals of the models, and `livox_def.h` of the SDK (triple
return).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SDK1_VERSION, SDK2_VERSION = 5, 0
"""First byte of a packet: version of the protocol."""

_STAMP = ("stamp", "u1", 8)
SDK1_HEADER = np.dtype(
    [
        *[("version", "u1"), ("slot", "u1"), ("id", "u1"), ("reserved", "u1")],
        *[("status", "<u4"), ("time_type", "u1"), ("data_type", "u1"), _STAMP],
    ]
)
SDK2_HEADER = np.dtype(
    [
        *[("version", "u1"), ("length", "<u2"), ("interval", "<u2"), ("points", "<u2")],
        *[("counter", "<u2"), ("frame", "u1"), ("data_type", "u1"), ("time_type", "u1")],
        *[("reserved", "u1", 12), ("crc", "<u4"), _STAMP],
    ]
)
"""``interval``: time of all points of the packet [0.1 µs]; ``crc``: CRC-32 of all that follows."""
CRC_FROM = SDK2_HEADER.fields["stamp"][1] if SDK2_HEADER.fields else 0
"""First byte that the CRC covers."""

UTC_TIME_TYPE = 3
"""SDK1: the stamp is a date by PPS and UTC; all other types count nanoseconds."""
SDK1_TIME_TYPES, SDK2_TIME_TYPES = 4, 2
"""Largest time type. SDK1: 0 none, 1 PTP, 2 GPS, 3 PPS with UTC, 4 PPS. SDK2: 0 none, 1 PTP or
gPTP, 2 GPS."""
UTC_STAMP = np.dtype(
    [("year", "u1"), ("month", "u1"), ("day", "u1"), ("hour", "u1"), ("us", "<u4")]
)
"""Year after 2000, and microseconds past the hour."""

IMU_SAMPLE = np.dtype([("gyro", "<f4", 3), ("accel", "<f4", 3)])
"""rad/s and g."""
SDK1_IMU_TYPE, SDK2_IMU_TYPE = 6, 0
SDK1_IMU_SIZE = SDK1_HEADER.itemsize + IMU_SAMPLE.itemsize
SDK2_IMU_SIZE = SDK2_HEADER.itemsize + IMU_SAMPLE.itemsize
SDK1_PORT, SDK2_PORT = 56001, 56301
"""Ports to which the devices send points, as if they had been captured."""
LVX1_TYPE_AT = 10
"""Where the data type of a package of LVX 1 is."""


@dataclass(frozen=True, slots=True)
class PointLayout:
    """Points of one data type of one protocol."""

    sdk: int
    """1 or 2."""
    data_type: int
    shots: int
    """Shots of a packet."""
    record: np.dtype[np.void]
    """One shot, with the field ``returns``, and ``theta`` and ``phi`` if it is spherical."""
    unit_m: float = 1e-3
    """Of a coordinate or depth."""

    @property
    def header(self) -> np.dtype[np.void]:
        """In front of the points."""
        return SDK1_HEADER if self.sdk == 1 else SDK2_HEADER

    @property
    def size(self) -> int:
        """Bytes of a packet."""
        return self.header.itemsize + self.shots * self.record.itemsize

    @property
    def is_spherical(self) -> bool:
        """Whether points are depths and angles."""
        return "theta" in (self.record.names or ())

    @property
    def is_tagged(self) -> bool:
        """Whether each return has a tag."""
        return "tag" in (self.record["returns"].base.names or ())

    @property
    def returns(self) -> int:
        """Returns of a shot."""
        return int(self.record["returns"].shape[0])


def _cartesian(returns: int, *, tag: bool = True, number: str = "<i4") -> np.dtype[np.void]:
    fields = [("xyz", number, 3), ("reflectivity", "u1"), *[("tag", "u1")] * tag]
    return np.dtype([("returns", np.dtype(fields), (returns,))])


def _one_depth(*, tag: bool = True) -> np.dtype[np.void]:
    """Depth, angles, reflectivity: the fields of the return enclose the angles."""
    names, formats, offsets = ["depth", "reflectivity", "tag"], ["<u4", "u1", "u1"], [0, 8, 9]
    fields, size = 2 + tag, 9 + tag
    one = np.dtype(
        {
            "names": names[:fields],
            "formats": formats[:fields],
            "offsets": offsets[:fields],
            "itemsize": size,
        }
    )
    return np.dtype(
        {
            "names": ["theta", "phi", "returns"],
            "formats": ["<u2", "<u2", (one, (1,))],
            "offsets": [4, 6, 0],
            "itemsize": size,
        }
    )


def _depths(returns: int) -> np.dtype[np.void]:
    one = np.dtype([("depth", "<u4"), ("reflectivity", "u1"), ("tag", "u1")])
    return np.dtype([("theta", "<u2"), ("phi", "<u2"), ("returns", one, (returns,))])


LAYOUTS = (
    PointLayout(1, 0, 100, _cartesian(1, tag=False)),
    PointLayout(1, 1, 100, _one_depth(tag=False)),
    PointLayout(1, 2, 96, _cartesian(1)),
    PointLayout(1, 3, 96, _one_depth()),
    PointLayout(1, 4, 48, _cartesian(2)),
    PointLayout(1, 5, 48, _depths(2)),
    PointLayout(1, 7, 30, _cartesian(3)),
    PointLayout(1, 8, 30, _depths(3)),
    PointLayout(2, 1, 96, _cartesian(1)),
    PointLayout(2, 2, 96, _cartesian(1, number="<i2"), unit_m=0.01),
    PointLayout(2, 3, 96, _one_depth()),
)
"""All data types with points."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LivoxModel:
    """One model, as far as its packets do not tell."""

    name: str
    sdk: int
    """1 or 2."""
    lines: int
    """Lasers that fire in turn: shot k of a packet is of line k modulo this number."""
    shots_hz: int
    """Shots a second."""
    names_noise: bool = True
    """Whether the manual calls returns with 01 in bits 0-1 or 2-3 of their tag noise of high
    confidence. The tags of a Mid-360 only grade how sure a point is."""

    @property
    def shot_s(self) -> float:
        """Time from one shot to the next [s]."""
        return 1.0 / self.shots_hz


MODELS = {
    model.name: model
    for model in (
        LivoxModel(name="Mid-40", sdk=1, lines=1, shots_hz=100_000),
        LivoxModel(name="Mid-70", sdk=1, lines=1, shots_hz=100_000),
        LivoxModel(name="Avia", sdk=1, lines=6, shots_hz=240_000),
        LivoxModel(name="Horizon", sdk=1, lines=6, shots_hz=240_000),
        LivoxModel(name="Tele-15", sdk=1, lines=6, shots_hz=240_000),
        LivoxModel(
            name="Mid-360",
            sdk=2,
            lines=4,
            shots_hz=200_000,
            names_noise=False,
        ),
        LivoxModel(name="HAP", sdk=2, lines=6, shots_hz=452_000),
    )
}
"""Models whose packets are decoded, by name. A Mid-100 is three Mid-40 that send on their own."""


def header_of(payloads: NDArray[np.uint8], sdk: int) -> NDArray[np.void]:
    """Headers of payloads of one protocol, (N,)."""
    header = SDK1_HEADER if sdk == 1 else SDK2_HEADER
    return np.ascontiguousarray(payloads[:, : header.itemsize]).view(header)[:, 0]


def layout_of(payload: NDArray[np.uint8]) -> PointLayout | None:
    """The layout of a whole payload by its size, version and data type; None = no points."""
    for layout in LAYOUTS:
        if len(payload) == layout.size:
            header = header_of(payload[None], layout.sdk)[0]
            version = SDK1_VERSION if layout.sdk == 1 else SDK2_VERSION
            if header["version"] == version and header["data_type"] == layout.data_type:
                return layout
    return None
