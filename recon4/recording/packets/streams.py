"""Scans the head of a capture file for streams of datagrams."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import EmptyRecording
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.recording.formats.file_times import FileTimes, require_one_walk
from recon4.recording.formats.pcap import Datagrams, OpenFile, address_text, open_plain, read_pcap
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.sensor_clock import SECOND_NS, nearest_hour
from recon4.recording.packets.velodyne.data_packets import Rotation
from recon4.recording.packets.velodyne.models import (
    BLOCK_FLAG,
    DATA_SIZE,
    LOWER_BLOCK_FLAG,
    MODELS,
    POSITION_SIZE,
    PRODUCTS,
    RETURN_MODES,
    likely_model,
    product_text,
)
from recon4.recording.packets.velodyne.position_packets import utc_offset_ns
from recon4.recording.packets.velodyne.sound_packets import as_packets, sound_packets
from recon4.recording.report import ImportReport
from recon4.recording.samples.datagrams import SampleDecoder

KINDS = ("data", "position", "IMU", "GNSS", "other")
_CONTENTS = {
    "data": "data packets",
    "position": "position packets",
    "IMU": "IMU samples",
    "GNSS": "GNSS samples",
}
_SAMPLES_TRIED = 20
_SIZES_NAMED = 3
_TIMED_PACKETS = 1000
"""Datagrams from which the times of a file are estimated."""
MAX_STREAMS = 256
"""Senders and ports with the most datagrams at the head of a file; a LiDAR is among them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PacketStream:
    """Datagrams of one sender to one port, as far as they were scanned."""

    file: Path
    source: str
    """IPv4 address of the sender."""
    port: int
    """Destination port."""
    kind: str
    """``data``, ``position``, ``IMU`` or ``GNSS`` (datagrams of samples), or ``other``."""
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
    model: str = ""
    """Model of the sensor: by the interval of its packets, else by the product byte; empty =
    unknown."""
    product: int = 0
    """Product byte; 0 for other kinds."""
    return_mode: int = 0
    """0x37 strongest, 0x38 last, 0x39 dual; 0 for other kinds."""
    rotation_hz: float = float("nan")
    """Measured; NaN for other kinds."""
    clock_offset_s: float = float("nan")
    """Sensor's clock minus the recorder's, within an hour; NaN for other kinds."""
    utc_offset_ns: int | None = None
    """UTC minus capture time if the GPS of its position packets drives its clock."""
    remarks: tuple[str, ...] = ()
    """Warning, for example about a product byte that contradicts the data."""
    refused: str = ""
    """Why its packets are no data packets of a Velodyne; empty for other kinds than ``other``."""

    @property
    def label(self) -> str:
        """Sender and port, for messages."""
        return f"{self.source} to port {self.port}"

    @property
    def found(self) -> str:
        """What its packets are, for messages that say why there is no data."""
        what = _CONTENTS.get(self.kind, self.refused)
        return f"{self.packets} packets from {self.label} ({what})"


def address_number(address: str) -> int:
    """0xC0A801C9 for ``192.168.1.201``."""
    a, b, c, d = (int(part) for part in address.split("."))
    return a << 24 | b << 16 | c << 8 | d


def scan_pcap(
    path: Path,
    *,
    max_packets: int = 4000,
    open_file: OpenFile = open_plain,
    report: ImportReport | None = None,
) -> list[PacketStream]:
    """Scan the head of a capture file: data streams first, in order of appearance.

    Args:
        path: A pcap or pcapng file.
        max_packets: Largest number of datagrams to read.
        open_file: Opens the file.
        report: Receives the counts of captured packets up to there; None = not wanted.

    Raises:
        UnknownFormat: If it is not a capture file.
        EmptyRecording: If it holds no packet.
    """
    head = _head(path, max_packets, open_file, report=report or ImportReport())
    keys = head.source.astype(np.int64) << 16 | head.port
    _, first, packets = np.unique(keys, return_index=True, return_counts=True)
    first = first[np.argsort(-packets, kind="stable")[:MAX_STREAMS]]
    streams = [_stream(path, head, keys == keys[row]) for row in sorted(first.tolist())]
    streams.sort(key=lambda stream: KINDS.index(stream.kind))
    offsets = {s.source: s.utc_offset_ns for s in streams if s.kind == "position"}
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
            streams = scan_pcap(file, max_packets=_TIMED_PACKETS)
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


