"""Rig: the sensors of a backpack, their mounting, and rig files."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText, text_of
from recon4.model.beams import BeamCorrections, format_beams, parse_beams
from recon4.model.imu_mounts import imu_mount, is_in_holder
from recon4.model.lidars import LIDARS, lidar_model
from recon4.model.limits import RIG_LIMITS
from recon4.model.point_recipes import PointRecipe, parse_fields
from recon4.model.ports import PORTS
from recon4.model.toml_tables import TomlTable, parse_toml
from recon4.untrusted.bounded import read_text_limited

SENSOR_MODELS = tuple(LIDARS)
"""Models that a rig file may name."""
SensorKind = Literal["lidar", "profiler", "laser2d"]
"""``lidar``: many beams that spin. ``profiler``: one beam that measures line scans, on a head that
turns slowly. ``laser2d``: one beam that spins in a plane."""
_KINDS: tuple[SensorKind, ...] = get_args(SensorKind)
DEFAULT_PORTS: dict[SensorKind, int] = {"profiler": PORTS.profiler, "laser2d": PORTS.laser2d}
_MOUNTING_KEYS = {"xyz_m", "rpy_deg", "quat_xyzw", "time_offset_s", "port"}
_SENSOR_KEYS = _MOUNTING_KEYS | {
    "name", "model", "address", "topic", "enabled", "serial", "description", "kind", "head_topic",
    "head_rate_deg_s", "beams", "fields", "clock_rate_ppm",
}  # fmt: skip
_IMU_KEYS = _MOUNTING_KEYS | {"topic", "sensor"}
_GNSS_KEYS = {"lever_arm_m", "time_offset_s", "port", "serial", "topic"}
_SD_KEYS = ("sd_deg", "sd_mm", "sd_ms")
_OF_LIDARS = {
    "beams": "corrections of beams",
    "fields": "columns of points",
    "clock_rate_ppm": "a clock whose rate is corrected",
}
"""Keys of a sensor that only LiDARs have, and what they are."""
_OPTIONAL_SD_KEYS = ("sd_beam_deg", "sd_beam_mm", "sd_antenna_mm", "sd_gnss_ms")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sensor:
    """One LiDAR, profiler or 2-D laser."""

    name: str
    """Unique within the rig, for example ``horizontal``."""
    model: str
    """One of `SENSOR_MODELS`; it selects the packet decoder."""
    T_body_sensor: SE3
    """Mounting: maps points of the sensor into the body. The frame of a profiler does not turn with
    its head: z is the axis of the head, and at angle 0 the lines lie in the x-z plane."""
    kind: SensorKind = "lidar"
    """What it measures."""
    head_topic: str = ""
    """Profiler: topic of the head's angle in a bag; empty = detected."""
    head_rate_rad_s: float = 0.0
    """Profiler: constant turn rate of the head, from the angle 0 of the first line on [rad/s];
    0 = the recording has the angles."""
    time_offset_s: float = 0.0
    """Added to the sensor's time stamps to get rig time [s]."""
    clock_rate_ppm: float = 0.0
    """LiDAR: how slow its clock is, added for each second since its first measurement [µs]."""
    address: str = ""
    """IP address its packets come from; empty = any."""
    port: int = 2368
    """UDP port its data packets go to."""
    topic: str = ""
    """Topic in a bag; empty = detected."""
    enabled: bool = True
    """Off = its points are read and stored but neither registered nor mapped (V §3.4)."""
    serial: str = ""
    """Serial number; empty = not known."""
    description: str = ""
    """Metadata or table of angles of this very sensor, as its maker writes them; empty = in a file
    beside the recording, or not needed."""
    beams: BeamCorrections | None = None
    """Corrections of its single beams; None = those of the data sheet."""
    fields: PointRecipe | None = None
    """What the columns of its points are; None = they have common names."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigCalibration:
    """Where the mounts and clocks of a rig file come from."""

    date: str
    """ISO 8601, as ``2026-11-22``."""
    method: str
    """As ``joint``, or ``drawing``."""
    sd_deg: float
    """Largest standard deviation of a rotation that was estimated [°]."""
    sd_mm: float
    """Of a position [mm]."""
    sd_ms: float
    """Of a clock [ms]."""
    sd_beam_deg: float = 0.0
    """Of the elevation or azimuth of a beam [°]; 0 = beams were not estimated."""
    sd_beam_mm: float = 0.0
    """Of the range of a beam [mm]; 0 = beams were not estimated."""
    sd_antenna_mm: float = 0.0
    """Of the lever arm of the GNSS antenna [mm]; 0 = it was not estimated."""
    sd_gnss_ms: float = 0.0
    """Of the clock of the GNSS receiver [ms]; 0 = it was not estimated."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rig:
    """All sensors with their poses in the body frame (x forward, y left, z up)."""

    name: str
    sensors: tuple[Sensor, ...]
    T_body_imu: SE3
    """Mounting of the IMU."""
    imu_time_offset_s: float
    """Of the IMU itself, added to its time stamps [s]; see `imu_clock_offset_s`."""
    p_body_antenna: Array
    """Lever arm: phase center of the GNSS antenna in the body [m], (3,)."""
    gnss_time_offset_s: float
    """Added to the GNSS time stamps to get rig time [s]."""
    imu_port: int = PORTS.imu
    """UDP port of the IMU's datagrams (``docs/how-to/live.md``); 0 = none."""
    gnss_port: int = PORTS.gnss
    """UDP port of the GNSS receiver's datagrams; 0 = none."""
    gnss_serial: str = ""
    """Serial device of the receiver, for example ``/dev/ttyUSB0:115200``; empty = none."""
    imu_topic: str = ""
    """Topic of the IMU in a bag; empty = chosen by content."""
    imu_sensor: str = ""
    """Name of the LiDAR whose IMU it is; empty = an IMU of its own, or chosen by content."""
    gnss_topic: str = ""
    """Topic of the GNSS receiver in a bag; empty = chosen by content."""
    calibration: RigCalibration | None = None
    """None = not known."""

    @property
    def T_body_sensor(self) -> SE3:
        """Mountings of all sensors, a batch."""
        return SE3.stack(sensor.T_body_sensor for sensor in self.sensors)

    @property
    def imu_clock_offset_s(self) -> float:
        """Added to the stamps of IMU samples as recorded to get rig time [s].

        An IMU in a LiDAR is on the clock of that LiDAR, whose offset counts for it, too.
        """
        holder = next((one for one in self.sensors if one.name == self.imu_sensor), None)
        return self.imu_time_offset_s + (holder.time_offset_s if holder else 0.0)

    def row_of(self, kind: SensorKind) -> int | None:
        """Row of the first enabled sensor of a kind in ``sensors``; None = there is none."""
        rows = (k for k, s in enumerate(self.sensors) if s.kind == kind and s.enabled)
        return next(rows, None)


