"""Rig: the sensors of a backpack, their mounting, and rig files."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import dataclass
from datetime import date
from importlib import resources
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

from recon4.bounded import read_text_limited
from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, Array

IMU_PORT, GNSS_PORT = 8309, 8310
"""Default UDP ports, next to Velodyne's 2368 (data) and 8308 (positions)."""
MAX_RIG_BYTES = 128 * 1024
"""A rig file has some hundred bytes per sensor."""
MAX_SENSORS = 64
_MAX_TEXT = 1000
_MAX_DOTS = 100
_BETWEEN_KEYS = re.compile(r"[=\[\]{},\n]")
_LARGEST = 4e9
"""Clocks differ by seconds since 1970 at most; nanoseconds must fit into 64 bits."""
SENSOR_MODELS = ("VLP-16", "VLP-16 Hi-Res", "VLP-32C", "HDL-32E", "HDL-64E", "generic")
SensorKind = Literal["lidar", "profiler", "laser2d"]
"""``lidar``: many beams that spin. ``profiler``: one beam that measures line scans, on a head that
turns slowly. ``laser2d``: one beam that spins in a plane."""
_KINDS: tuple[str, ...] = get_args(SensorKind)
_MAX_HEAD_DEG_S = 3600.0


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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rig:
    """All sensors with their poses in the body frame (x forward, y left, z up)."""

    name: str
    sensors: tuple[Sensor, ...]
    T_body_imu: SE3
    """Mounting of the IMU."""
    imu_time_offset_s: float
    """Added to the IMU's time stamps to get rig time [s]."""
    p_body_antenna: Array
    """Lever arm: phase center of the GNSS antenna in the body [m], (3,)."""
    gnss_time_offset_s: float
    """Added to the GNSS time stamps to get rig time [s]."""
    imu_port: int = IMU_PORT
    """UDP port of the IMU's datagrams (``docs/live.md``); 0 = none."""
    gnss_port: int = GNSS_PORT
    """UDP port of the GNSS receiver's datagrams; 0 = none."""
    gnss_serial: str = ""
    """Serial device of the receiver, for example ``/dev/ttyUSB0:115200``; empty = none."""
    calibration: RigCalibration | None = None
    """None = not known."""

    @property
    def T_body_sensor(self) -> SE3:
        """Mountings of all sensors, a batch."""
        return SE3.stack(sensor.T_body_sensor for sensor in self.sensors)

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


def load_rig(name_or_path: str | Path) -> Rig:
    """Read a rig file, or one of the shipped presets by name.

    Raises:
        ConfigError: If there is no such preset or file, or the file is not a rig.
    """
    path = Path(name_or_path)
    if not path.suffix:
        if str(name_or_path) not in rig_presets():  # prevents paths outside of the folder
            raise ConfigError(
                f"no rig named {str(name_or_path)[:200]!r}; shipped: {', '.join(rig_presets())}; "
                "or give the path of a .toml file"
            )
        preset = resources.files("recon4") / "rigs" / f"{name_or_path}.toml"
        return parse_rig(preset.read_text("utf-8"), where=str(name_or_path))
    try:
        text = read_text_limited(path, MAX_RIG_BYTES, failure=ConfigError)
    except ConfigError as error:
        raise ConfigError(f"cannot read rig file {error}") from error
    return parse_rig(text, where=path.name[:200])


def parse_rig(text: str, *, where: str) -> Rig:
    """Read a rig from TOML text (see ``docs/rig.md``).

    Raises:
        ConfigError: Names the key, the expected and the found value.
    """
    table = _toml(text, where)
    _refuse_unknown(table, {"name", "sensor", "imu", "gnss", "calibration"}, where)
    rows = table.get("sensor", [])
    if not isinstance(rows, list) or not 1 <= len(rows) <= MAX_SENSORS:
        raise ConfigError(
            f"{where}: a rig needs at least one [[sensor]] and at most {MAX_SENSORS}, "
            f"got {len(rows) if isinstance(rows, list) else rows!r:.40}"
        )
    sensors = tuple(_sensor(row, f"{where}: sensor {k}") for k, row in enumerate(rows))
    names = [sensor.name for sensor in sensors]
    if len(set(names)) < len(names):
        raise ConfigError(f"{where}: sensor names must differ, got {names}")
    imu, gnss = table.get("imu", {}), table.get("gnss", {})
    _refuse_unknown(
        imu, {"xyz_m", "rpy_deg", "quat_xyzw", "time_offset_s", "port"}, f"{where}: imu"
    )
    _refuse_unknown(gnss, {"lever_arm_m", "time_offset_s", "port", "serial"}, f"{where}: gnss")
    return Rig(
        name=_text(table, "name", where, where=where),
        sensors=sensors,
        T_body_imu=_mounting(imu, f"{where}: imu"),
        imu_time_offset_s=_number(imu, "time_offset_s", 0.0, where=f"{where}: imu"),
        p_body_antenna=_vector(
            gnss, "lever_arm_m", 3, default=(0.0, 0.0, 0.0), where=f"{where}: gnss"
        ),
        gnss_time_offset_s=_number(gnss, "time_offset_s", 0.0, where=f"{where}: gnss"),
        imu_port=_port(imu, IMU_PORT, f"{where}: imu"),
        gnss_port=_port(gnss, GNSS_PORT, f"{where}: gnss"),
        gnss_serial=_text(gnss, "serial", "", where=f"{where}: gnss"),
        calibration=_calibration(table.get("calibration"), f"{where}: calibration"),
    )