def late_stream(
    path: Path, datagrams: Datagrams, sensor: Sensor, *, claimed: set[tuple[str, int]]
) -> PacketStream | None:
    """The data stream of a sensor that was not in the head of a file, from its first packets.

    Args:
        path: The file.
        datagrams: Some of its datagrams.
        sensor: Not found so far.
        claimed: Senders and ports of the data streams known already.
    """
    rows = np.flatnonzero((datagrams.port == sensor.port) & (datagrams.length == DATA_SIZE))
    for source in dict.fromkeys(datagrams.source[rows].tolist()):
        address = address_text(source)
        if (address, sensor.port) in claimed or not fits(sensor, address, sensor.port):
            continue
        mine = rows[datagrams.source[rows] == source]
        payloads = datagrams.payloads(mine, DATA_SIZE)
        sound = sound_packets(payloads, ImportReport())
        if not sound.any():
            continue
        times = datagrams.t_ns[mine][sound]
        return PacketStream(
            file=path,
            source=address,
            port=sensor.port,
            kind="data",
            packets=len(times),
            t_first_ns=int(times[0]),
            t_last_ns=int(times[-1]),
            t_end_ns=int(times[-1]),
            whole=False,
            return_mode=int(as_packets(payloads[sound])["return_mode"][0]),
        )
    return None


@dataclass(frozen=True, slots=True, eq=False)
class _Head:
    """Datagrams from the start of a file."""

    t_ns: Times
    source: NDArray[np.uint32]
    port: NDArray[np.uint16]
    length: NDArray[np.int64]
    payloads: Payloads
    """First 1206 bytes, (N, 1206)."""
    read_ratio: float
    """Part of the file that was read, 0 to 1."""


def _head(path: Path, max_packets: int, open_file: OpenFile, *, report: ImportReport) -> _Head:
    """Exactly the first ``max_packets`` datagrams, independent of the size of the reads."""
    parts: list[tuple[Datagrams, int]] = []
    left, bytes_read, read_ratio = max_packets, 0, 1.0
    for batch in read_pcap(path, report, open_file):
        count = min(len(batch), left)
        parts.append((batch, count))
        left -= count
        if not left:
            bytes_read += int(batch.start[count - 1] + batch.length[count - 1])
            read_ratio = min(1.0, bytes_read / path.stat().st_size)
            break
        bytes_read += len(batch.buffer)
    if left == max_packets:
        raise EmptyRecording(
            f"{path.name}: no UDP datagram in it; found: {unread_text(report) or 'nothing'}"
        )
    return _Head(
        t_ns=np.concatenate([batch.t_ns[:n] for batch, n in parts]),
        source=np.concatenate([batch.source[:n] for batch, n in parts]),
        port=np.concatenate([batch.port[:n] for batch, n in parts]),
        length=np.concatenate([batch.length[:n] for batch, n in parts]),
        payloads=np.concatenate([b.payloads(np.arange(n), DATA_SIZE) for b, n in parts]),
        read_ratio=read_ratio,
    )


