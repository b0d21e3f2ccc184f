"""Messages of bags that carry packets of LiDARs, of all families."""

from __future__ import annotations

from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import MessagePackets, stamped_packet

_NEBULA, _NEBULA_PACKET = "nebula_msgs/msg/NebulaPackets", "nebula_msgs/msg/NebulaPacket"
_OF_ANY_MAKE = {
    _NEBULA: MessagePackets(
        {
            _NEBULA: "std_msgs/Header header\nnebula_msgs/NebulaPacket[] packets\n",
            _NEBULA_PACKET: "builtin_interfaces/Time stamp\nuint8[] data\n",
        },
        packets=lambda message: [stamped_packet(packet) for packet in message.packets],
    )
}
"""Packets of any family: a topic is of one LiDAR."""
PACKET_MESSAGES: dict[str, MessagePackets] = {
    kind: row for family in FAMILIES for kind, row in family.messages.items()
} | _OF_ANY_MAKE
"""Type of the message -> how to get its packets."""
DATA_MESSAGES = frozenset(kind for kind, row in PACKET_MESSAGES.items() if not row.samples)
"""Types that carry data packets."""
SCANS_WITH_HEADER = frozenset(
    kind
    for kind, row in PACKET_MESSAGES.items()
    if all(
        texts[kind].startswith("std_msgs/Header header")
        for texts in (row.definitions, *row.versions)
    )
)
"""Types whose messages begin with a header in all versions."""
DEFINITIONS: dict[str, str] = {
    kind: text for row in PACKET_MESSAGES.values() for kind, text in row.definitions.items()
}
"""Types of messages in ROS's language, for bags that do not bring them."""