def rig_presets() -> list[str]:
    """Names of the rigs that ship with recon4."""
    folder = resources.files("recon4") / "rigs"
    return sorted(
        Path(entry.name).stem for entry in folder.iterdir() if entry.name.endswith(".toml")
    )


def load_rig(name_or_path: str | PathLike[str]) -> Rig:
    """Read a rig file, or one of the shipped presets by name.

    Raises:
        ConfigError: If there is no such preset or file, or the file is not a rig.

    >>> [(sensor.name, sensor.model, sensor.port) for sensor in api.load_rig("4recon").sensors]
    [('horizontal', 'VLP-16', 2368), ('vertical', 'VLP-16', 2369)]
    """
    path = Path(name_or_path)
    if not path.suffix:
        if str(name_or_path) not in rig_presets():  # prevents paths outside of the folder
            name, shipped = repr(str(name_or_path)[:200]), ", ".join(rig_presets())
            raise ConfigError(CodedText("rig-no-such", name=name, shipped=shipped))
        preset = resources.files("recon4") / "rigs" / f"{name_or_path}.toml"
        return parse_rig(preset.read_text("utf-8"), where=str(name_or_path))
    try:
        text = read_text_limited(path, RIG_LIMITS.file_bytes, failure=ConfigError)
    except ConfigError as error:
        raise ConfigError(CodedText("rig-unreadable", why=text_of(error))) from error
    return parse_rig(text, where=path.name[:200])


