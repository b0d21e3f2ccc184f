"""Angles of the lasers of a RoboSense: of its device packets, of a csv file, or of the factory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.lidars import lidar_model
from recon4.recording.limits import LIMITS
from recon4.recording.packets.family import Companion, Payloads
from recon4.recording.packets.robosense.models import (
    ANGLE,
    ANGLES_AT,
    DEVICE_ID,
    DUAL_MODE,
    ELEVATIONS_AT,
    INSTALLED_AT,
    MODE_AT,
    SIZE,
    RoboSenseModel,
)
from recon4.recording.packets.robosense.tuning import ROBOSENSE_ANGLES


@dataclass(frozen=True, slots=True, eq=False)
class LaserAngles:
    """Where the lasers of one sensor point."""

    cdeg: NDArray[np.float64]
    """Elevation and azimuth of each [0.01°], (lasers, 2)."""
    source: str
    """Where they are from: ``device-packets``, ``factory`` (of another sensor), or a file."""
    measured: bool
    """Whether they are of this very sensor."""


@dataclass(frozen=True, slots=True, eq=False)
class DeviceData:
    """What one device packet tells."""

    angles_cdeg: NDArray[np.float64]
    """Elevation and azimuth of each laser [0.01°], as many as are given, (L, 2)."""
    dual: bool
    """Whether two returns are sent, in the numbers of Helios and Bpearl."""
    installed: int
    """How an Airy is installed; without meaning for other models."""


def is_device(payloads: Payloads) -> NDArray[np.bool_]:
    """Which payloads are device packets (DIFOP) of a sensor that spins, (N,)."""
    if payloads.shape[1] != SIZE:
        return np.zeros(len(payloads), np.bool_)
    return np.asarray((payloads[:, :8] == np.frombuffer(DEVICE_ID, np.uint8)).all(axis=1))


def device_data(payloads: Payloads, model: RoboSenseModel) -> DeviceData | None:
    """The newest device packet with angles; None = there is none.

    Args:
        payloads: Packets, (N, 1248); others than device packets are passed over.
        model: Says how and where angles are stated.
    """
    for payload in payloads[is_device(payloads)][::-1]:
        read = _elevations if model.device_angles == "elevations" else _signed_angles
        angles = read(payload, model)
        if len(angles) and np.abs(angles).max() < 9000 and np.ptp(angles[:, 0]) > 0:
            dual = int(payload[MODE_AT]) == DUAL_MODE
            return DeviceData(angles, dual, int(payload[INSTALLED_AT]))
    return None


def _signed_angles(payload: NDArray[np.uint8], model: RoboSenseModel) -> NDArray[np.float64]:
    """Elevation and azimuth of each laser [0.01°], as many as are given, (L, 2)."""
    lasers = max(ROBOSENSE_ANGLES.least_room, model.lasers)
    table = np.ascontiguousarray(payload[ANGLES_AT : ANGLES_AT + 6 * lasers]).view(ANGLE)
    given = table["sign"].reshape(2, lasers) <= 1
    count = int(np.argmin(given.all(axis=0))) if not given.all() else lasers
    signs = 1 - 2 * table["sign"].reshape(2, lasers)[:, :count].astype(np.float64)
    angles = (signs * table["cdeg"].reshape(2, lasers)[:, :count]).T
    return angles / 10.0 if model.device_angles == "0.001 deg" else angles


def _elevations(payload: NDArray[np.uint8], model: RoboSenseModel) -> NDArray[np.float64]:
    """Elevation of each laser, with azimuth 0 [0.01°], (L, 2): the first half looks down."""
    lasers = model.lasers
    digits = payload[ELEVATIONS_AT : ELEVATIONS_AT + 3 * lasers].reshape(lasers, 3)
    elevation = 0.01 * (digits.astype(np.float64) @ np.array([1 << 16, 1 << 8, 1]))
    elevation[: lasers // 2] *= -1.0
    return np.column_stack([elevation, np.zeros(lasers)])


def laser_angles(
    model: RoboSenseModel, device: DeviceData | None, companions: Sequence[Companion]
) -> LaserAngles:
    """The angles of a sensor: its own, else those of a file, else those of the factory.

    Raises:
        ConfigError: If there are none of any kind.
    """
    if device is not None and len(device.angles_cdeg) >= model.lasers:
        return LaserAngles(device.angles_cdeg[: model.lasers], "device-packets", True)
    found = [(one, table) for one in companions if (table := fitting_table(one, model)) is not None]
    named = [pair for pair in found if _names(pair[0].name, model)]
    if named or found:
        file, table = (named or found)[0]
        return LaserAngles(table, file.name, True)
    if model.factory_cdeg is None:
        raise ConfigError(
            CodedText("robosense-needs-angles", model=model.name, lasers=model.lasers)
        )
    return LaserAngles(model.factory_cdeg.astype(np.float64), "factory", False)


def _names(file: str, model: RoboSenseModel) -> bool:
    plain = "".join(filter(str.isalnum, file.lower()))
    return "".join(filter(str.isalnum, model.name.lower())) in plain


def fitting_table(file: Companion, model: RoboSenseModel) -> NDArray[np.float64] | None:
    """The table of a file if it has the lasers and elevations of the model [0.01°]."""
    table = angles_of_csv(file)
    if table is None or len(table) != model.lasers:
        return None
    low, high = lidar_model(model.name).elevation_deg
    inside = (table[:, 0] >= 100 * (low - ROBOSENSE_ANGLES.tolerance_deg)) & (
        table[:, 0] <= 100 * (high + ROBOSENSE_ANGLES.tolerance_deg)
    )
    return table if inside.all() else None


def angles_of_csv(file: Companion) -> NDArray[np.float64] | None:
    """Rows of elevation and azimuth [0.01°] of a csv file; None = it has none.

    Rows are ``elevation,azimuth[,ring]`` in the order of the lasers without a header, or
    ``laser,elevation,azimuth`` under a header.
    """
    lines = [line.strip() for line in file.content.decode("utf-8", "replace").splitlines()]
    rows = [line for line in lines if line][: LIMITS.angle_rows + 1]
    if not rows or len(rows) > LIMITS.angle_rows:
        return None
    header = rows[0].lower()
    named = "elevation" in header and "azimuth" in header
    first = 1 if named and header.startswith(("laser", "channel")) else 0
    try:
        cells = [[float(cell) for cell in row.split(",") if cell.strip()] for row in rows[named:]]
        table = 100.0 * np.array([row[first : first + 2] for row in cells], np.float64)
    except ValueError:
        return None
    right = table.ndim == 2 and table.shape[1] == 2 and bool((np.abs(table) < 9000).all())
    return table if right else None
