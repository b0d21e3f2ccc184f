"""Packets of one sensor, one behind the other: how those of any family are read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.model.rig import Sensor
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.packets.family import Companion, PacketFamily, PacketSensor
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS
from tests.security.fuzz import seeds_tables as tables
from tests.security.fuzz.kind import Reading


@dataclass(frozen=True)
class PacketRun:
    """The packets of a file of seeds."""

    family: PacketFamily
    model: str
    """Name in `LIDARS`."""
    size: int
    """Bytes of a packet."""
    count: int
    """Data packets in the seed; fewer are a loss that is announced."""
    companions: Sequence[Companion] = ()

    def read(self, path: Path) -> Reading:
        """Recognize and decode them: all points are finite and near."""
        data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
        payloads = data[: len(data) // self.size * self.size].reshape(-1, self.size)
        head = datagrams_of([T0_NS] * len(payloads), [row.tobytes() for row in payloads])
        self.family.recognize(head, ())
        settings = IngestSettings()
        pose = tables.rig().sensors[0].T_body_sensor
        packets = self.family.open(
            PacketSensor(
                row=0,
                sensor=Sensor(name="a", model=self.model, T_body_sensor=pose),
                head=head,
                companions=self.companions,
                settings=settings,
                report=ImportReport(),
            )
        )
        sound = payloads[packets.sound(payloads)]
        shots = packets.decode(packets.stamps_ns(sound), sound)
        assert np.isfinite(shots.xyz).all()
        assert np.abs(shots.xyz).max(initial=0) <= 2 * settings.max_range_m
        lost = len(sound) < self.count or len(data) % self.size > 0
        return Reading(len(shots), salvaged=lost)