def parse_rig(text: str, *, where: str) -> Rig:
    """Read a rig from TOML text (see ``docs/reference/rig.md``).

    Raises:
        ConfigError: Names the key, the expected and the found value.
    """
    values = parse_toml(text, where, max_characters=RIG_LIMITS.file_bytes)
    table = TomlTable.of(values, where, {"name", "sensor", "imu", "gnss", "calibration"})
    rows = table.get("sensor", [])
    if not isinstance(rows, list) or not 1 <= len(rows) <= RIG_LIMITS.sensors:
        got = f"{(len(rows) if isinstance(rows, list) else rows)!r:.40}"
        most = RIG_LIMITS.sensors
        raise ConfigError(CodedText("rig-sensors", where=where, limit=most, got=got))
    sensors = tuple(
        _sensor(TomlTable.of(row, f"{where}: sensor {k}", _SENSOR_KEYS))
        for k, row in enumerate(rows)
    )
    names = [sensor.name for sensor in sensors]
    if len(set(names)) < len(names):
        raise ConfigError(CodedText("rig-names-same", where=where, got=str(names)))
    imu = TomlTable.of(table.get("imu", {}), f"{where}: imu", _IMU_KEYS)
    gnss = TomlTable.of(table.get("gnss", {}), f"{where}: gnss", _GNSS_KEYS)
    built_in = _imu_sensor(imu, sensors)
    return Rig(
        name=table.text("name", where),
        sensors=sensors,
        T_body_imu=_mounting(imu) if built_in is None else imu_mount(built_in, _mounting(imu)),
        imu_time_offset_s=imu.number("time_offset_s"),
        p_body_antenna=gnss.place_m("lever_arm_m"),
        gnss_time_offset_s=gnss.number("time_offset_s"),
        imu_port=imu.port(PORTS.imu),
        gnss_port=gnss.port(PORTS.gnss),
        gnss_serial=gnss.text("serial"),
        imu_topic=imu.text("topic"),
        imu_sensor=built_in.name if built_in else "",
        gnss_topic=gnss.text("topic"),
        calibration=_calibration(table.get("calibration"), f"{where}: calibration"),
    )


def _imu_sensor(imu: TomlTable, sensors: Sequence[Sensor]) -> Sensor | None:
    """The LiDAR with the IMU; None = an IMU of its own.

    Raises:
        ConfigError: If there is none of this name.
    """
    name = imu.text("sensor")
    if not name:
        return None
    names = [sensor.name for sensor in sensors]
    if name not in names:
        raise ConfigError(
            CodedText("rig-imu-sensor", where=imu.where, names=str(names), got=f"{name[:80]!r}")
        )
    return sensors[names.index(name)]


def _calibration(value: object, where: str) -> RigCalibration | None:
    if value is None:
        return None
    row = TomlTable.of(value, where, {"date", "method", *_SD_KEYS, *_OPTIONAL_SD_KEYS})
    text = row.text("date")
    try:
        date.fromisoformat(text)
    except ValueError:
        raise ConfigError(CodedText("rig-date", where=where, got=f"{text!r:.80}")) from None
    return RigCalibration(
        date=text,
        method=row.text("method"),
        **{key: row.number(key) for key in (*_SD_KEYS, *_OPTIONAL_SD_KEYS)},
    )


