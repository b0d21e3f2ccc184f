"""Bytes of Ouster's packets: profiles, headers, columns.

From the Ouster Sensor Data chapter of the Firmware User Manuals 1.14 to 3.1 (LEGACY, RNG19, RNG15,
FUSA), for what is newer (ZONE16, WIN8, ACCEL32_GYRO32_NMEA) from the tables of ouster-sdk 1.0. A
data packet is a header, columns and a footer. A column holds the shots of all beams at one angle
of the encoder, top beam first; all are fired at its time stamp. LEGACY has neither header nor
footer, but a status behind each column.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

HEADER_BYTES = 32
"""Of a header, and of a footer."""
TYPE_DATA, TYPE_IMU, TYPE_ZONES = 1, 2, 3
"""Packet types in a header."""
ENCODER_TICKS = 90112
"""Counts of the encoder in a revolution."""
MAX_BEAMS, MAX_COLUMNS = 256, 4096
"""The largest sensors have 128 beams and 4096 columns a revolution."""
USUAL_COLUMNS = 16
"""In a packet."""
BEAMS = (32, 64, 128)
"""Of the sensors on sale; an OS1-16 sends 64, of which 48 are silent."""

STANDARD_HEADER = np.dtype(
    [("type", "<u2"), ("frame", "<u2"), ("init_id", "u1", 3), ("serial", "u1", 5), ("rest", "V20")]
)
FUSA_HEADER = np.dtype(
    [
        ("type", "u1"),
        ("init_id", "u1", 3),
        ("frame", "<u4"),
        ("alerts", "u1", 3),
        ("serial", "u1", 5),
        ("rest", "V16"),
    ]
)
"""Header of sensors set to functional safety."""


LEGACY_IMU = np.dtype(
    [
        ("sent_ns", "<u8"),
        ("accel_ns", "<u8"),
        ("gyro_ns", "<u8"),
        ("accel_g", "<f4", 3),
        ("gyro_deg_s", "<f4", 3),
    ]
)
IMU_SAMPLE = np.dtype(
    [
        ("t_ns", "<u8"),
        ("number", "<u2"),
        ("status", "<u2"),
        ("accel_m_s2", "<f4", 3),
        ("gyro_rad_s", "<f4", 3),
    ]
)
NMEA_BYTES = 100
"""Time of the sentence, and the sentence."""
AROUND_SAMPLES_BYTES = 2 * HEADER_BYTES + NMEA_BYTES
"""Around the samples of an inertial packet."""
MAX_SAMPLES = 64
ZONE_BYTES = 680
"""A packet of zone monitoring."""
WORD = np.dtype("<u4").itemsize
"""Bytes of a word: packets, headers, columns and pixels are whole words."""
CHECKSUM_BYTES = 8
"""At the end of a data packet with a header."""


@dataclass(frozen=True, slots=True)
class Echo:
    """Where the bytes of one return lie in a pixel."""

    range_at: int
    range_bits: int
    intensity_at: int
    intensity_bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """What a sensor sends of each shot."""

    name: str
    """As in the metadata (``udp_profile_lidar``)."""
    pixel_bytes: int
    """Of one shot."""
    unit_mm: int
    """Unit of the range."""
    echoes: tuple[Echo, ...]
    """One, or two in dual return mode."""
    has_signal: bool = True
    """Whether the intensity is the signal (photons), not the reflectivity."""
    fusa: bool = False
    """Whether its header is always that of functional safety."""

    @property
    def has_header(self) -> bool:
        """Whether packets have a header and a footer."""
        return self.name != LEGACY


LEGACY = "LEGACY"
_SINGLE = (Echo(0, 19, 6, 2),)
_DUAL = (Echo(0, 19, 8, 2), Echo(4, 19, 10, 2))
_LOW = (Echo(0, 15, 2, 1),)
_LOW_DUAL = (Echo(0, 15, 2, 1), Echo(4, 15, 6, 1))


def _low(name: str, pixel_bytes: int, echoes: tuple[Echo, ...], *, fusa: bool = False) -> Profile:
    return Profile(
        name=name, pixel_bytes=pixel_bytes, unit_mm=8, echoes=echoes, has_signal=False, fusa=fusa
    )


PROFILES = {
    profile.name: profile
    for profile in (
        Profile(name=LEGACY, pixel_bytes=12, unit_mm=1, echoes=(Echo(0, 20, 6, 2),)),
        Profile(name="RNG19_RFL8_SIG16_NIR16", pixel_bytes=12, unit_mm=1, echoes=_SINGLE),
        Profile(name="RNG19_RFL8_SIG16_NIR16_DUAL", pixel_bytes=16, unit_mm=1, echoes=_DUAL),
        Profile(name="RNG19_RFL8_SIG16_NIR16_ZONE16", pixel_bytes=12, unit_mm=1, echoes=_SINGLE),
        Profile(name="FIVE_WORD_PIXEL", pixel_bytes=20, unit_mm=1, echoes=_DUAL),
        _low("RNG15_RFL8_NIR8", 4, _LOW),
        _low("RNG15_RFL8_WIN8", 4, _LOW),
        _low("RNG15_RFL8_NIR8_ZONE16", 8, _LOW),
        _low("RNG15_RFL8_NIR8_DUAL", 8, _LOW_DUAL),
        _low("FUSA_RNG15_RFL8_NIR8_DUAL", 8, _LOW_DUAL, fusa=True),
    )
}
"""By name."""


@dataclass(frozen=True)
class PacketLayout:
    """Bytes of the data packets of a sensor."""

    profile: Profile
    beams: int
    """Shots in a column."""
    columns: int = USUAL_COLUMNS
    """Columns in a packet."""
    fusa: bool = False
    """Whether the header is that of functional safety."""

    @property
    def size(self) -> int:
        """Bytes of a data packet."""
        return int(self.packet.itemsize)

    @property
    def pixels_at(self) -> NDArray[np.int64]:
        """Offset of the first pixel of each column in a packet, (C,)."""
        fields = self.packet.fields
        assert fields is not None
        column = self._column
        assert column.fields is not None
        first = fields["columns"][1] + column.fields["pixels"][1]
        return first + column.itemsize * np.arange(self.columns, dtype=np.int64)

    @cached_property
    def packet(self) -> np.dtype[np.void]:
        """A data packet as it lies on the wire: ``columns``, and ``header`` and ``crc`` if any."""
        columns = ("columns", self._column, (self.columns,))
        if not self.profile.has_header:
            return np.dtype([columns])
        header = FUSA_HEADER if self.fusa or self.profile.fusa else STANDARD_HEADER
        return np.dtype([("header", header), columns, ("footer", "V24"), ("crc", "<u8")])

    @cached_property
    def _column(self) -> np.dtype[np.void]:
        pixels = ("pixels", "u1", (self.beams * self.profile.pixel_bytes,))
        stamp, number = ("stamp_ns", "<u8"), ("number", "<u2")
        if not self.profile.has_header:
            frame, encoder = ("frame", "<u2"), ("encoder", "<u4")
            return np.dtype([stamp, number, frame, encoder, pixels, ("status", "<u4")])
        return np.dtype([stamp, number, ("status", "<u2"), pixels])

    def records(self, payloads: NDArray[np.uint8]) -> NDArray[np.void]:
        """Payloads of this size seen as records, (P,)."""
        return np.ascontiguousarray(payloads).view(self.packet)[:, 0]


USUAL_LAYOUTS = tuple(
    PacketLayout(profile, beams) for profile in PROFILES.values() for beams in BEAMS
)
"""Those of sensors whose metadata is not there."""


def numbers(digits: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Little-endian numbers of K bytes, (N, K) -> (N,)."""
    weights = 1 << 8 * np.arange(digits.shape[1], dtype=np.int64)
    return digits.astype(np.int64) @ weights
