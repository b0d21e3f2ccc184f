"""Which sensors the messages of one topic are of: clouds by their frame, packets one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from recon4.geometry.distinct import distinct
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.formats.shared_topics import TopicSource, frame_named, source_of
from recon4.recording.packets.family import MessagePackets
from recon4.recording.packets.messages import PACKET_MESSAGES

TimedPacket = tuple[int, bytes]
"""Time of arrival [ns] (0 = that of the message) and bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class OwnPackets:
    """The packets of one sensor in a message of several."""

    header: Any
    """That of the message; None = it has none."""
    packets: list[TimedPacket]


def parts_of(kind: str, content: Any) -> dict[TopicSource, Any]:
    """What a decoded message of some type has of each sensor."""
    row = PACKET_MESSAGES.get(kind)
    if row is None:
        return {source_of(content): content}
    packets, frame = row.packets(content), frame_named(content)
    parts: dict[TopicSource, Any] = {}
    for packet, sender in zip(packets, _senders(row, packets), strict=True):
        own = OwnPackets(getattr(content, "header", None), [])
        parts.setdefault(TopicSource(frame, sender), own).packets.append(packet)
    return parts


def packets_of(kind: str, content: Any) -> list[TimedPacket]:
    """The packets of a decoded message, or of a part of it."""
    if isinstance(content, OwnPackets):
        return content.packets
    return PACKET_MESSAGES[kind].packets(content)


def _senders(row: MessagePackets, packets: Sequence[TimedPacket]) -> list[str]:
    """Which sensor sent each packet, as its bytes say."""
    datagrams = datagrams_of([0] * len(packets), [data for _, data in packets])
    names = [""] * len(packets)
    for size in distinct(datagrams.length).tolist():
        rows = np.flatnonzero(datagrams.length == size)
        named = row.senders(datagrams.payloads(rows, size))
        for place, name in zip(rows.tolist(), named, strict=True):
            names[place] = name
    return names