def _calibration(row: Any, where: str) -> RigCalibration | None:
    if row is None:
        return None
    _refuse_unknown(row, {"date", "method", "sd_deg", "sd_mm", "sd_ms"}, where)
    text = _text(row, "date", "", where=where)
    try:
        date.fromisoformat(text)
    except ValueError:
        raise ConfigError(f"{where}: date must be as 2026-11-22, got {text!r:.80}") from None
    return RigCalibration(
        date=text,
        method=_text(row, "method", "", where=where),
        sd_deg=_number(row, "sd_deg", 0.0, where=where),
        sd_mm=_number(row, "sd_mm", 0.0, where=where),
        sd_ms=_number(row, "sd_ms", 0.0, where=where),
    )


def _toml(text: str, where: str) -> dict[str, Any]:
    """Parse TOML with bounded size, nesting and length of keys.

    tomllib needs quadratic time for dotted keys, and recursion for nested arrays.
    """
    if len(text) > MAX_RIG_BYTES:
        raise ConfigError(f"{where}: expected at most {MAX_RIG_BYTES} characters, got {len(text)}")
    longest = max((part.count(".") for part in _BETWEEN_KEYS.split(text)), default=0)
    if longest > _MAX_DOTS:
        raise ConfigError(f"{where}: expected keys of few parts, got one with {longest} dots")
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, ValueError) as error:
        raise ConfigError(f"{where}: not a TOML file: {str(error)[:300]}") from error
    except RecursionError as error:
        raise ConfigError(f"{where}: not a TOML file: nested too deeply") from error


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
        lines += [f"address = {_quoted(sensor.address)}", f"topic = {_quoted(sensor.topic)}"]
        lines += [f"serial = {_quoted(sensor.serial)}"] if sensor.serial else []
        lines += [f"enabled = {str(sensor.enabled).lower()}", ""]
    lines += ["[imu]", *_mounting_lines(rig.T_body_imu)]
    lines += [f"time_offset_s = {rig.imu_time_offset_s!r}", f"port = {rig.imu_port}"]
    lines += ["", "[gnss]"]
    lines += [f"lever_arm_m = {_floats(rig.p_body_antenna)}"]
    lines += [f"time_offset_s = {rig.gnss_time_offset_s!r}", f"port = {rig.gnss_port}"]
    lines += [f"serial = {_quoted(rig.gnss_serial)}"] if rig.gnss_serial else []
    lines += [""]
    if rig.calibration:
        c = rig.calibration
        lines += ["[calibration]", f"date = {_quoted(c.date)}", f"method = {_quoted(c.method)}"]
        lines += [f"sd_deg = {c.sd_deg!r}", f"sd_mm = {c.sd_mm!r}", f"sd_ms = {c.sd_ms!r}", ""]
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


