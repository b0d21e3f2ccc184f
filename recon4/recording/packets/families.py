"""The families of LiDARs whose packets are read, one row each."""

from __future__ import annotations

from recon4.recording.packets.family import PacketFamily
from recon4.recording.packets.hesai.family import HESAI
from recon4.recording.packets.livox.family import LIVOX
from recon4.recording.packets.ouster.family import OUSTER
from recon4.recording.packets.robosense.family import ROBOSENSE
from recon4.recording.packets.velodyne.family import VELODYNE

FAMILIES: tuple[PacketFamily, ...] = (
    HESAI,
    LIVOX,
    ROBOSENSE,
    OUSTER,
    VELODYNE,
)
"""In the order in which they are asked whether a sender is theirs."""