def _stream(path: Path, head: _Head, mine: NDArray[np.bool_]) -> PacketStream:
    t_ns, length = head.t_ns[mine], head.length[mine]
    first, last = int(t_ns[0]), int(t_ns[-1])
    whole = head.read_ratio > 0.999
    facts: dict[str, object]
    if (length == DATA_SIZE).sum() > len(length) // 2:
        rows = length == DATA_SIZE
        facts = _data_facts(t_ns[rows], head.payloads[mine][rows])
    elif (length == POSITION_SIZE).sum() > len(length) // 2:
        rows = length == POSITION_SIZE
        positions = head.payloads[mine][rows][:, :POSITION_SIZE]
        facts = {"kind": "position", "utc_offset_ns": utc_offset_ns(t_ns[rows], positions)}
    else:
        first_rows = np.flatnonzero(mine)[:_SAMPLES_TRIED]
        texts = [head.payloads[k, : head.length[k]].tobytes() for k in first_rows]
        imu, gnss = SampleDecoder(ImportReport()).push(head.t_ns[first_rows].tolist(), texts)
        kind = "IMU" if imu is not None else "GNSS" if gnss is not None else "other"
        facts = {"kind": kind, "refused": _lengths_text(length) if kind == "other" else ""}
    return PacketStream(
        file=path,
        source=address_text(int(head.source[mine][0])),
        port=int(head.port[mine][0]),
        packets=len(t_ns),
        t_first_ns=first,
        t_last_ns=last,
        t_end_ns=last if whole else first + round((last - first) / head.read_ratio),
        whole=whole,
        **facts,  # type: ignore[arg-type]
    )


def _data_facts(t_ns: Times, payloads: Payloads) -> dict[str, object]:
    flags = as_packets(payloads)["blocks"]["flag"]
    if ((flags == LOWER_BLOCK_FLAG).any(axis=1) & (flags == BLOCK_FLAG).any(axis=1)).mean() > 0.3:
        return {"kind": "data", "model": "HDL-64E"}
    report = ImportReport()
    rows = np.flatnonzero(sound_packets(payloads, report))
    if len(rows) < len(payloads) // 2 or not len(rows):
        return {"kind": "other", "refused": "; ".join(report.lost())}
    packets = as_packets(payloads[rows])
    product = int(np.bincount(packets["product"]).argmax())
    return_mode = int(np.bincount(packets["return_mode"]).argmax())
    stamp_ns = packets["time_us"].astype(np.int64) * 1000
    interval_s = _usual_step_s(stamp_ns)
    model, remarks = _model(product, return_mode, interval_s)
    rotation = Rotation()
    if model in MODELS:
        sorted_ns, place = np.unique(stamp_ns, return_index=True)
        rotation.push(sorted_ns, payloads[rows][place], MODELS[model].packet_s(return_mode))
    ahead = nearest_hour(packets["time_us"], t_ns[rows]) - t_ns[rows]
    return {
        "kind": "data",
        "model": model,
        "product": product,
        "return_mode": return_mode,
        "rotation_hz": rotation.hz,
        "clock_offset_s": float(np.median(ahead)) / SECOND_NS,
        "remarks": remarks,
    }


def _lengths_text(length: NDArray[np.int64]) -> str:
    sizes, numbers = np.unique(length, return_counts=True)
    usual = [f"{size} bytes" for size in sizes[np.argsort(-numbers)][:_SIZES_NAMED].tolist()]
    more = " and others" * (len(sizes) > _SIZES_NAMED)
    return f"of {', '.join(usual)}{more}; a data packet has {DATA_SIZE}"


def _usual_step_s(stamp_ns: Times) -> float:
    steps = np.diff(np.unique(stamp_ns))
    return float(np.median(steps)) / SECOND_NS if len(steps) > 4 else float("nan")


def _model(product: int, return_mode: int, interval_s: float) -> tuple[str, tuple[str, ...]]:
    """Name of the model and a warning; the firing pattern overrules the product byte."""
    model = likely_model(product, interval_s, return_mode)
    stated = PRODUCTS.get(product)
    remarks = []
    if return_mode not in RETURN_MODES:
        remarks.append(f"unknown return mode byte {return_mode:#04x}, read as single return")
    if model and stated != model:
        remarks.append(
            f"its packets say {product_text(product)}, but they come every {1e3 * interval_s:.3f} "
            f"ms as those of a {model}: taken for a {model}"
        )
    elif not model:
        remarks.append(f"unknown product byte {product:#04x}; give a rig that names the model")
    return model or "", tuple(remarks)


def _with_utc(stream: PacketStream, offset_ns: int | None) -> PacketStream:
    if stream.kind != "data" or offset_ns is None:
        return stream
    return replace(stream, utc_offset_ns=offset_ns)
