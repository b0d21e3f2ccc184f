"""What a MANDEYE device says of itself and of its LiDARs, ``statusNNNN.json``.

An object with ``name``, ``version`` and ``hardware`` of the device, and one object per kind of
LiDAR (``livox``, ``lidar``), whose ``multi.LivoxLidarInfo`` lists the LiDARs with ``dev_type`` and
``sn``; older devices have ``LivoxLidarInfo`` of one. Sources: mandeye_controller, ``main.cpp``
(``produceReport``) and ``LivoxClient.cpp`` (``produceStatus``); livox_lidar_def.h. The folders that
recon4 writes state ``model`` besides, which other makes need.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.model.derived_kinds import DerivedKind
from recon4.model.lidars import LIDARS
from recon4.recording.mandeye.tuning import MANDEYE
from recon4.recording.report import ImportReport
from recon4.store.json_files import read_object

DEVICE_TYPES: Mapping[int, str] = {
    1: "Mid-40",
    2: "Tele-15",
    3: "Horizon",
    6: "Mid-70",
    7: "Avia",
    9: "Mid-360",
    10: "HAP",
    15: "HAP",
}
"""``LivoxLidarDeviceType`` -> model."""


@dataclass(frozen=True, slots=True)
class DeviceStatus:
    """The contents of a file."""

    device: str = ""
    """Name, version and hardware; empty = not stated."""
    models: tuple[tuple[str, str], ...] = ()
    """Serial number (empty = not stated) and model of each LiDAR whose model is known."""
    is_synced: bool = True
    """False = the LiDARs have no common source of time."""

    def model_of(self, serial: str) -> str:
        """Model of a LiDAR by its serial number; that of the only one if it has none; or empty."""
        if not serial:
            return self.models[0][1] if len(self.models) == 1 else ""
        return dict(self.models).get(serial, "")


def read_status(paths: Iterable[Path], report: ImportReport) -> DeviceStatus:
    """The first file that states LiDARs, else the last one that can be read.

    Args:
        paths: In the order of the parts; missing ones are passed over.
        report: Receives the count of damaged files, what the device is, and whether its LiDARs have
            clocks of their own.
    """
    found = DeviceStatus()
    for path in paths:
        if not path.is_file():
            continue
        try:
            found = _status(read_object(path, max_bytes=MANDEYE.status_bytes))
        except StoreError:
            report.count("status_files_damaged")
            continue
        if found.models:
            break
    if found.device:
        report.derive(DerivedKind.DEVICE, device=found.device)
    if not found.is_synced and len(found.models) > 1:
        report.derive(DerivedKind.DEVICE_CLOCKS)
    return found


def _status(values: Mapping[str, object]) -> DeviceStatus:
    device = " ".join(
        text[:80] for key in ("name", "version", "hardware") if (text := _text(values.get(key)))
    )
    clients = [client for client in values.values() if isinstance(client, dict)]
    synced = all(client.get("is_synced", True) is not False for client in clients)
    models: dict[str, str] = {}
    for entry in _entries(clients):
        model, serial = _model(entry), _text(entry.get("sn"))
        if model and (serial or not models):
            models.setdefault(serial, model)
    return DeviceStatus(device, tuple(models.items()), synced)


def _entries(clients: Iterable[Mapping[str, object]]) -> Iterator[Mapping[str, object]]:
    for client in clients:
        several = client.get("multi")
        listed = several.get("LivoxLidarInfo") if isinstance(several, dict) else None
        one = client.get("LivoxLidarInfo")
        for entry in listed if isinstance(listed, list) else [one]:
            if isinstance(entry, dict):
                yield entry


def _model(entry: Mapping[str, object]) -> str:
    stated, number = _text(entry.get("model")), entry.get("dev_type")
    if stated in LIDARS and stated != "generic":
        return stated
    return DEVICE_TYPES.get(number, "") if type(number) is int else ""


def _text(value: object) -> str:
    """A text of one line; devices write ``null`` for what they do not know."""
    text = " ".join(value.split()) if isinstance(value, str) else ""
    return "" if text == "null" else text
