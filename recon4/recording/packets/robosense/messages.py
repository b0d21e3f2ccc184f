"""Messages of bags with packets of RoboSense LiDARs."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from recon4.recording.packets.family import MessagePackets
from recon4.units import SECOND_NS


def _messages() -> dict[str, MessagePackets]:
    """Messages of the drivers of Nebula and of the maker, the latter under all its names."""
    header, stamp = "std_msgs/Header header\n", "builtin_interfaces/Time stamp\n"
    scan, packet = "robosense_msgs/msg/RobosenseScan", "robosense_msgs/msg/RobosensePacket"
    nebula = {
        scan: f"{header}robosense_msgs/RobosensePacket[] packets\n",
        packet: f"{stamp}uint8 is_difop\nuint8[1500] data\nuint32 size\n",
    }
    found = {scan: MessagePackets(definitions=nebula, packets=_scan)}
    for package in ("rslidar_msg", "rslidar_msgs"):
        name = f"{package}/msg/RslidarPacket"
        text = f"{header}uint8 is_difop\nuint8 is_frame_begin\nuint8[] data\n"
        found[name] = MessagePackets(definitions={name: text}, packets=_one)
        old, its = f"{package}/msg/rslidarScan", f"{package}/msg/rslidarPacket"
        texts = {
            old: f"{header}{package}/rslidarPacket[] packets\n",
            its: f"{stamp}uint8[1248] data\n",
        }
        found[old] = MessagePackets(definitions=texts, packets=_scan)
        found[its] = MessagePackets(
            definitions={its: texts[its]}, packets=lambda one: [_packet(one)], samples=True
        )
    return found


def _scan(message: Any) -> list[tuple[int, bytes]]:
    return [_packet(packet) for packet in message.packets]


def _packet(packet: Any) -> tuple[int, bytes]:
    size = int(getattr(packet, "size", len(packet.data)))
    t_ns = int(packet.stamp.sec) * SECOND_NS + int(packet.stamp.nanosec)
    return t_ns, bytes(np.asarray(packet.data, np.uint8)[:size].tobytes())


def _one(message: Any) -> list[tuple[int, bytes]]:
    stamp = message.header.stamp
    t_ns = int(stamp.sec) * SECOND_NS + int(stamp.nanosec)
    return [(t_ns, np.asarray(message.data, np.uint8).tobytes())]


MESSAGES: Mapping[str, MessagePackets] = MappingProxyType(_messages())
"""Type of the message -> how to get its packets."""
