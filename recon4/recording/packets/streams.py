"""Scans the head of a capture file for streams of datagrams."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from msgspec.structs import replace as replace_fields
from numpy.typing import NDArray

from recon4.errors import EmptyRecording
from recon4.locales.coded import CodedText
from recon4.model.finding import Finding
from recon4.model.rig import Sensor
from recon4.recording.formats.datagrams import (
    NO_DATAGRAMS,
    Datagrams,
    address_text,
    join_datagrams,
)
from recon4.recording.formats.file_times import FileTimes, require_one_walk
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.limits import LIMITS
from recon4.recording.packets.datagram_files import read_datagrams
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, Recognized
from recon4.recording.packets.makes import can_be_of
from recon4.recording.packets.tuning import HEAD
from recon4.recording.report import ImportReport
from recon4.recording.samples.datagrams import SampleDecoder
from recon4.recording.tuning import LISTED

KINDS = ("data", "samples", "IMU", "GNSS", "other")
_CONTENTS = {
    "data": "data packets",
    "samples": "other packets of a LiDAR",
    "IMU": "IMU samples",
    "GNSS": "GNSS samples",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PacketStream:
    """Datagrams of one sender to one port, as far as they were scanned."""

    file: Path
    source: str
    """IPv4 address of the sender."""
    port: int
    """Destination port."""
    kind: str
    """``data`` or ``samples`` (packets of a LiDAR), ``IMU`` or ``GNSS`` (datagrams of samples), or
    ``other``."""
    packets: int
    """In the part that was scanned."""
    t_first_ns: int
    """Capture time of the first."""
    t_last_ns: int
    """Capture time of the last one scanned."""
    t_end_ns: int
    """Capture time of the last in the file; estimated from the file's size if `whole` is false."""
    whole: bool
    """Whether the scan reached the end of the file."""
    found: Recognized | None = None
    """What its packets are; None = not those of a known LiDAR."""
    utc_offset_ns: int | None = None
    """UTC minus capture time if the GPS of its position packets drives its clock."""
    refused: CodedText | None = None
    """Why its packets are no data packets of a LiDAR; empty for other kinds than ``other``."""
    head: Datagrams = NO_DATAGRAMS
    """Its first packets."""

    @property
    def model(self) -> str:
        """Model of the sensor; empty = unknown."""
        return self.found.model if self.found else ""

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Warnings, for example about a product byte that contradicts the data."""
        found = self.found.findings if self.found else ()
        return tuple(replace_fields(one, sensor=self.label) for one in found)

    @property
    def shared(self) -> str:
        """Serial number (or size of the packets) where several sensors send from its address to
        its port; else empty.
        """
        if self.found is None or self.found.rows is None:
            return ""
        return self.found.serial or f"{self.found.size} bytes"

    @property
    def label(self) -> str:
        """Sender and port, for messages."""
        return f"{self.source} to port {self.port}{f' ({self.shared})' if self.shared else ''}"

    @property
    def text(self) -> str:
        """What its packets are, for messages that say why there is no data."""
        what = _CONTENTS.get(self.kind, self.refused or "")
        what += f" of a {self.model}" * bool(self.kind == "data" and self.model)
        return f"{self.packets} packets from {self.label} ({what})"


def scan_pcap(
    path: Path,
    *,
    max_packets: int = 4500,
    open_file: OpenFile = open_plain,
    report: ImportReport | None = None,
    companions: Sequence[Companion] = (),
) -> list[PacketStream]:
    """Scan the head of a capture file: data streams first, in order of appearance.

    Args:
        path: A pcap, pcapng or LVX file.
        max_packets: Largest number of datagrams to read.
        open_file: Opens the file.
        report: Receives the counts of captured packets up to there; None = not wanted.
        companions: Files beside the recording.

    Raises:
        UnknownFormat: If it is not a capture file.
        EmptyRecording: If it holds no packet.
    """
    head = _head(path, max_packets, open_file, report=report or ImportReport())
    streams = [
        stream for one in by_sender(head.datagrams) for stream in _streams(head, one, companions)
    ]
    streams.sort(key=lambda stream: KINDS.index(stream.kind))
    offsets = {s.source: s.utc_offset_ns for s in streams if s.kind == "samples"}
    return [_with_utc(stream, offsets.get(stream.source)) for stream in streams]


def require_one_capture(files: Sequence[Path]) -> None:
    """Check that capture files were recorded one soon after the other, or at the same time.

    Raises:
        RecordingError: If a file cannot be read.
        UnknownFormat: If they were not; each is a candidate.
    """
    times = []
    for file in files if len(files) > 1 else ():
        with suppress(EmptyRecording):
            streams = scan_pcap(file, max_packets=HEAD.timed)
            starts, ends = ([getattr(s, t) for s in streams] for t in ("t_first_ns", "t_end_ns"))
            times.append(FileTimes(file, min(starts), max(ends)))
    require_one_walk(times)


def unread_text(report: ImportReport) -> str:
    """The captured packets that were not read, and why; empty = all were."""
    names = ("records_cut", "records_fragment", "records_without_time", "records_not_udp")
    return "; ".join(report.text(name) for name in names if report.counts[name])


def fits(sensor: Sensor, source: str, port: int) -> bool:
    """Whether packets of a sender to a port may be a sensor's."""
    return sensor.address in {"", source} and sensor.port == port


def by_sender(datagrams: Datagrams) -> Iterator[Datagrams]:
    """The datagrams of each sender to each port in order of appearance, of the busiest only.

    A file may name any number of senders, and each family is asked of every one.
    """
    keys = datagrams.source.astype(np.int64) << 16 | datagrams.port
    _, first, packets = np.unique(keys, return_index=True, return_counts=True)
    busiest = first[np.argsort(-packets, kind="stable")[: LIMITS.streams]]
    return (datagrams.take(keys == keys[row]) for row in sorted(busiest.tolist()))


