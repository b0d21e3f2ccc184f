"""Messages of bags that carry packets of LiDARs, of all families."""

from __future__ import annotations

from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import MessagePackets

PACKET_MESSAGES: dict[str, MessagePackets] = {
    kind: row for family in FAMILIES for kind, row in family.messages.items()
}
"""Type of the message -> how to get its packets."""
DATA_MESSAGES = frozenset(kind for kind, row in PACKET_MESSAGES.items() if not row.samples)
"""Types that carry data packets."""
DEFINITIONS: dict[str, str] = {
    kind: text for row in PACKET_MESSAGES.values() for kind, text in row.definitions.items()
}
"""Types of messages in ROS's language, for bags that do not bring them."""
