"""Health of each LiDAR and scanner: rate, packet loss and clock. No I/O."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.live.findings import rates
from recon4.live.mapper.tuning import NOTES
from recon4.live.newest_messages import Newest
from recon4.live.protocol import Notes
from recon4.model.count_meanings import FREE_CLOCK, JUMPS_OF
from recon4.model.rig import Rig, Sensor

IN_STEP, SHIFTED, JUMPED = "in step", "own, shifted", "jumped"


@dataclass(frozen=True, slots=True)
class LidarHealth:
    """Health of one LiDAR, 2-D laser or profiler."""

    name: str
    per_s: float
    """Data packets or datagrams per second."""
    lost: float | None
    """Packet loss ratio of the last `NOTES.recent_s`, 0 to 1; None = unknown."""
    clock: str
    """`IN_STEP` with the recorder's clock or GPS, `SHIFTED` if it runs freely (no PPS),
    `JUMPED` if it or the recorder's clock jumped since the start; empty = unknown."""
    jumps: int = 0
    """How often."""


def lidars(rig: Rig, newest: Newest) -> list[LidarHealth]:
    """Health of each sensor of a rig.

    Args:
        rig: The sensors that should send.
        newest: Newest messages of recorder and mapper.
    """
    if newest.status is None:
        return []
    per_s = rates(rig, newest.status)
    return [_health(sensor, per_s[sensor.name], newest.notes) for sensor in rig.sensors]


def _health(sensor: Sensor, per_s: float, notes: Notes | None) -> LidarHealth:
    name = sensor.name
    if notes is None or per_s <= 0.0:
        return LidarHealth(name, per_s, None, "")
    jumps = notes.counts.get(f"{JUMPS_OF}{name}", 0)
    free = f"{FREE_CLOCK}{name}" in notes.counts
    clock = JUMPED if jumps else SHIFTED if free else IN_STEP
    if sensor.kind != "lidar":  # its datagrams have no numbers
        return LidarHealth(name, per_s, None, clock, jumps)
    missing = notes.recent.get(f"packets_missing_{name}", 0)
    lost = round(missing / (missing + NOTES.recent_s * per_s), 3)
    return LidarHealth(name, per_s, lost, clock, jumps)
