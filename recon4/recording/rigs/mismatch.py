"""What to say where a recording has other LiDARs than its rig."""

from __future__ import annotations

from recon4.model.rig import Rig, Sensor
from recon4.recording.tuning import LISTED

REMEDY = (
    "correct the rig, or give none; recon4 writes a rig of what is in the recording (command: "
    "recon4 info RECORDING --rig-out rig.toml; page: the upload offers it)"
)


def mismatch_text(rig: Rig, found: str) -> str:
    """What a rig expects, what is there, and what to do.

    Args:
        rig: The rig that was given.
        found: The LiDARs of the recording, with their addresses and ports, or topics.
    """
    sensors = [_expected(sensor) for sensor in rig.sensors[: LISTED.names]]
    more = " …" * (len(rig.sensors) > LISTED.names)
    return (
        f"the rig {rig.name!r} expects {'; '.join(sensors)}{more}; the recording has "
        f"{found or 'no packets of a LiDAR'}; {REMEDY}"
    )


def _expected(sensor: Sensor) -> str:
    where = f"from {sensor.address or 'any address'} to port {sensor.port}"
    return f"{sensor.name}: {sensor.model} " + (f"in {sensor.topic}" if sensor.topic else where)
