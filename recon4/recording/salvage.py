"""What is left of a bag that was cut off or damaged: read from the front, up to the damage.

The stock readers need the index at the end of a file and give nothing without it.
"""

from __future__ import annotations

import bz2
import shutil
import sqlite3
import struct
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from recon4.errors import CorruptFile
from recon4.recording.report import ImportReport

Row = tuple[str, str, int, bytes]
"""Topic, type, time [ns], bytes."""

_LARGEST = 1 << 30
"""A record that claims to be larger is damage."""
_BAG1_MAGIC = b"#ROSBAG V2.0\n"
_CONNECTION, _MESSAGE, _CHUNK = 7, 2, 5


@dataclass(slots=True)
class SalvagedTopic:
    """A topic as far as it was found; spelled like a connection of rosbags."""

    topic: str
    msgtype: str
    msgcount: int = 0


@dataclass(slots=True)
class Salvage:
    """A damaged bag that can still be streamed; use as a context manager."""

    path: Path
    ros1: bool
    scan: Callable[[], Iterator[Row]]
    connections: list[SalvagedTopic] = field(default_factory=list)
    message_count: int = 0
    start_time: int = 2**63 - 1
    end_time: int = 0
    stack: ExitStack = field(default_factory=ExitStack)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        self.stack.close()

    def messages(self, topics: set[str]) -> Iterator[Row]:
        """Messages of some topics in the order of the file."""
        return (row for row in self.scan() if row[0] in topics)

    def survey(self) -> None:
        """Go through the file once: topics, counts and times."""
        found: dict[str, SalvagedTopic] = {}
        for topic, kind, t_ns, _ in self.scan():
            found.setdefault(topic, SalvagedTopic(topic, kind)).msgcount += 1
            self.message_count += 1
            self.start_time = min(self.start_time, t_ns)
            self.end_time = max(self.end_time, t_ns + 1)
        self.connections = list(found.values())


def open_salvage(path: Path, report: ImportReport) -> Salvage:
    """Find out what is left of a damaged bag.

    Raises:
        CorruptFile: If nothing is left.
    """
    with path.open("rb") as file:
        head = file.read(16)
    stack = ExitStack()
    try:
        salvage = Salvage(path, head.startswith(b"#ROSBAG"), _scanner(path, head, stack))
        salvage.stack = stack
        salvage.survey()
        if not salvage.message_count:
            report.outcome = "nothing"
            raise CorruptFile(f"{path.name}: damaged or cut off, not one message is left")
    except BaseException:
        stack.close()
        raise
    report.outcome = "lossy"
    report.count("files_cut")
    report.count("messages_salvaged", salvage.message_count)
    report.warn(f"{path.name}: cut off or damaged; {salvage.message_count} messages were salvaged")
    return salvage


def _scanner(path: Path, head: bytes, stack: ExitStack) -> Callable[[], Iterator[Row]]:
    if head.startswith(b"#ROSBAG"):
        return lambda: _scan_bag1(path)
    if head.startswith(b"\x89MCAP"):
        return lambda: _scan_mcap(path)
    if head.startswith(b"SQLite format 3"):
        copy = _patched_copy(path, Path(stack.enter_context(tempfile.TemporaryDirectory())))
        return lambda: _scan_sqlite(copy)
    raise CorruptFile(f"{path.name}: not a bag: it starts with {head[:8].hex(' ')}")


# -- rosbag1


def _scan_bag1(path: Path) -> Iterator[Row]:
    topics: dict[int, tuple[str, str]] = {}
    with path.open("rb") as file:
        file.seek(len(_BAG1_MAGIC))
        for header, data in _records(file):
            if _op(header) != _CHUNK:
                continue
            yield from _scan_chunk(_unpacked(header, data), topics)


def _scan_chunk(chunk: bytes, topics: dict[int, tuple[str, str]]) -> Iterator[Row]:
    at = 0
    while (record := _record_at(chunk, at)) is not None:
        header, data, at = record
        number = int.from_bytes(header.get(b"conn", b""), "little")
        if _op(header) == _CONNECTION:
            about = _fields(data) or {}
            kind = about.get(b"type", b"").decode("latin1").replace("/", "/msg/", 1)
            topics[number] = (header.get(b"topic", b"").decode("latin1"), kind)
        elif _op(header) == _MESSAGE and number in topics and len(header.get(b"time", b"")) == 8:
            seconds, nanoseconds = struct.unpack("<II", header[b"time"])
            yield *topics[number], seconds * 1_000_000_000 + nanoseconds, data