def _quoted(text: str) -> str:
    """A basic string of TOML: the escapes of JSON, and the delete character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def format_rig(rig: Rig) -> str:
    """Format a rig as TOML text; the inverse of `parse_rig`."""
    lines = [f"name = {_quoted(rig.name)}", ""]
    for sensor in rig.sensors:
        lines += [
            "[[sensor]]",
            f"name = {_quoted(sensor.name)}",
            f"model = {_quoted(sensor.model)}",
        ]
        lines += _kind_lines(sensor)
        lines += _mounting_lines(sensor.T_body_sensor)
        lines += [f"time_offset_s = {sensor.time_offset_s!r}", f"port = {sensor.port}"]
        rate_ppm = sensor.clock_rate_ppm
        lines += [f"clock_rate_ppm = {rate_ppm!r}"] if rate_ppm else []
        lines += [f"address = {_quoted(sensor.address)}", f"topic = {_quoted(sensor.topic)}"]
        lines += [f"serial = {_quoted(sensor.serial)}"] if sensor.serial else []
        described = sensor.description
        lines += [f"description = {_quoted(described)}"] if described else []
        lines += [sensor.fields.toml()] if sensor.fields else []
        lines += [f"enabled = {str(sensor.enabled).lower()}", ""]
        lines += format_beams(sensor.beams)
    lines += ["[imu]"]
    lines += [f"sensor = {_quoted(rig.imu_sensor)}"] if rig.imu_sensor else []
    lines += [] if is_in_holder(rig) else _mounting_lines(rig.T_body_imu)
    lines += [f"time_offset_s = {rig.imu_time_offset_s!r}", f"port = {rig.imu_port}"]
    lines += [f"topic = {_quoted(rig.imu_topic)}"] if rig.imu_topic else []
    lines += ["", "[gnss]"]
    lines += [f"lever_arm_m = {_floats(rig.p_body_antenna)}"]
    lines += [f"time_offset_s = {rig.gnss_time_offset_s!r}", f"port = {rig.gnss_port}"]
    lines += [f"serial = {_quoted(rig.gnss_serial)}"] if rig.gnss_serial else []
    lines += [f"topic = {_quoted(rig.gnss_topic)}"] if rig.gnss_topic else []
    lines += [""]
    if rig.calibration:
        c = rig.calibration
        lines += ["[calibration]", f"date = {_quoted(c.date)}", f"method = {_quoted(c.method)}"]
        lines += [f"{key} = {getattr(c, key)!r}" for key in _SD_KEYS]
        lines += [f"{key} = {getattr(c, key)!r}" for key in _OPTIONAL_SD_KEYS if getattr(c, key)]
        lines += [""]
    return "\n".join(lines)


def _floats(values: Array) -> str:
    return "[" + ", ".join(repr(float(v)) for v in values) + "]"


def _mounting_lines(T_body_x: SE3) -> list[str]:
    return [f"xyz_m = {_floats(T_body_x.t)}", f"quat_xyzw = {_floats(T_body_x.quat_xyzw())}"]


def _kind_lines(sensor: Sensor) -> list[str]:
    """What only profilers and 2-D lasers have; the text of other rigs is as before."""
    if sensor.kind == "lidar":
        return []
    lines = [f"kind = {_quoted(sensor.kind)}"]
    lines += [f"head_topic = {_quoted(sensor.head_topic)}"] if sensor.head_topic else []
    rate_deg_s = float(np.rad2deg(sensor.head_rate_rad_s))
    return lines + ([f"head_rate_deg_s = {rate_deg_s!r}"] if rate_deg_s else [])


def _sensor(row: TomlTable) -> Sensor:
    kind = _kind(row)
    model = row.text("model", "VLP-16" if kind == "lidar" else "generic")
    models = SENSOR_MODELS if kind == "lidar" else ("generic",)
    if model not in models:
        values = {"models": str(models), "kind": kind, "got": repr(model[:80])}
        raise ConfigError(CodedText("rig-model", where=row.where, **values))
    if kind != "profiler" and ("head_topic" in row or "head_rate_deg_s" in row):
        raise ConfigError(CodedText("rig-head", where=row.where, kind=kind))
    for key, what in _OF_LIDARS.items():
        if kind != "lidar" and key in row:
            raise ConfigError(CodedText("rig-lidar-only", where=row.where, what=what, kind=kind))
    name = row.text("name")
    if not name:
        raise ConfigError(CodedText("rig-name", where=row.where, got=f"{row.get('name')!r:.80}"))
    return Sensor(
        name=name,
        model=model,
        T_body_sensor=_mounting(row),
        kind=kind,
        head_topic=row.text("head_topic"),
        head_rate_rad_s=float(np.deg2rad(_limited(row, "head_rate_deg_s", RIG_LIMITS.head_deg_s))),
        time_offset_s=row.number("time_offset_s"),
        clock_rate_ppm=_limited(row, "clock_rate_ppm", RIG_LIMITS.clock_ppm),
        address=row.text("address"),
        port=row.port(lidar_model(model).port if kind == "lidar" else DEFAULT_PORTS[kind]),
        topic=row.text("topic"),
        enabled=row.flag("enabled", default=True),
        serial=row.text("serial"),
        description=row.text("description", most=RIG_LIMITS.file_bytes),
        beams=parse_beams(row.get("beams"), f"{row.where}: beams", model=model),
        fields=parse_fields(row.get("fields"), f"{row.where}: fields"),
    )


def _kind(row: TomlTable) -> SensorKind:
    found = row.get("kind", "lidar")
    for kind in _KINDS:
        if found == kind:
            return kind
    raise ConfigError(
        CodedText("rig-kind", where=row.where, kinds=str(_KINDS), got=f"{found!r:.80}")
    )


def _limited(row: TomlTable, key: str, most: float) -> float:
    number = row.number(key)
    if abs(number) > most:
        raise ConfigError(
            CodedText("rig-within", where=row.where, key=key, limit=f"{most:g}", got=f"{number:g}")
        )
    return number


def _mounting(row: TomlTable) -> SE3:
    xyz_m = row.place_m("xyz_m")
    if "quat_xyzw" in row:
        quat = row.vector("quat_xyzw", 4)
        if not 0.99 < np.linalg.norm(quat) < 1.01:
            raise ConfigError(CodedText("rig-quaternion", where=row.where, got=str(quat.tolist())))
        return SE3.from_quat(quat, xyz_m)
    roll, pitch, yaw = row.angles_rad("rpy_deg")
    return SE3.from_rpy(roll, pitch, yaw, t=xyz_m)
