"""Messages of bags with packets of RoboSense LiDARs."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.recording.packets.family import MessagePackets, Payloads, stamped_packet
from recon4.recording.packets.robosense.models import MODELS, SIZE, TYPE_AT, RoboSenseModel
from recon4.recording.packets.robosense.packets import has_flags, has_id
from recon4.recording.packets.robosense.solid import SOLID_MODELS, SolidModel, sound_solid
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS


def _messages() -> dict[str, MessagePackets]:
    """Messages of the drivers of Nebula and of the maker, the latter under all its names."""
    header, stamp = "std_msgs/Header header\n", "builtin_interfaces/Time stamp\n"
    scan, packet = "robosense_msgs/msg/RobosenseScan", "robosense_msgs/msg/RobosensePacket"
    info = "robosense_msgs/msg/RobosenseInfoPacket"
    bodies = (
        f"{stamp}uint8 is_difop\nuint8[1500] data\nuint32 size\n",
        f"{stamp}uint8[1500] data\nuint32 size\n",
        f"{stamp}uint8[1248] data\nuint32 size\n",
        f"{stamp}uint8[1248] data\n",
    )
    found = {}
    for kind, text in (
        (scan, f"{header}robosense_msgs/RobosensePacket[] packets\n"),
        (info, "string lidar_model\nrobosense_msgs/RobosensePacket packet\n"),
    ):
        usual, *others = ({kind: text, packet: body} for body in bodies)
        get, samples = (_scan, False) if kind == scan else (_info, True)
        found[kind] = MessagePackets(
            usual, get, samples=samples, senders=senders, versions=tuple(others)
        )
    for package in ("rslidar_msg", "rslidar_msgs"):
        name = f"{package}/msg/RslidarPacket"
        text = f"{header}uint8 is_difop\nuint8 is_frame_begin\nuint8[] data\n"
        found[name] = MessagePackets(definitions={name: text}, packets=_one, senders=senders)
        old, its = f"{package}/msg/rslidarScan", f"{package}/msg/rslidarPacket"
        texts = {
            old: f"{header}{package}/rslidarPacket[] packets\n",
            its: f"{stamp}uint8[1248] data\n",
        }
        found[old] = MessagePackets(definitions=texts, packets=_scan, senders=senders)
        found[its] = MessagePackets(
            definitions={its: texts[its]}, packets=lambda one: [stamped_packet(one)], samples=True
        )
    return found


def senders(payloads: Payloads) -> list[str]:
    """Models with the bytes of data packets, and their type and variant in the header."""
    names = [""] * len(payloads)
    models: list[RoboSenseModel | SolidModel] = [*MODELS.values(), *SOLID_MODELS.values()]
    for model in models:
        for row in np.flatnonzero(_is_data_of(payloads, model)).tolist():
            kind, variant = payloads[row, TYPE_AT : TYPE_AT + 2].tolist()
            names[row] = names[row] or f"{model.name.split()[0]}-{kind}.{variant}"
    return names


def _is_data_of(payloads: Payloads, model: RoboSenseModel | SolidModel) -> NDArray[np.bool_]:
    if isinstance(model, SolidModel):
        is_size = payloads.shape[1] == model.size
        return sound_solid(payloads, ImportReport()) if is_size else _none(payloads)
    if payloads.shape[1] != SIZE:
        return _none(payloads)
    return has_id(payloads, model) & has_flags(payloads, model)


def _none(payloads: Payloads) -> NDArray[np.bool_]:
    return np.zeros(len(payloads), np.bool_)


def _scan(message: Any) -> list[tuple[int, bytes]]:
    return [stamped_packet(packet) for packet in message.packets]


def _info(message: Any) -> list[tuple[int, bytes]]:
    return [stamped_packet(message.packet)]


def _one(message: Any) -> list[tuple[int, bytes]]:
    stamp = message.header.stamp
    t_ns = int(stamp.sec) * SECOND_NS + int(stamp.nanosec)
    return [(t_ns, np.asarray(message.data, np.uint8).tobytes())]


MESSAGES: Mapping[str, MessagePackets] = MappingProxyType(_messages())
"""Type of the message -> how to get its packets."""
