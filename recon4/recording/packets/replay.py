"""Captured datagrams as a replay sends them: packets of LiDARs have the times of now."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.recording.formats.datagrams import Datagrams, address_text
from recon4.recording.info.files_near import files_near
from recon4.recording.kinds import capture_files
from recon4.recording.packets.companions import companions_of
from recon4.recording.packets.datagram_files import read_datagrams
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, PacketFamily, Payloads
from recon4.recording.report import ImportReport


@dataclass(frozen=True, slots=True)
class CapturedDatagram:
    """A datagram of a capture file."""

    t_ns: int
    """Arrival time in the recording [ns]."""
    source: str
    port: int
    payload: bytes
    of_lidar: bool
    """Whether it is a packet of a LiDAR, and its times were moved."""


def captured_datagrams(recording: Path, shift_ns: int) -> list[Iterator[CapturedDatagram]]:
    """The datagrams of each capture file.

    Args:
        recording: A capture file or a folder with some.
        shift_ns: Added to all times inside packets of LiDARs, a whole number of microseconds [ns].

    Raises:
        RecordingError: If there is no such path.
    """
    files = capture_files(recording)
    restamping = Restamping(companions_of([*files, *files_near(recording)]))
    return [_of_file(file, restamping, shift_ns) for file in files]


def _of_file(file: Path, restamping: Restamping, shift_ns: int) -> Iterator[CapturedDatagram]:
    for batch in read_datagrams(file, ImportReport()):
        columns = (batch.t_ns.tolist(), batch.source.tolist(), batch.port.tolist())
        payloads = restamping.payloads(batch, shift_ns)
        for t_ns, source, port, (payload, moved) in zip(*columns, payloads, strict=True):
            yield CapturedDatagram(t_ns, address_text(source), port, payload, moved)


class Restamping:
    """Moves the times inside packets; one object a replay."""

    def __init__(self, companions: Sequence[Companion] = ()) -> None:
        """Nothing is known of the senders.

        Args:
            companions: Files beside the recording.
        """
        self._companions = companions
        self._family: dict[tuple[int, int, int], PacketFamily] = {}
        """By sender, port and size of the packets."""

    def payloads(self, batch: Datagrams, shift_ns: int) -> list[tuple[bytes, bool]]:
        """Payloads in their order, and whether each is of a family and was moved.

        Args:
            batch: Captured datagrams.
            shift_ns: Added to all times, a whole number of microseconds [ns].
        """
        out: list[tuple[bytes, bool] | None] = [None] * len(batch)
        keys = np.column_stack([batch.source, batch.port, batch.length]).astype(np.int64)
        kinds, of = np.unique(keys, axis=0, return_inverse=True)
        for kind, (source, port, size) in enumerate(kinds.tolist()):
            rows = np.flatnonzero(of.reshape(-1) == kind)
            found = self._moved((source, port, size), batch.payloads(rows, size), shift_ns)
            if found is not None:
                for row, payload in zip(rows.tolist(), found, strict=True):
                    out[row] = payload.tobytes(), True
        return [one or (batch.payload(row), False) for row, one in enumerate(out)]

    def _moved(
        self, kind: tuple[int, int, int], payloads: Payloads, shift_ns: int
    ) -> Payloads | None:
        known = self._family.get(kind)
        if not payloads.shape[1]:
            return None
        for family in FAMILIES if known is None else (known,):
            moved = family.restamped(payloads, shift_ns, self._companions)
            if moved is not None:
                self._family[kind] = family
                return moved
        return None
