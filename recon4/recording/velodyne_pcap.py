"""Pcap files of Velodyne sensors: which streams are inside, and their shots."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from recon4.model.rig import Rig
from recon4.recording.positions import PositionSamples
from recon4.recording.report import ImportReport
from recon4.recording.shots import Shots
from recon4.settings import IngestSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class PacketStream:
    """Datagrams of one sender to one port, as far as they were scanned."""

    file: Path
    source: str
    """IPv4 address of the sender."""
    port: int
    """Destination port."""
    kind: str
    """``data``, ``position`` or ``other``."""
    packets: int
    t_first_ns: int
    t_last_ns: int
    model: str
    """What the sensor is: by its packet interval, else by its product byte; empty = unknown."""
    product: int
    """Product byte; 0 for other kinds."""
    return_mode: int
    """0x37 strongest, 0x38 last, 0x39 dual; 0 for other kinds."""
    rotation_hz: float
    """Measured; NaN for other kinds."""
    remarks: tuple[str, ...]
    """What a person should know, for example a product byte that the data contradict."""


def scan_pcap(path: Path, *, max_packets: int = 4000) -> list[PacketStream]:
    """Look at the head of a capture file: data streams first, in order of appearance.

    Raises:
        UnknownFormat: If it is not a capture file.
        EmptyRecording: If it holds no packet.
    """
    raise NotImplementedError


class VelodynePcap:
    """The recording in one or several capture files, each sensor on one clock.

    ``rig`` is the one given, with sensors that have no packets warned of; without one, a rig with
    one sensor a data stream, all mounted at the origin.
    """

    rig: Rig
    streams: list[PacketStream]

    def __init__(
        self,
        paths: Sequence[Path],
        rig: Rig | None,
        *,
        settings: IngestSettings,
        report: ImportReport,
    ) -> None:
        raise NotImplementedError

    def read(self) -> Iterator[Shots | PositionSamples]:
        """Stream the whole recording once; shots of a sensor come in order of time."""
        raise NotImplementedError
