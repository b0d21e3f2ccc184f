"""How the drivers of the makers publish packets: one message for some of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Packet = tuple[Any, NDArray[np.uint8]]
"""Stamp of arrival, and bytes, (B,)."""
Types = Callable[[str], Any]
"""The class of a type, by its name."""


@dataclass(frozen=True, slots=True)
class PacketMessage:
    """A type of message that carries packets; `recon4.recording.packets` reads it."""

    kind: str
    collected: int
    """Packets in a message."""
    make: Callable[[Types, Any, Sequence[Packet]], Any]
    """Of the types, a header and the packets."""


def _velodyne(types: Types, header: Any, packets: Sequence[Packet]) -> Any:
    packet = types("velodyne_msgs/msg/VelodynePacket")
    made = [packet(stamp=stamp, data=data) for stamp, data in packets]
    return types("velodyne_msgs/msg/VelodyneScan")(header=header, packets=made)


def _hesai(types: Types, header: Any, packets: Sequence[Packet]) -> Any:
    packet = types("hesai_ros_driver/msg/UdpPacket")
    made = [packet(stamp=stamp, data=data, size=len(data)) for stamp, data in packets]
    return types("hesai_ros_driver/msg/UdpFrame")(header=header, packets=made)


def _robosense(types: Types, header: Any, packets: Sequence[Packet]) -> Any:
    ((_, data),) = packets
    kind = types("rslidar_msg/msg/RslidarPacket")
    return kind(header=header, is_difop=0, is_frame_begin=0, data=data)


def _ouster(types: Types, _: Any, packets: Sequence[Packet]) -> Any:
    ((_, data),) = packets
    return types("ouster_ros/msg/PacketMsg")(buf=data)


PACKET_MESSAGES: Mapping[str, PacketMessage] = {
    # What the driver collects is a little more than a revolution.
    "Velodyne": PacketMessage("velodyne_msgs/msg/VelodyneScan", 76, _velodyne),
    "Hesai": PacketMessage("hesai_ros_driver/msg/UdpFrame", 180, _hesai),
    "RoboSense": PacketMessage("rslidar_msg/msg/RslidarPacket", 1, _robosense),
    "Ouster": PacketMessage("ouster_ros/msg/PacketMsg", 1, _ouster),
}
"""By maker. The driver of Livox publishes points."""