def _records(file: IO[bytes]) -> Iterator[tuple[dict[bytes, bytes], bytes]]:
    """Header and data of the records one after the other; the last may be cut short."""
    while True:
        header = _fields(_sized(file, whole=True))
        if header is None:
            return
        data = _sized(file, whole=_op(header) != _CHUNK)
        if data is None:
            return
        yield header, data


def _sized(file: IO[bytes], *, whole: bool) -> bytes | None:
    size = file.read(4)
    if len(size) < 4 or (length := int.from_bytes(size, "little")) > _LARGEST:
        return None
    data = file.read(length)
    return None if whole and len(data) < length else data


def _record_at(chunk: bytes, at: int) -> tuple[dict[bytes, bytes], bytes, int] | None:
    parts = []
    for _ in range(2):
        length = int.from_bytes(chunk[at : at + 4], "little")
        start, at = at + 4, at + 4 + length
        if start > len(chunk) or at > len(chunk):
            return None
        parts.append(chunk[start:at])
    header = _fields(parts[0])
    return None if header is None else (header, parts[1], at)


def _fields(data: bytes | None) -> dict[bytes, bytes] | None:
    """Fields ``name=value`` of a record header, each with its length in front."""
    if data is None:
        return None
    found: dict[bytes, bytes] = {}
    at = 0
    while at < len(data):
        length = int.from_bytes(data[at : at + 4], "little")
        name, sign, value = data[at + 4 : at + 4 + length].partition(b"=")
        if not sign or at + 4 + length > len(data):
            return None
        found[name] = value
        at += 4 + length
    return found


def _op(header: dict[bytes, bytes]) -> int:
    return int.from_bytes(header.get(b"op", b"\0"), "little")


def _unpacked(header: dict[bytes, bytes], data: bytes) -> bytes:
    """A chunk's bytes, as many as can be had when it is cut short."""
    how = header.get(b"compression", b"none")
    try:
        if how == b"bz2":
            return bz2.BZ2Decompressor().decompress(data)
        if how == b"lz4":
            import lz4.frame

            return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data))
    except (OSError, ValueError, RuntimeError, EOFError):
        return b""
    return data


# -- mcap


def _scan_mcap(path: Path) -> Iterator[Row]:
    from mcap.records import Channel, Message, Schema
    from mcap.stream_reader import StreamReader

    types: dict[int, str] = {}
    topics: dict[int, tuple[str, str]] = {}
    with path.open("rb") as file:
        records = StreamReader(file, record_size_limit=_LARGEST).records
        for record in _until_damage(records):
            if isinstance(record, Schema):
                types[record.id] = record.name
            elif isinstance(record, Channel):
                topics[record.id] = (record.topic, types.get(record.schema_id, ""))
            elif isinstance(record, Message) and record.channel_id in topics:
                yield *topics[record.channel_id], record.log_time, record.data


# -- rosbag2 in SQLite


def _patched_copy(path: Path, folder: Path) -> Path:
    """A copy whose header says as many pages as there are: SQLite refuses the file otherwise."""
    copy = folder / path.name
    shutil.copyfile(path, copy)
    copy.chmod(0o600)
    with copy.open("r+b") as file:
        file.seek(16)
        page = int.from_bytes(file.read(2), "big")
        page = 65536 if page == 1 else page
        pages = path.stat().st_size // page if page >= 512 else 0
        if not pages:
            raise CorruptFile(f"{path.name}: not even one page of the database is left")
        file.truncate(pages * page)
        file.seek(28)
        file.write(pages.to_bytes(4, "big"))
    return copy


def _scan_sqlite(path: Path) -> Iterator[Row]:
    with closing(sqlite3.connect(f"{path.as_uri()}?mode=ro&immutable=1", uri=True)) as database:
        try:
            topics = {
                int(row[0]): (str(row[1]), str(row[2]))
                for row in database.execute("SELECT id, name, type FROM topics")
            }
            rows = database.execute("SELECT topic_id, timestamp, data FROM messages")
        except sqlite3.Error:
            return
        for number, t_ns, data in _until_damage(rows):
            if number in topics and isinstance(data, bytes):
                yield *topics[number], int(t_ns), data


def _until_damage(items: Any) -> Iterator[Any]:
    """Items up to the first one that cannot be read: what kind of error is of no interest."""
    iterator = iter(items)
    while True:
        try:
            item = next(iterator)
        except Exception:  # libraries raise many kinds on damaged bytes
            return
        yield item
