"""UDP datagrams of a capture file, streamed in batches; a truncated file is read to its end."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import SEEK_CUR
from itertools import islice
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.locales.coded import CodedText
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.formats.ip_fragments import Fragment, IpFragments, JoinedDatagram
from recon4.recording.formats.pcapng import CLASSIC, MAX_PACKET_BYTES, Packet, read_packets
from recon4.recording.formats.pcapng import MAGIC as PCAPNG
from recon4.recording.formats.unread_records import UnreadRecords
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS

_ETHERTYPE_AT = {1: 12, 113: 14, 276: 0}
"""Link type (Ethernet, Linux cooked 1 and 2) -> offset of the ethertype in a packet."""
_IP_AT = {1: 14, 113: 16, 276: 20, 101: 0, 12: 0, 14: 0, 228: 0, 0: 4, 108: 4}
"""Link type -> offset of the IP header; a link type without ethertype carries IP only. Raw IP is
101, and 12 or 14 as some systems write it."""
_TAGS = (0x8100, 0x88A8, 0x9100)
"""Ethertypes of VLAN tags: IEEE 802.1Q, 802.1ad, and that of older switches."""
_LINK_TYPES = np.array(sorted(_IP_AT))
_IP_STARTS = np.array([_IP_AT[link] for link in sorted(_IP_AT)])
_ETHERTYPES = np.array([_ETHERTYPE_AT.get(link, -1) for link in sorted(_IP_AT)])
"""The two tables as columns; -1 = no ethertype."""
_RECORD_HEADER = 16
_CHUNK = 4 << 20


@dataclass(frozen=True, slots=True, eq=False)
class _Records:
    """Captured packets as they lie in a buffer."""

    t_ns: Times
    start: NDArray[np.int64]
    length: NDArray[np.int64]
    buffer: NDArray[np.uint8]
    link_type: NDArray[np.int64]
    """Of the interface of each, (N,)."""


OpenFile = Callable[[Path], IO[bytes]]
"""Opens a file for reading bytes; its ``read(n)`` may give fewer, and none only at the end."""


def open_plain(path: Path) -> IO[bytes]:
    """Open a finished file."""
    return path.open("rb")


def read_pcap(
    path: Path, report: ImportReport, open_file: OpenFile = open_plain
) -> Iterator[Datagrams]:
    """Stream the UDP datagrams of a pcap (µs or ns, either byte order) or pcapng file.

    Datagrams in several IP fragments are joined. Counts ``records`` and, of them, those that are no
    datagrams for us: ``records_not_udp``, ``records_fragment`` (an IP fragment whose others are
    missing), ``records_cut`` (longer than what was captured), with
    ports, sizes and protocols as details of the counts. A file that ends inside a record yields all
    before it, and ``report.outcome`` becomes ``lossy``. Captures that follow the first one in the
    file are read, too (``captures_joined``).

    Raises:
        UnknownFormat: If the file is not a capture of Ethernet, Linux cooked or raw IP packets.
        EmptyRecording: If it holds no packet at all.
    """
    found, damaged, unread = 0, report.counts["files_cut"], UnreadRecords(report)
    untimed = report.counts["records_without_time"]
    fragments = IpFragments()
    with open_file(path) as file:
        for records in _records(file, path.name, report):
            found += len(records.t_ns)
            report.count("records", len(records.t_ns))
            yield _datagrams(records, unread, fragments)
            unread.add_fragments(fragments.lost())
        fragments.end()
        unread.add_fragments(fragments.lost())
    if not found:
        why = f" ({report.said()[-1]})" if report.counts["files_cut"] > damaged else ""
        if untimed := report.counts["records_without_time"] - untimed:
            why += f" that has a time; {untimed} have none (simple packet blocks)"
        raise EmptyRecording(CodedText("pcap-no-packet", file=path.name, why=why))


def is_pcap(path: Path) -> bool:
    """Whether the first bytes are those of a pcap or pcapng file."""
    with path.open("rb") as file:
        magic = file.read(4)
    return magic in CLASSIC or magic == PCAPNG


def _records(file: IO[bytes], name: str, report: ImportReport) -> Iterator[_Records]:
    """The records of a capture, and of those that follow it in the file, as ``cat`` joins them."""
    damaged = report.counts["files_cut"]
    magic = file.read(4)
    if not magic:
        raise EmptyRecording(CodedText("file-empty", name=name))
    yield from _capture(file, name, magic, report=report)
    while report.counts["files_cut"] == damaged and (magic := file.read(4)):
        report.count("captures_joined")
        where = f"{name}, capture at byte {file.tell() - len(magic)}"
        try:
            yield from _capture(file, where, magic, report=report)
        except (EmptyRecording, UnknownFormat) as error:
            _salvaged(report, name, error=error)


def _capture(
    file: IO[bytes], name: str, magic: bytes, *, report: ImportReport
) -> Iterator[_Records]:
    """The records of one capture, whose first four bytes were read."""
    if magic == PCAPNG:
        file.seek(-len(magic), SEEK_CUR)
        yield from _next_generation(file, name, report)
    elif magic in CLASSIC:
        yield from _classic(file, name, CLASSIC[magic], report=report)
    else:
        raise UnknownFormat(CodedText("pcap-magic", name=name, magic=magic.hex(" ")))


def _classic(
    file: IO[bytes], name: str, kind: tuple[str, int], *, report: ImportReport
) -> Iterator[_Records]:
    order, unit_ns = kind
    header = file.read(20)
    if len(header) < 20:
        raise EmptyRecording(CodedText("pcap-header-cut", name=name))
    # Above the 16 bits: how long the checksums of frames are.
    link_type = struct.unpack(f"{order}I", header[16:])[0] & 0xFFFF
    _require_link_type(link_type, name)
    rest, at = b"", file.tell()
    while chunk := file.read(_CHUNK):
        data = rest + chunk
        stamps, end, broken = _walk(data, order)
        if stamps:
            yield _batch(stamps, data, unit_ns, link_type=link_type)
        rest, at = data[end:], at + end
        if broken and (rest[:4] in CLASSIC or rest[:4] == PCAPNG):
            file.seek(-len(rest), SEEK_CUR)
            return
        if broken:
            captured = struct.unpack_from(f"{order}I", rest, 8)[0]
            _salvaged(report, name, at=at, most=MAX_PACKET_BYTES, captured=captured)
            return
    if rest:
        _salvaged(report, name, dropped=len(rest))


def _walk(data: bytes, order: str) -> tuple[list[tuple[int, int, int, int]], int, bool]:
    """Whole records in ``data``: (seconds, fraction, captured length, start), end, broken."""
    unpack = struct.Struct(f"{order}III").unpack_from
    rows: list[tuple[int, int, int, int]] = []
    at, size = 0, len(data)
    while at + _RECORD_HEADER <= size:
        seconds, fraction, captured = unpack(data, at)
        if not 0 < captured <= MAX_PACKET_BYTES:  # 0: holes of a sparse file
            return rows, at, True
        start = at + _RECORD_HEADER
        if start + captured > size:
            break
        rows.append((seconds, fraction, captured, start))
        at = start + captured
    return rows, at, False


def _batch(
    rows: list[tuple[int, int, int, int]], data: bytes, unit_ns: int, *, link_type: int
) -> _Records:
    seconds, fraction, length, start = np.array(rows, dtype=np.int64).T
    t_ns = seconds * 1_000_000_000 + fraction * unit_ns
    return _Records(
        t_ns, start, length, np.frombuffer(data, np.uint8), np.full(len(rows), link_type)
    )


def _next_generation(file: IO[bytes], name: str, report: ImportReport) -> Iterator[_Records]:
    packets = _until_damaged(read_packets(file, report.count), name, report)
    others = set[int]()
    supported = False
    while batch := list(islice(packets, 2048)):
        others |= {packet.link_type for packet in batch if packet.link_type not in _IP_AT}
        supported = supported or any(packet.link_type in _IP_AT for packet in batch)
        yield _joined(_in_time(batch))
    if others and not supported:  # one interface may be silent before the others
        _require_link_type(min(others), name)


def _in_time(packets: list[Packet]) -> list[Packet]:
    """Packets in order of time: several interfaces are written in bursts, each in its order."""
    times = np.array([packet.t_ns for packet in packets], dtype=np.int64)
    behind = int(np.max(np.maximum.accumulate(times) - times))
    if not 0 < behind < 2 * SECOND_NS:  # beyond it, a clock was set back
        return packets
    return [packets[row] for row in np.argsort(times, kind="stable")]


def _until_damaged(packets: Iterator[Packet], name: str, report: ImportReport) -> Iterator[Packet]:
    try:
        yield from packets
    except CorruptFile as error:
        _salvaged(report, name, error=error)


def _joined(packets: list[Packet]) -> _Records:
    length = np.array([len(packet.data) for packet in packets], dtype=np.int64)
    t_ns = np.array([packet.t_ns for packet in packets], dtype=np.int64)
    link_type = np.array([packet.link_type for packet in packets], dtype=np.int64)
    buffer = np.frombuffer(b"".join(packet.data for packet in packets), np.uint8)
    return _Records(t_ns, np.cumsum(length) - length, length, buffer, link_type)


def _require_link_type(link_type: int, name: str) -> None:
    if link_type not in _IP_AT:
        raise UnknownFormat(CodedText("pcap-link-type", name=name, link_type=link_type))


def _salvaged(report: ImportReport, name: str, **where: Value | Exception) -> None:
    report.outcome = "lossy"
    report.count("files_cut")
    report.warn(FindingKind.CAPTURE_SALVAGED, name=name, **where)


def _datagrams(records: _Records, unread: UnreadRecords, fragments: IpFragments) -> Datagrams:
    """The UDP datagrams among the records, whole ones and joined ones; the others are counted."""
    at, ethertype = _ip_header(records)
    end = records.start + records.length
    headed = (ethertype == 0x0800) & (at + 20 <= end) & (_byte(records, at) >> 4 == 4)
    protocol = np.where(headed, _byte(records, at + 9), -1)
    is_udp = protocol == 17
    fits = is_udp & (at + 28 <= end)
    whole = (_word(records, at + 6) & 0x3FFF) == 0
    udp = at + 4 * (_byte(records, at) & 15)
    stated = _word(records, udp + 4)
    # 0: left to the network card, which had not yet filled it in; the IP header has it.
    length = np.where(stated, stated, _ip_end(records, at) - udp) - 8
    inside = fits & (length >= 0) & (udp + 8 + length <= end)
    unread.add_others(ethertype[~is_udp], protocol[~is_udp])
    cut = is_udp & whole & ~inside
    port = np.where(fits, _word(records, udp + 2), -1)
    unread.add_cut(port[cut], records.length[cut])
    kept = np.flatnonzero(is_udp & whole & inside)
    plain = Datagrams(
        t_ns=records.t_ns[kept],
        source=_long(records, at[kept] + 12).astype(np.uint32),
        port=port[kept].astype(np.uint16),
        length=length[kept],
        start=udp[kept] + 8,
        buffer=records.buffer,
    )
    rows = np.flatnonzero(is_udp & ~whole)
    parts = zip(rows.tolist(), _fragments(records, rows, at), strict=True)
    joined = [(row, one) for row, part in parts for one in fragments.push(part)]
    return _with_joined(plain, kept, joined) if joined else plain


def _fragments(
    records: _Records, rows: NDArray[np.intp], at: NDArray[np.int64]
) -> Iterator[Fragment]:
    """The IP fragments in some rows."""
    here = at[rows]
    word = _word(records, here + 6)
    columns = (
        records.t_ns[rows],
        _long(records, here + 12),
        _long(records, here + 16),
        _word(records, here + 4),
        8 * (word & 0x1FFF),
        (word & 0x2000) == 0,
        here + 4 * (_byte(records, here) & 15),
        _ip_end(records, at)[rows],
    )
    fields = (column.tolist() for column in columns)
    for t_ns, source, destination, number, offset, is_last, first, end in zip(*fields, strict=True):
        yield Fragment(
            t_ns=t_ns,
            source=source,
            destination=destination,
            number=number,
            offset=offset,
            is_last=is_last,
            data=records.buffer[first:end].tobytes(),
        )


def _ip_end(records: _Records, at: NDArray[np.int64]) -> NDArray[np.int64]:
    """Where the IP packets end: as their headers say (0 = not known), or with the record."""
    stated, end = _word(records, at + 2), records.start + records.length
    return np.where(stated, np.minimum(at + stated, end), end)


def _with_joined(
    plain: Datagrams, kept: NDArray[np.intp], joined: list[tuple[int, JoinedDatagram]]
) -> Datagrams:
    """Joined datagrams among the others, each at the place of the fragment that completed it."""
    sizes = np.array([len(one.payload) for _, one in joined], np.int64)
    starts = len(plain.buffer) + np.cumsum(sizes) - sizes
    data = np.frombuffer(b"".join(one.payload for _, one in joined), np.uint8)
    more = Datagrams(
        t_ns=np.array([one.t_ns for _, one in joined], np.int64),
        source=np.array([one.source for _, one in joined], np.uint32),
        port=np.array([one.port for _, one in joined], np.uint16),
        length=sizes,
        start=starts,
        buffer=data,
    )
    order = np.argsort(np.concatenate([kept, [row for row, _ in joined]]), kind="stable")
    columns = {
        name: np.concatenate([getattr(plain, name), getattr(more, name)])[order]
        for name in ("t_ns", "source", "port", "length", "start")
    }
    return Datagrams(**columns, buffer=np.concatenate([plain.buffer, data]))


def _ip_header(records: _Records) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Offset of the IP header of each record, and its ethertype; -1 = unknown link type."""
    kind = np.minimum(np.searchsorted(_LINK_TYPES, records.link_type), len(_LINK_TYPES) - 1)
    known = _LINK_TYPES[kind] == records.link_type
    at = records.start + _IP_STARTS[kind]
    plain = _ETHERTYPES[kind] < 0
    by_version = np.where(_byte(records, at) >> 4 == 6, 0x86DD, 0x0800)
    ethertype = np.where(plain, by_version, _word(records, records.start + _ETHERTYPES[kind]))
    for _ in _TAGS:  # as many behind each other, at most
        tagged = ~plain & np.isin(ethertype, _TAGS)
        ethertype = np.where(tagged, _word(records, at + 2), ethertype)
        at = at + 4 * tagged
    return at, np.where(known, ethertype, -1)


def _byte(records: _Records, at: NDArray[np.int64]) -> NDArray[np.int64]:
    return records.buffer[np.clip(at, 0, len(records.buffer) - 1)].astype(np.int64)


def _word(records: _Records, at: NDArray[np.int64]) -> NDArray[np.int64]:
    return (_byte(records, at) << 8) | _byte(records, at + 1)


def _long(records: _Records, at: NDArray[np.int64]) -> NDArray[np.int64]:
    return (_word(records, at) << 16) | _word(records, at + 2)
