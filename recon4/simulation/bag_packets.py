"""How the drivers of the makers publish packets: one message for some of them.

The drivers of Livox publish points instead: `recon4.simulation.bag`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.messages import PACKET_MESSAGES as READ_MESSAGES

Packet = tuple[Any, NDArray[np.uint8]]
"""Stamp of arrival, and bytes, (B,)."""
Types = Callable[[str], Any]
"""The class of a type, by its name."""


@dataclass(frozen=True, slots=True)
class PacketMessage:
    """A type of message that carries packets, or their points; recon4 reads it."""

    kind: str
    collected: int
    """Packets in a message."""
    make: Callable[[Types, Any, Sequence[Packet]], Any]
    """Of the types, a header and the packets."""
    definitions: Mapping[str, str]
    """The type and those it is made of: name -> text in ROS's language."""


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


def _message(kind: str, collected: int, make: Callable[..., Any]) -> PacketMessage:
    return PacketMessage(kind, collected, make, READ_MESSAGES[kind].definitions)


PACKET_MESSAGES: Mapping[str, PacketMessage] = {
    # What the driver collects is a little more than a revolution.
    "Velodyne": _message("velodyne_msgs/msg/VelodyneScan", 76, _velodyne),
    "Hesai": _message("hesai_ros_driver/msg/UdpFrame", 180, _hesai),
    "RoboSense": _message("rslidar_msg/msg/RslidarPacket", 1, _robosense),
    "Ouster": _message("ouster_ros/msg/PacketMsg", 1, _ouster),
}
"""By maker."""
