"""Packets of Hesai sensors out of bags, and what a `HesaiFormat` makes of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.rig import Sensor
from recon4.recording.formats.bags import Bag
from recon4.recording.formats.datagrams import NO_DATAGRAMS, Datagrams, datagrams_of
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.packets.hesai.angles import Angles
from recon4.recording.packets.hesai.data_packets import HesaiFormat, HesaiPackets
from recon4.recording.packets.hesai.family import FAMILY as HESAI
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

WIDE = IngestSettings(min_range_m=0.0, max_range_m=300.0)


def packets_of_bag(folder: Path) -> list[bytes]:
    """Payloads in a bag of ``pandar_msgs/PandarScan``."""
    path = next(path for path in folder.iterdir() if path.is_dir())
    packets = HESAI.messages["pandar_msgs/msg/PandarScan"].packets
    with Bag([path], ImportReport()) as bag:
        messages = bag.messages([topic.name for topic in bag.topics])
        return [data for one in messages for _, data in packets(bag.decode(one))]


def datagrams(payloads: list[bytes] | np.ndarray, step_ns: int = 100_000) -> Datagrams:
    payloads = [bytes(payload) for payload in payloads]
    return datagrams_of([step_ns * row for row in range(1, len(payloads) + 1)], payloads)


def packet_sensor(
    model: str,
    *,
    name: str = "lidar",
    head: Datagrams = NO_DATAGRAMS,
    companions: tuple[Companion, ...] = (),
    settings: IngestSettings = WIDE,
) -> PacketSensor:
    return PacketSensor(
        row=0,
        sensor=Sensor(name=name, model=model, T_body_sensor=SE3.identity()),
        head=head,
        companions=companions,
        settings=settings,
        report=ImportReport(),
    )


def tables_in(folder: Path) -> tuple[Companion, ...]:
    return tuple(Companion(file.name, file.read_bytes()) for file in sorted(folder.glob("*.csv")))


def without_turn(made: HesaiFormat, sensor: PacketSensor, directions: object) -> HesaiFormat:
    """The same, for a head that stands still while a block fires."""
    packets = made.packets
    still = replace(packets.model, speed_rpm=0.0)
    return HesaiFormat(
        HesaiPackets(still, packets.layout, packets.header, packets.mode), directions, sensor
    )


def decoded(payloads: np.ndarray, made: HesaiFormat):
    """Shots of the sound ones."""
    payloads = payloads[made.sound(payloads)]
    return made.decode(made.stamps_ns(payloads), payloads)


def table_of(angles: Angles, name: str = "correction.csv") -> Companion:
    """A correction file."""
    degrees = np.rad2deg(np.column_stack([angles.elevation_rad, angles.azimuth_rad]))
    rows = [f"{row},{e:.5f},{a:.5f}" for row, (e, a) in enumerate(degrees.tolist(), start=1)]
    return Companion(name, "\n".join(["Channel,Elevation,Azimuth", *rows]).encode())
