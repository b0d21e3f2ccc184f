"""Packets of Ouster sensors, real and made up, at the level of the family."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.packets.ouster.family import FAMILY as OUSTER
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.packet_builders import sensor

WIDE = IngestSettings(min_range_m=0.0, max_range_m=900.0)


def companion(path: Path) -> Companion:
    return Companion(path.name, path.read_bytes())


def datagrams_of(payloads, *, port=7502, source=0x0A000001, t_ns=None) -> Datagrams:
    """Datagrams of some payloads, each a row of bytes or bytes."""
    parts = [np.frombuffer(bytes(part), dtype=np.uint8) for part in payloads]
    length = np.array([len(part) for part in parts], dtype=np.int64)
    times = np.arange(len(parts)) * 1_000_000 if t_ns is None else t_ns
    return Datagrams(
        t_ns=np.asarray(times, dtype=np.int64),
        source=np.full(len(parts), source, dtype=np.uint32),
        port=np.full(len(parts), port, dtype=np.uint16),
        length=length,
        start=np.cumsum(length) - length,
        buffer=np.concatenate([*parts, np.zeros(2048, dtype=np.uint8)]),
    )


def of_port(path: Path, port: int) -> Datagrams:
    """The datagrams of a capture file to a port."""
    (batch,) = read_pcap(path, ImportReport())
    rows = np.flatnonzero(batch.port == port)
    payloads = [
        batch.buffer[batch.start[row] : batch.start[row] + batch.length[row]] for row in rows
    ]
    return datagrams_of(payloads, port=port, t_ns=batch.t_ns[rows])


def opened(head: Datagrams, *companions: Companion, settings=WIDE, report=None, **fields):
    """The format of the packets of one sensor."""
    return OUSTER.open(
        PacketSensor(
            row=3,
            sensor=sensor("os", model=fields.pop("model", "Ouster"), **fields),
            head=head,
            companions=companions,
            settings=settings,
            report=report or ImportReport(),
        )
    )


def data_of(datagrams: Datagrams, size: int) -> np.ndarray:
    return datagrams.payloads(np.flatnonzero(datagrams.length == size), size)
