"""Metadata of an Ouster sensor: the json that its driver stores beside the packets.

Firmware 1.12 to 2.1 and older drivers write it flat, newer ones nested in sections; in bags it is
the text of a message. Packets hold ranges and column numbers only: the angles of the beams are of
the very sensor and stand nowhere else.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.lidars import LIDARS
from recon4.recording.formats.datagrams import MAX_UDP_BYTES
from recon4.recording.limits import LIMITS
from recon4.recording.packets.family import Companion
from recon4.recording.packets.ouster.facts import (
    BEAM_ORIGIN_MM,
    LIDAR_HEIGHT_MM,
    OLDEST_BEAM_ORIGIN_MM,
    OS2_HEIGHT_MM,
)
from recon4.recording.packets.ouster.layouts import (
    LEGACY,
    MAX_BEAMS,
    MAX_COLUMNS,
    PROFILES,
    USUAL_COLUMNS,
    PacketLayout,
)
from recon4.untrusted.bounded import parse_json

_ANGLES = "beam_altitude_angles"
_SECTIONS = (
    "sensor_info", "beam_intrinsics", "lidar_intrinsics", "imu_intrinsics", "lidar_data_format",
    "imu_data_format", "data_format", "config_params",
)  # fmt: skip
_MODE = re.compile(r"(\d{3,4})x(\d{1,2})")
_PRODUCT = re.compile(r"OS-?(0|1|2|DOME)-(\d+)", re.IGNORECASE)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OusterMetadata:
    """What a metadata file says of a sensor."""

    name: str
    """Display name of the file or topic."""
    likeness: int
    """At how many characters its name begins like that of the recording."""
    product: str
    """As ``OS-1-128``; empty = not stated."""
    serial: str
    """Empty = not stated."""
    init_id: int
    """Changes each time the sensor starts; 0 = not stated."""
    layout: PacketLayout
    """Of its data packets."""
    columns_per_turn: int
    """Columns in a revolution."""
    rotation_hz: float
    """Revolutions a second; NaN = not stated."""
    elevation_rad: Array
    """Of each beam, top beam first [rad], (B,)."""
    azimuth_rad: Array
    """Of each beam, from the angle of the encoder, clockwise [rad], (B,)."""
    p_lidar_beam_m: Array
    """Where the beams leave, in the frame that turns with them: x and z [m], (2,)."""
    T_sensor_lidar: Array
    """From the turning axis to the housing, translation in [m], (4, 4)."""
    R_sensor_imu: Array
    """(3, 3)."""
    port: int
    """UDP port of the data packets; 0 = not stated."""
    imu_port: int
    """Of the inertial packets; 0 = not stated."""
    assumed: tuple[str, ...]
    """Names of values that it does not tell and that are taken as usual."""

    @property
    def model(self) -> str:
        """Name in `recon4.model.lidars.LIDARS`; empty = not known."""
        found = _PRODUCT.match(self.product)
        if found:
            kind = "Dome" if found[1].upper() == "DOME" else found[1]
            name = f"OS{kind}-{int(found[2])}"
        else:
            name = _likely_model(np.rad2deg(self.elevation_rad)) if not self.product else ""
        return name if name in LIDARS else ""

    def same_geometry(self, other: OusterMetadata) -> bool:
        """Whether another file gives the same points."""
        names = ("elevation_rad", "azimuth_rad", "p_lidar_beam_m", "T_sensor_lidar")
        return (
            self.layout == other.layout
            and self.columns_per_turn == other.columns_per_turn
            and all(np.array_equal(getattr(self, name), getattr(other, name)) for name in names)
        )


def _likely_model(elevation_deg: Array) -> str:
    """The model with such a field of view."""
    span_deg = float(np.ptp(elevation_deg))
    if elevation_deg.min() > -10.0 and elevation_deg.max() > 60.0:
        kind = "Dome"
    else:
        kind = "0" if span_deg > 60.0 else "1" if span_deg > 27.0 else "2"
    return f"OS{kind}-{len(elevation_deg)}"


def is_metadata(companion: Companion) -> bool:
    """Whether a file names the angles of beams as the metadata of an Ouster does."""
    return len(companion.content) <= LIMITS.metadata_bytes and _ANGLES.encode() in companion.content


def read_metadata(companion: Companion) -> OusterMetadata | None:
    """The metadata in a file; None if it is something else.

    Raises:
        CorruptFile: If it has angles of beams and is damaged or contradicts itself.
    """
    content, name = companion.content, companion.name
    if not is_metadata(companion):
        return None
    found = parse_json(content.strip(b"\0 \r\n\t"), name, finite=True)
    if not isinstance(found, dict):
        raise CorruptFile(CodedText("ouster-object", name=name, kind=type(found).__name__))
    try:
        return _metadata(_Values(name, _flat(found)), companion.likeness)
    except (TypeError, OverflowError) as error:
        raise CorruptFile(CodedText("ouster-value-kind", name=name, why=str(error))) from error


def _flat(document: Mapping[str, object]) -> dict[str, object]:
    """The values of all sections, and those that are in none."""
    sections = [document.get(name) for name in _SECTIONS]
    values = dict(document)
    for section in sections:
        if isinstance(section, dict):
            values |= section
    return values


@dataclass(frozen=True, slots=True)
class _Values:
    """Values of a metadata file by name; each is checked when it is asked for."""

    name: str
    values: Mapping[str, object]

    def text(self, key: str) -> str:
        found = self.values.get(key, "")
        return found if isinstance(found, str) else str(found) if isinstance(found, int) else ""

    def integer(self, key: str, usual: int, limits: tuple[int, int]) -> int:
        found = self.values.get(key, usual)
        if isinstance(found, float) and found.is_integer():
            found = int(found)
        if not isinstance(found, int) or not limits[0] <= found <= limits[1]:
            raise CorruptFile(
                CodedText(
                    "ouster-integer",
                    name=self.name,
                    key=key,
                    least=limits[0],
                    most=limits[1],
                    got=str(found)[:40],
                )
            )
        return found

    def numbers(self, key: str, count: int, limit: float) -> Array | None:
        """A list of numbers between -limit and limit, (count,); None = there is none."""
        found = self.values.get(key)
        if found is None:
            return None
        if not isinstance(found, list) or len(found) != count or not _all_within(found, limit):
            raise CorruptFile(
                CodedText("ouster-numbers", name=self.name, key=key, count=count, limit=limit)
            )
        return np.array(found, dtype=np.float64)

    def number(self, key: str, limit: float) -> float | None:
        """A number between -limit and limit; None = there is none."""
        found = self.values.get(key)
        if found is not None and not (isinstance(found, int | float) and abs(found) <= limit):
            raise CorruptFile(CodedText("ouster-number", name=self.name, key=key, limit=limit))
        return None if found is None else float(found)

    def count(self, key: str) -> int:
        found = self.values.get(key)
        return len(found) if isinstance(found, list) else 0

    def transform(self, key: str) -> Array | None:
        """A rigid transform, translation in [m], (4, 4); None = there is none."""
        found = self.numbers(key, 16, 10_000.0)
        if found is None:
            return None
        T_a_b = found.reshape(4, 4)
        R_a_b = T_a_b[:3, :3]
        if np.abs(R_a_b @ R_a_b.T - np.eye(3)).max() > 1e-3 or np.linalg.det(R_a_b) < 0:
            raise CorruptFile(CodedText("ouster-rotation", name=self.name, key=key))
        T_a_b[:3, 3] *= 1e-3
        return T_a_b


def _all_within(found: list[object], limit: float) -> bool:
    return all(isinstance(value, int | float) and abs(value) <= limit for value in found)


def _metadata(values: _Values, likeness: int) -> OusterMetadata:
    beams = values.count(_ANGLES)
    if not 1 <= beams <= MAX_BEAMS:
        raise CorruptFile(
            CodedText(
                "ouster-angles-count",
                values=values.name,
                angles=_ANGLES,
                max_beams=MAX_BEAMS,
                beams=beams,
            )
        )
    elevation, azimuth = (
        values.numbers(key, beams, 180.0) for key in (_ANGLES, "beam_azimuth_angles")
    )
    if elevation is None or azimuth is None:
        raise CorruptFile(CodedText("ouster-azimuths", values=values.name, beams=beams))
    columns, rotation_hz = _mode(values)
    product = values.text("prod_line")
    p_lidar_beam_m, stated_origin = _beam_origin(values, product)
    T_sensor_lidar = values.transform("lidar_to_sensor_transform")
    T_sensor_imu = values.transform("imu_to_sensor_transform")
    serial = values.text("prod_sn")
    unstated = {
        "lidar_origin_to_beam_origin_mm": stated_origin,
        "lidar_to_sensor_transform": T_sensor_lidar is not None,
    }
    return OusterMetadata(
        name=values.name,
        likeness=likeness,
        product=product[:40],
        serial=serial.lstrip("0") if serial.isdigit() else "",
        init_id=values.integer("initialization_id", 0, (0, (1 << 24) - 1)),
        layout=_layout(values, beams),
        columns_per_turn=columns,
        rotation_hz=rotation_hz,
        elevation_rad=np.deg2rad(elevation),
        azimuth_rad=np.deg2rad(azimuth),
        p_lidar_beam_m=p_lidar_beam_m,
        T_sensor_lidar=usual_mount(product) if T_sensor_lidar is None else T_sensor_lidar,
        R_sensor_imu=np.eye(3) if T_sensor_imu is None else T_sensor_imu[:3, :3],
        port=values.integer("udp_port_lidar", 0, (0, 65535)),
        imu_port=values.integer("udp_port_imu", 0, (0, 65535)),
        assumed=tuple(name for name, stated in unstated.items() if not stated),
    )


def _layout(values: _Values, beams: int) -> PacketLayout:
    name = values.text("udp_profile_lidar") or LEGACY
    if name not in PROFILES:
        raise CorruptFile(
            CodedText(
                "ouster-profile", values=values.name, name=name[:40], profiles=", ".join(PROFILES)
            )
        )
    stated = values.integer("pixels_per_column", beams, (1, MAX_BEAMS))
    if stated != beams:
        raise CorruptFile(
            CodedText("ouster-beams-differ", values=values.name, beams=beams, stated=stated)
        )
    columns = values.integer("columns_per_packet", USUAL_COLUMNS, (1, MAX_COLUMNS))
    fusa = values.text("header_type") == "FUSA" or PROFILES[name].fusa
    layout = PacketLayout(PROFILES[name], beams, columns, fusa=fusa)
    if layout.size > MAX_UDP_BYTES:
        raise CorruptFile(
            CodedText("ouster-packet-size", values=values.name, columns=columns, beams=beams)
        )
    return layout


def _mode(values: _Values) -> tuple[int, float]:
    """Columns in a revolution and revolutions a second [Hz]."""
    mode = _MODE.fullmatch(values.text("lidar_mode"))
    columns, hz = (int(mode[1]), float(mode[2])) if mode else (0, float("nan"))
    columns = values.integer("columns_per_frame", columns, (1, MAX_COLUMNS))
    return columns, hz if hz > 0 else float("nan")


def _beam_origin(values: _Values, product: str) -> tuple[Array, bool]:
    """Where the beams leave [m], (2,), and whether it is stated."""
    transform = values.transform("beam_to_lidar_transform")
    if transform is not None:
        return transform[[0, 2], 3], True
    stated = values.number("lidar_origin_to_beam_origin_mm", 1000.0)
    if stated is None:
        return usual_beam_origin_m(product), False
    return np.array([1e-3 * stated, 0.0]), True


def usual_beam_origin_m(product: str) -> Array:
    """Where the beams of a product line leave: x and z in the turning frame [m], (2,)."""
    usual = (mm for start, mm in BEAM_ORIGIN_MM.items() if product.startswith(start))
    return np.array([1e-3 * next(usual, OLDEST_BEAM_ORIGIN_MM), 0.0])


def usual_mount(product: str) -> Array:
    """``T_sensor_lidar`` of a product line [m], (4, 4)."""
    T_sensor_lidar = np.diag([-1.0, -1.0, 1.0, 1.0])
    height_mm = OS2_HEIGHT_MM if product.startswith("OS-2-") else LIDAR_HEIGHT_MM
    T_sensor_lidar[2, 3] = 1e-3 * height_mm
    return T_sensor_lidar