def recognized(head: Datagrams, companions: Sequence[Companion] = ()) -> Recognized | None:
    """What the datagrams of one sender to one port are; None = of no family."""
    answers = (family.recognize(head, companions) for family in FAMILIES)
    found = [answer for answer in answers if answer is not None]
    return min(found, key=lambda one: KINDS.index(one.kind)) if found else None


def late_stream(
    path: Path,
    datagrams: Datagrams,
    sensor: Sensor,
    *,
    claimed: set[tuple[str, int]],
    companions: Sequence[Companion] = (),
) -> PacketStream | None:
    """The data stream of a sensor that was not in the head of a file, from its first packets.

    Args:
        path: The file.
        datagrams: Some of its datagrams.
        sensor: Not found so far.
        claimed: Senders and ports of the data streams known already.
        companions: Files beside the recording.
    """
    for mine in by_sender(datagrams.take(datagrams.port == sensor.port)):
        address = address_text(int(mine.source[0]))
        if (address, sensor.port) in claimed or not fits(sensor, address, sensor.port):
            continue
        found = recognized(mine, companions)
        if found is None or found.kind != "data":
            continue
        if not can_be_of(sensor, found, head=mine, companions=companions):
            continue
        return PacketStream(
            file=path,
            source=address,
            port=sensor.port,
            kind="data",
            packets=len(mine),
            t_first_ns=int(mine.t_ns[0]),
            t_last_ns=int(mine.t_ns[-1]),
            t_end_ns=int(mine.t_ns[-1]),
            whole=False,
            found=found,
            head=first_datagrams(mine),
        )
    return None


@dataclass(frozen=True, slots=True, eq=False)
class _Head:
    """Datagrams from the start of a file."""

    file: Path
    datagrams: Datagrams
    read_ratio: float
    """Part of the file that was read, 0 to 1."""


def _head(path: Path, max_packets: int, open_file: OpenFile, *, report: ImportReport) -> _Head:
    """Exactly the first ``max_packets`` datagrams, independent of the size of the reads."""
    parts: list[Datagrams] = []
    left, bytes_read, read_ratio = max_packets, 0, 1.0
    for batch in read_datagrams(path, report, open_file):
        count = min(len(batch), left)
        parts.append(batch.take(slice(count)))
        left -= count
        if not left or bytes_read > HEAD.scanned_bytes:
            bytes_read += int(batch.start[count - 1] + batch.length[count - 1]) if count else 0
            read_ratio = min(1.0, bytes_read / path.stat().st_size)
            break
        bytes_read += len(batch.buffer)
    if left == max_packets:
        raise EmptyRecording(
            CodedText(
                "packets-no-datagram",
                file=path.name,
                found=unread_text(report) or CodedText("found-nothing"),
            )
        )
    return _Head(path, join_datagrams(parts), read_ratio)


def _streams(
    head: _Head, datagrams: Datagrams, companions: Sequence[Companion]
) -> list[PacketStream]:
    """What one sender sends to one port: one stream, or one of each sensor behind its address."""
    found = recognized(datagrams, companions)
    if found is None:
        kind = _samples_kind(datagrams.take(slice(HEAD.samples)))
        refused = _of_lengths(datagrams.length) if kind == "other" else None
        return [replace(_stream(head, datagrams), kind=kind, refused=refused)]
    return [
        replace(
            _stream(head, datagrams if one.rows is None else datagrams.take(one.rows)),
            kind=one.kind,
            found=one,
            utc_offset_ns=one.utc_offset_ns,
            refused=one.refused,
        )
        for one in (found, *found.others)
    ]


def _stream(head: _Head, datagrams: Datagrams) -> PacketStream:
    """The stream of some datagrams, whatever they are."""
    first, last = int(datagrams.t_ns[0]), int(datagrams.t_ns[-1])
    whole = head.read_ratio > 0.999
    return PacketStream(
        file=head.file,
        source=address_text(int(datagrams.source[0])),
        port=int(datagrams.port[0]),
        kind="other",
        packets=len(datagrams),
        t_first_ns=first,
        t_last_ns=last,
        t_end_ns=last if whole else first + round((last - first) / head.read_ratio),
        whole=whole,
        head=first_datagrams(datagrams),
    )


def _samples_kind(datagrams: Datagrams) -> str:
    """Whether datagrams are samples of an IMU or a GNSS receiver, as text."""
    texts = [datagrams.payload(row) for row in range(len(datagrams))]
    imu, gnss = SampleDecoder(ImportReport()).push(datagrams.t_ns.tolist(), texts)
    return "IMU" if imu is not None else "GNSS" if gnss is not None else "other"


def _of_lengths(length: NDArray[np.int64]) -> CodedText:
    sizes, numbers = np.unique(length, return_counts=True)
    usual = ", ".join(map(str, sizes[np.argsort(-numbers)][: LISTED.sizes].tolist()))
    more = "yes" if len(sizes) > LISTED.sizes else "no"
    return CodedText("refused-sizes", sizes=usual, more=more)


def _with_utc(stream: PacketStream, offset_ns: int | None) -> PacketStream:
    if stream.kind != "data" or offset_ns is None:
        return stream
    return replace(stream, utc_offset_ns=offset_ns)


def first_datagrams(datagrams: Datagrams) -> Datagrams:
    """As many as `PacketHeadTuning.bytes` hold; nothing else stays in memory."""
    kept = np.cumsum(datagrams.length) <= HEAD.bytes
    return datagrams.take(kept).compact()