def _sensor(row: dict[str, Any], where: str) -> Sensor:
    known = {"name", "model", "xyz_m", "rpy_deg", "quat_xyzw", "time_offset_s"}
    known |= {
        "address",
        "port",
        "topic",
        "enabled",
        "serial",
        "kind",
        "head_topic",
        "head_rate_deg_s",
    }
    _refuse_unknown(row, known, where)
    kind = _kind(row, where)
    model = _text(row, "model", "VLP-16" if kind == "lidar" else "generic", where=where)
    models = SENSOR_MODELS if kind == "lidar" else ("generic",)
    if model not in models:
        raise ConfigError(
            f"{where}: model must be one of {models} for a {kind}, got {model[:80]!r}"
        )
    if kind != "profiler" and {"head_topic", "head_rate_deg_s"} & set(row):
        raise ConfigError(f"{where}: only a profiler has a head, this is a {kind}")
    if not _text(row, "name", "", where=where):
        raise ConfigError(f"{where}: name must be a text, got {row.get('name')!r:.80}")
    return Sensor(
        name=row["name"],
        model=model,
        T_body_sensor=_mounting(row, where),
        kind=kind,
        head_topic=_text(row, "head_topic", "", where=where),
        head_rate_rad_s=_head_rate(row, where),
        time_offset_s=_number(row, "time_offset_s", 0.0, where=where),
        address=_text(row, "address", "", where=where),
        port=_port(row, 2368, where),
        topic=_text(row, "topic", "", where=where),
        enabled=_flag(row, "enabled", where),
        serial=_text(row, "serial", "", where=where),
    )


def _kind(row: dict[str, Any], where: str) -> SensorKind:
    found = row.get("kind", "lidar")
    if found not in _KINDS:
        raise ConfigError(f"{where}: kind must be one of {_KINDS}, got {found!r:.80}")
    kind: SensorKind = found
    return kind


def _head_rate(row: dict[str, Any], where: str) -> float:
    rate_deg_s = _number(row, "head_rate_deg_s", 0.0, where=where)
    if abs(rate_deg_s) > _MAX_HEAD_DEG_S:
        raise ConfigError(
            f"{where}: head_rate_deg_s must be within ±{_MAX_HEAD_DEG_S:g}, got {rate_deg_s:g}"
        )
    return float(np.deg2rad(rate_deg_s))


def _mounting(row: dict[str, Any], where: str) -> SE3:
    xyz_m = _vector(row, "xyz_m", 3, default=(0.0, 0.0, 0.0), where=where)
    if "quat_xyzw" in row:
        quat = _vector(row, "quat_xyzw", 4, default=(), where=where)
        if not 0.99 < np.linalg.norm(quat) < 1.01:
            raise ConfigError(f"{where}: quat_xyzw must have length 1, got {quat.tolist()}")
        return SE3.from_quat(quat, xyz_m)
    roll, pitch, yaw = np.deg2rad(_vector(row, "rpy_deg", 3, default=(0.0, 0.0, 0.0), where=where))
    return SE3.from_rpy(roll, pitch, yaw, t=xyz_m)


def _vector(
    row: dict[str, Any], key: str, size: int, *, default: tuple[float, ...], where: str
) -> Array:
    value = row.get(key, default)
    if not isinstance(value, list | tuple) or len(value) != size or not all(map(_usable, value)):
        raise ConfigError(
            f"{where}: {key} must be {size} finite numbers, got {value!r:.80} (at most 4e9)"
        )
    return np.asarray(value, dtype=np.float64)


def _number(row: dict[str, Any], key: str, default: float, *, where: str) -> float:
    value = row.get(key, default)
    if not _usable(value):
        raise ConfigError(
            f"{where}: {key} must be a finite number, got {value!r:.80} (at most 4e9)"
        )
    return float(value)


def _usable(value: Any) -> bool:
    # A comparison is exact for whole numbers of any length; NaN fails it.
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and -_LARGEST <= value <= _LARGEST


def _text(row: dict[str, Any], key: str, default: str, *, where: str) -> str:
    value = row.get(key, default)
    if not isinstance(value, str) or len(value) > _MAX_TEXT:
        raise ConfigError(
            f"{where}: {key} must be a text of at most {_MAX_TEXT} characters, got {value!r:.80}"
        )
    return value


def _flag(row: dict[str, Any], key: str, where: str) -> bool:
    value = row.get(key, True)
    if not isinstance(value, bool):
        raise ConfigError(f"{where}: {key} must be true or false, got {value!r:.80}")
    return value


def _port(row: dict[str, Any], default: int, where: str) -> int:
    port = _number(row, "port", default, where=where)
    if not 0 <= port <= 65535 or port != int(port):
        raise ConfigError(f"{where}: port must be 0 to 65535, got {port:g}")
    return int(port)


def _refuse_unknown(row: Any, known: set[str], where: str) -> None:
    if not isinstance(row, dict):
        raise ConfigError(f"{where}: expected a table, got {row!r:.80}")
    unknown = sorted(set(row) - known)
    if unknown:
        raise ConfigError(f"{where}: unknown {str(unknown)[:200]}; known: {sorted(known)}")
