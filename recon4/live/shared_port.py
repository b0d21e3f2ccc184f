"""LiDARs that send to a port at which the rig expects another one."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.live.protocol import Sender
from recon4.live.tuning import CAPTURE_WARNINGS
from recon4.model.rig import Rig, Sensor


def senders_to_another_port(rig: Rig, senders: Sequence[Sender], silent: Sensor) -> list[Sender]:
    """More LiDARs at one port than the rig has there: one of them may be the silent one.

    Args:
        rig: The sensors that should send.
        senders: What sends now.
        silent: A LiDAR of the rig of which nothing arrives.
    """
    least = CAPTURE_WARNINGS.taken_ratio * max((one.data_per_s for one in senders), default=0.0)
    full = [one for one in senders if one.data_per_s > 0.0 and one.data_per_s >= least]
    lidars = [one.port for one in rig.sensors if one.kind == "lidar"]
    for port in sorted({*lidars} - {silent.port}):
        there = [one for one in full if one.port == port]
        if silent.kind == "lidar" and len(there) > lidars.count(port):
            return there
    return []
