"""Scans of a 2-D laser and line scans of a profiler in UDP datagrams, as JSON.

    {"t_ns": 1790000000000000000, "angle_min": -2.356, "angle_increment": 0.00436,
     "time_increment": 2.8e-05, "range_min": 0.05, "range_max": 20.0,
     "ranges": [4.211, null, 4.207], "intensities": [120, 0, 118], "odometry": [1.2, 0.4, 0.01]}
    {"t_ns": 1790000000000000000, "head_rad": 1.234}

One object a datagram, with the names of ``sensor_msgs/LaserScan``; ``null`` is no return.
``t_ns`` is absolute; without it the time of arrival counts. ``odometry`` is the pose of the laser
by the robot: x [m], y [m], yaw [rad]. ``head_rad`` is the angle of a profiler's head.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.model.laser_scans import LaserScans
from recon4.recording.lasers.tuning import SCAN_DATAGRAMS
from recon4.recording.limits import LIMITS
from recon4.untrusted.typed import as_type


class ScanMessage(msgspec.Struct, frozen=True, kw_only=True):
    """A scan with the fields of a ``LaserScan``."""

    ranges: list[float | None]
    """[m]; None = no return."""
    angle_min: float
    """[rad]."""
    angle_increment: float
    """[rad]."""
    t_ns: int | None = None
    """Time of the first beam [ns]; None = not known."""
    time_increment: float = 0.0
    """Time between two beams [s]; 0 = not known."""
    scan_time: float = 0.0
    """Time from scan to scan [s]; 0 = not known."""
    range_min: float = 0.0
    """[m]."""
    range_max: float = 0.0
    """[m]; 0 = not known."""
    intensities: list[float | None] = []
    """As many as ranges, or none."""
    odometry: Annotated[list[float], msgspec.Meta(min_length=3, max_length=3)] | None = None
    """Pose of the laser by the robot: x [m], y [m], yaw [rad]."""


class HeadMessage(msgspec.Struct, frozen=True, kw_only=True):
    """The angle of a profiler's head."""

    head_rad: float
    t_ns: int | None = None


_SCANS = msgspec.json.Decoder(ScanMessage)
_HEADS = msgspec.json.Decoder(HeadMessage)


def decode_scan_datagram(payload: bytes) -> ScanMessage | HeadMessage | None:
    """Decode a datagram; None if it is neither a scan nor the angle of a head."""
    decoder: msgspec.json.Decoder[Any] = _SCANS if b'"ranges"' in payload else _HEADS
    try:
        message: ScanMessage | HeadMessage = decoder.decode(payload)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        found = _lenient(payload, decoder)
        if found is None:
            return None
        message = found
    if message.t_ns is not None and not 0 < message.t_ns < LIMITS.latest_ns:
        return None
    if isinstance(message, ScanMessage) and not _is_sound(message):
        return None
    return message


def _lenient(
    payload: bytes, decoder: msgspec.json.Decoder[Any]
) -> ScanMessage | HeadMessage | None:
    """Python writes NaN and Infinity, which JSON does not have: they are no returns."""
    try:
        record = json.loads(payload)
        if not isinstance(record, dict):
            return None
        for name in ("ranges", "intensities"):
            if isinstance(record.get(name), list):
                record[name] = [_finite(value) for value in record[name]]
        found: ScanMessage | HeadMessage = as_type(record, decoder.type)
    except (ValueError, TypeError, msgspec.MsgspecError, RecursionError):
        return None
    return found


def _finite(value: object) -> object:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _is_sound(scan: ScanMessage) -> bool:
    numbers = (scan.range_min, scan.range_max, *(scan.odometry or ()))
    return bool(scan.ranges) and all(map(math.isfinite, numbers))


def is_scan_datagram(payload: bytes) -> bool:
    """Whether a datagram looks like one of these, by its first bytes and names."""
    return payload[:1] == b"{" and (b'"ranges"' in payload or b'"head_rad"' in payload)


# -- what a sender does


def encode_scan(
    scan: Any,
    t_ns: int,
    *,
    odometry: Sequence[float] | None = None,
    angles: tuple[float, float] | None = None,
) -> bytes:
    """A ``LaserScan`` as a datagram; intensities are left out if it would be too long.

    Args:
        scan: Fields of a ``LaserScan``.
        t_ns: Time of its first beam [ns].
        odometry: Pose of the laser: x [m], y [m], yaw [rad].
        angles: First angle and step in place of those of the scan [rad].
    """
    fields: dict[str, object] = {"t_ns": t_ns}
    for name in ("angle_min", "angle_increment", "time_increment", "range_min", "range_max"):
        fields[name] = float(getattr(scan, name))
    if angles is not None:
        fields["angle_min"], fields["angle_increment"] = angles
    if odometry is not None:
        fields["odometry"] = [float(value) for value in odometry]
    text = json.dumps(fields)[:-1].encode()
    text += b', "ranges": [' + _numbers(np.asarray(scan.ranges, np.float32)) + b"]"
    intensities = np.asarray(scan.intensities, np.float32)
    if len(intensities):
        more = b', "intensities": [' + _numbers(np.nan_to_num(intensities)) + b"]"
        room = SCAN_DATAGRAMS.bytes - SCAN_DATAGRAMS.reserved_bytes
        text += more if len(text) + len(more) < room else b""
    return text + b"}"


def encode_scans_row(scans: LaserScans, k: int) -> bytes:
    """Scan ``k`` as a datagram."""
    message = ScanMessage(
        ranges=scans.ranges(k).tolist(),
        angle_min=float(scans.angle_min_rad[k]),
        angle_increment=float(scans.angle_step_rad[k]),
        time_increment=float(scans.time_step_s[k]),
        range_max=scans.range_max_m,
    )
    odometry = None if scans.odometry is None else scans.odometry[k]
    return encode_scan(message, int(scans.t_ns[k]), odometry=odometry)


def encode_head(angle_rad: float, t_ns: int) -> bytes:
    """The angle of a head as a datagram."""
    return json.dumps({"t_ns": t_ns, "head_rad": float(angle_rad)}).encode()


def _numbers(values: NDArray[np.float32]) -> bytes:
    """The shortest digits that give the same float32 again; what is not finite is ``null``."""
    texts = values.astype("S32")
    texts[~np.isfinite(values)] = b"null"
    return b",".join(texts.tolist())
