"""How each LiDAR is: what it sends, what was lost of it, and whose time it keeps. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from recon4.live.findings import rates
from recon4.live.mapper.notes import RECENT_S
from recon4.model.rig import Rig

Fields = dict[str, Any]

IN_STEP, SHIFTED, JUMPED = "in step", "own, shifted", "jumped"


@dataclass(frozen=True, slots=True)
class LidarHealth:
    """One LiDAR, for the table on the phone."""

    name: str
    per_s: float
    """Data packets a second."""
    lost: float | None
    """Share of its packets that never came, of the last `RECENT_S`; None = not known."""
    clock: str
    """`IN_STEP` with the recorder's or driven by GPS, `SHIFTED` as it runs freely (no PPS),
    or it, or the recorder's, `JUMPED` since the start; empty = not known."""


def lidars(rig: Rig, newest: dict[str, Fields]) -> list[LidarHealth]:
    """Health of each LiDAR of a rig.

    Args:
        rig: What should be there.
        newest: Kind of message to the last of it (`Picture.newest`).
    """
    if "status" not in newest:
        return []
    per_s, notes = rates(rig, newest["status"]), newest.get("notes")
    return [_health(sensor.name, per_s[sensor.name], notes) for sensor in rig.sensors]


def _health(name: str, per_s: float, notes: Fields | None) -> LidarHealth:
    if notes is None or per_s <= 0.0:
        return LidarHealth(name, per_s, None, "")
    missing = notes["recent"].get(f"packets_missing_{name}", 0)
    mine = [text for text in notes["warnings"] if text.startswith(f"{name}: ")]
    return LidarHealth(name, per_s, round(missing / (missing + RECENT_S * per_s), 3), _clock(mine))


def _clock(warnings: list[str]) -> str:
    """From what `recon4.recording.velodyne.sensor_clock` warns of."""
    if any("jumped by" in text for text in warnings):
        return JUMPED
    return SHIFTED if any("no GPS drives it" in text for text in warnings) else IN_STEP
