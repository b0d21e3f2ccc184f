"""Calibration of the very sensor that an HDL-64E needs: of a file, or of its status bytes.

Files are the YAML of the ROS driver (radians, meters) and the ``db.xml`` of VeloView (degrees,
centimeters). Status bytes: HDL-64E S2 and S3 manuals, 63-HDL64ES2 and 63-9194, appendix E.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.laser_corrections import LASER
from recon4.recording.packets.family import Companion, Payloads

LASERS = 64
_MOST_BYTES = 200_000
_FARTHEST_M = 131.0
"""The largest distance on the wire."""
_FIELDS = (
    *("rot_correction", "vert_correction", "dist_correction", "dist_correction_x"),
    *("dist_correction_y", "vert_offset_correction", "horiz_offset_correction"),
    *("focal_distance", "focal_slope", "min_intensity", "max_intensity"),
)
_DEFAULTS = {"max_intensity": 255.0}
_TAG = re.compile(rb"<(\w+)_>\s*([-+0-9.eE]+)\s*</\1_>")
_LIST = re.compile(rb"<(min|max)Intensity_[^>]*>(.*?)</\1Intensity_>", re.DOTALL)
_YAML_ITEM = re.compile(rb"^\s*-\s|\{", re.MULTILINE)
_YAML_PAIR = re.compile(rb"([a-z_]+)\s*:\s*([-+.0-9eE]+)")
_ITEM = re.compile(rb"<item>\s*([-+0-9.eE]+)\s*</item>")
_XML_UNITS = {
    "rotCorrection": ("rot_correction", np.deg2rad(1.0)),
    "vertCorrection": ("vert_correction", np.deg2rad(1.0)),
    "distCorrection": ("dist_correction", 0.01),
    "distCorrectionX": ("dist_correction_x", 0.01),
    "distCorrectionY": ("dist_correction_y", 0.01),
    "vertOffsetCorrection": ("vert_offset_correction", 0.01),
    "horizOffsetCorrection": ("horiz_offset_correction", 0.01),
    "focalDistance": ("focal_distance", 0.01),
    "focalSlope": ("focal_slope", 1.0),
}
_STATUS_BYTES = 1820
"""One byte a packet: 64 lasers and what is around them, in rows of 7; then they come again."""
_STATUS_STEP = 91
"""Where to begin to look for it, if a packet is missing [bytes]."""
_CYCLE = b"HMSDNYGTV"
"""Types of the 9 bytes between the rows of 7: time, GPS, temperature, firmware."""
_ROW = np.dtype(
    [
        ("laser", "u1"),
        *[(name, "<i2") for name in ("vert", "rot", "far", "near_x", "near_y", "up", "aside")],
        *[("focal", "<i2"), ("slope", "<i2"), ("min", "u1"), ("max", "u1")],
    ]
)
_ROW_BYTES = 28
"""From one laser to the next: 4 rows of 7 bytes, 21 of them used."""


@dataclass(frozen=True, slots=True, eq=False)
class LaserCalibration:
    """The lasers of one sensor, in the order of the wire."""

    rot_rad: Array
    """Subtracted from the azimuth, (L,)."""
    elevation_rad: Array
    """Above the horizontal plane, (L,)."""
    far_m: Array
    """Added to distances, (L,)."""
    near_m: Array
    """The same for points at 2.4 m along y and 1.93 m along x, by interpolation up to 25.04 m;
    columns y and x, (L, 2)."""
    up_m: Array
    """Origin of the beam above the center, (L,)."""
    aside_m: Array
    """Origin of the beam to the left of it, (L,)."""
    focal: Array
    """Focal distance [m], slope, least and largest intensity, (L, 4)."""
    source: str
    """Where it is from: ``status-bytes`` (of the packets), or a file."""


def calibration_of(companions: Sequence[Companion]) -> LaserCalibration | None:
    """The first file with the calibration of 64 lasers; None = there is none."""
    found = (calibration_of_file(companion) for companion in companions)
    return next((one for one in found if one is not None), None)


def calibration_of_file(file: Companion) -> LaserCalibration | None:
    """The calibration in a YAML or XML file; None = it is not one of 64 lasers."""
    if len(file.content) > _MOST_BYTES:
        return None
    rows = _of_xml(file.content) if b"rotCorrection_" in file.content else _of_yaml(file.content)
    return _calibration(rows, file.name)


def _of_yaml(content: bytes) -> dict[int, dict[str, float]]:
    """Flat mappings of numbers, in braces or not: a list item each."""
    rows = {}
    for item in _YAML_ITEM.split(content) if b"laser_id" in content else ():
        pairs = {name.decode(): _number(text) for name, text in _YAML_PAIR.findall(item)}
        if "laser_id" in pairs and math.isfinite(pairs["laser_id"]):
            rows[int(pairs["laser_id"])] = {n: pairs[n] for n in _FIELDS if n in pairs}
    return rows


def _of_xml(content: bytes) -> dict[int, dict[str, float]]:
    rows: dict[int, dict[str, float]] = {}
    laser = -1
    for tag, text in _TAG.findall(content):
        name, value = tag.decode("ascii", "replace"), _number(text)
        if name == "id":
            laser = int(value) if math.isfinite(value) else -1
        elif name in _XML_UNITS:
            field, unit = _XML_UNITS[name]
            rows.setdefault(laser, {})[field] = unit * value
    for end, body in _LIST.findall(content):
        for k, text in enumerate(_ITEM.findall(body)[:LASERS]):
            if k in rows:
                rows[k][f"{end.decode()}_intensity"] = _number(text)
    return rows


def _number(text: bytes) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _calibration(rows: dict[int, dict[str, float]], source: str) -> LaserCalibration | None:
    if set(rows) != set(range(LASERS)) or any("vert_correction" not in rows[k] for k in rows):
        return None
    table = np.array(
        [
            [rows[laser].get(name, _DEFAULTS.get(name, 0.0)) for name in _FIELDS]
            for laser in range(LASERS)
        ]
    )
    two_points = np.any(table[:, 3:5] != 0, axis=1, keepdims=True)
    angles, meters = np.abs(table[:, :2]), np.abs(table[:, 2:7])
    if not np.isfinite(table).all() or angles.max() > 2 * np.pi or meters.max() > 10.0:
        return None
    return LaserCalibration(
        table[:, 0],
        table[:, 1],
        table[:, 2],
        np.where(two_points, table[:, 3:5], table[:, 2:3]),
        table[:, 5],
        table[:, 6],
        table[:, 7:11],
        source,
    )


def calibration_in_status(payloads: Payloads) -> LaserCalibration | None:
    """The calibration in the last bytes of packets; None = it is not there as a whole.

    It takes 4160 packets, from any one on, because it comes again and again.

    Args:
        payloads: Data packets in order, without a gap where the calibration is, (P, 1206).
    """
    kinds, values = payloads[:, -2], payloads[:, -1]
    carries = ~np.isin(kinds, np.frombuffer(_CYCLE, np.uint8))
    stream = values[carries].tobytes()
    for first in range(0, max(len(stream) - _STATUS_BYTES + 1, 0), _STATUS_STEP):
        around = stream[first : first + _STATUS_BYTES]
        start = (around + around[:4]).find(b"UNIT#")
        table = _of_status(around[start:] + around[:start]) if start >= 0 else None
        if table is not None:
            return table
    return None


def _of_status(block: bytes) -> LaserCalibration | None:
    """The table after ``UNIT#`` and two thresholds; None if it is cut or damaged."""
    end = 7 + LASERS * _ROW_BYTES
    if len(block) < end:
        return None
    raw = np.frombuffer(block[7:end], np.uint8).reshape(LASERS, _ROW_BYTES)
    rows = np.ascontiguousarray(raw[:, : _ROW.itemsize]).view(_ROW)[:, 0]
    if not np.array_equal(rows["laser"], np.arange(LASERS)):
        return None
    millimeters = {name: 0.001 * rows[name] for name in ("far", "near_x", "near_y", "up", "aside")}
    columns = {
        "rot_correction": np.deg2rad(0.01 * rows["rot"]),
        "vert_correction": np.deg2rad(0.01 * rows["vert"]),
        "dist_correction": millimeters["far"],
        "dist_correction_x": millimeters["near_x"],
        "dist_correction_y": millimeters["near_y"],
        "vert_offset_correction": millimeters["up"],
        "horiz_offset_correction": millimeters["aside"],
        "focal_distance": 0.001 * rows["focal"],
        "focal_slope": 0.1 * rows["slope"],
        "min_intensity": rows["min"].astype(np.float64),
        "max_intensity": rows["max"].astype(np.float64),
    }
    table = {k: {name: float(column[k]) for name, column in columns.items()} for k in range(LASERS)}
    return _calibration(table, "status-bytes")


def correction_table(calibration: LaserCalibration) -> NDArray[np.float32]:
    """The numbers that `laser_corrections.correct` needs of each laser, (L, 10).

    Between near and far points the correction of the range is interpolated, along x and y on their
    own; upwards it is their mean, as in velodyne-decoder (the manual takes that along x).
    """
    less = calibration.far_m[:, None] - calibration.near_m
    focal = calibration.focal
    table = np.zeros((len(less), LASER.numbers))
    table[:, LASER.cos_el] = np.cos(calibration.elevation_rad)
    table[:, LASER.sin_el] = np.sin(calibration.elevation_rad)
    table[:, LASER.aside], table[:, LASER.far] = calibration.aside_m, calibration.far_m
    table[:, LASER.less_y], table[:, LASER.less_x] = less.T
    table[:, LASER.focus] = 256.0 * (1.0 - focal[:, 0] / _FARTHEST_M) ** 2
    table[:, LASER.slope] = focal[:, 1]
    table[:, LASER.least], table[:, LASER.most] = np.clip(focal[:, 2:], 0.0, 255.0).T
    return table.astype(np.float32)
