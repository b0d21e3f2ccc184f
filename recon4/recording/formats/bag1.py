"""rosbag1 files: the index at the end of the file, or a scan of all chunks without it."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.formats.bag_clock import chunks_going_on, say_steps
from recon4.recording.formats.chunks import (
    BagIndex,
    ChunkMessages,
    ChunkRef,
    ChunkStream,
    RawMessage,
    Topic,
    load_chunk,
    require_apart,
    survey,
)
from recon4.recording.formats.limits import (
    MAX_MESSAGE_BYTES,
    MAX_RECORD_HEADER_BYTES,
    MAX_TOPICS,
    RecordFile,
    clean_name,
    definition_text,
)
from recon4.recording.report import ImportReport

_MAGIC = b"#ROSBAG V2.0\n"
_MESSAGE, _HEADER, _CHUNK, _CHUNK_INFO, _CONNECTION = 2, 3, 5, 6, 7
_CHUNK_INFO_BYTES = 60
"""The shortest chunk info record."""

Fields = dict[bytes, bytes]


class Bag1:
    """One rosbag1 file that is open."""

    ros1 = True

    def __init__(self, file: RecordFile, report: ImportReport) -> None:
        """Read the index.

        Raises:
            CorruptFile: If it is damaged, see `scan`.
        """
        self._file, self.report = file, report
        self.index = _indexed(file)

    @classmethod
    def scan(cls, file: RecordFile, report: ImportReport) -> Bag1:
        """Read a file whose index is missing or damaged: chunk by chunk from the front."""
        bag = cls.__new__(cls)
        bag._file, bag.report = file, report
        topics: dict[int, Topic] = {}
        file.restart_budget()
        chunks = survey(_found_chunks(file), lambda chunk: _load(file, chunk, topics))
        _count(topics, chunks)
        bag.index = BagIndex.of_chunks(topics, chunks)
        return bag

    def messages(self, topics: set[str]) -> Iterator[RawMessage]:
        """Messages of some topics in order of time."""
        self._file.restart_budget()
        stream = ChunkStream(self._file.name, self.index, self._read, report=self.report)
        return stream.messages(topics)

    def go_on(self) -> None:
        """Continue the times where the recorder was set back."""
        self._file.restart_budget()
        say = partial(say_steps, self._file.name, report=self.report)
        self.index = chunks_going_on(self.index, self._read, say)

    def _read(self, chunk: ChunkRef) -> ChunkMessages:
        return _load(self._file, chunk, self.index.topics)


def is_bag1(path: Path) -> bool:
    """Whether the first bytes are those of a rosbag."""
    with path.open("rb") as file:
        return file.read(9) == _MAGIC[:9]


# -- index


def _indexed(file: RecordFile) -> BagIndex:
    file.seek(0)
    magic = file.take(min(len(_MAGIC), file.left), "version")
    if magic != _MAGIC:
        raise CorruptFile(
            CodedText("bag-magic", file=file.name, expected=repr(_MAGIC), got=repr(magic))
        )
    header = _header(file, _HEADER)
    index_at = _uint(header, b"index_pos", 8, file=file)
    connections = _uint(header, b"conn_count", 4, file=file)
    chunks = _uint(header, b"chunk_count", 4, file=file)
    if header.get(b"encryptor"):
        raise CorruptFile(CodedText("bag-encrypted", file=file.name))
    if not index_at:
        raise CorruptFile(CodedText("bag-no-index", file=file.name))
    if connections > MAX_TOPICS:
        raise CorruptFile(
            CodedText(
                "bag-topics-many", file=file.name, max_topics=MAX_TOPICS, connections=connections
            )
        )
    file.seek(index_at)
    if chunks > file.left // _CHUNK_INFO_BYTES:
        raise CorruptFile(
            CodedText(
                "bag-chunks-many",
                file=file.name,
                most=file.left // _CHUNK_INFO_BYTES,
                size=file.left,
                chunks=chunks,
            )
        )
    topics = dict(_connection(file) for _ in range(connections))
    infos = [_chunk_info(file) for _ in range(chunks)]
    if len({info.offset for info in infos}) < len(infos):
        raise CorruptFile(CodedText("bag-chunk-twice", file=file.name))
    found = [_chunk_at(file, info, index_at) for info in infos]
    require_apart(found, file.name, index_at)
    _count(topics, found)
    return BagIndex.of_chunks(topics, found)


def _count(topics: dict[int, Topic], chunks: list[ChunkRef]) -> None:
    for chunk in chunks:
        for number, count in chunk.counts.items():
            if number in topics:
                topics[number].msgcount += count


def _connection(file: RecordFile) -> tuple[int, Topic]:
    header = _header(file, _CONNECTION)
    about = _fields(file.take(file.uint(4, "connection"), "connection"))
    if about is None:
        raise CorruptFile(CodedText("bag-connection-empty", file=file.name, at=file.at))
    return _uint(header, b"conn", 4, file=file), _topic(header, about)


def _topic(header: Fields, about: Fields) -> Topic:
    name = clean_name(header.get(b"topic", b""))
    parts = "/".join(part for part in name.split("/") if part)
    kind = clean_name(about.get(b"type", b""))
    return Topic(
        f"/{parts}" if name.startswith("/") else parts,
        kind.replace("/", "/msg/", 1),
        definition=definition_text(about.get(b"message_definition", b"")),
    )


class _Info(NamedTuple):
    """Index entry of a chunk."""

    offset: int
    t_first_ns: int
    t_last_ns: int
    counts: dict[int, int]


def _chunk_info(file: RecordFile) -> _Info:
    header = _header(file, _CHUNK_INFO)
    data = file.take(file.uint(4, "chunk info"), "chunk info")
    if len(data) % 8 or len(data) // 8 != _uint(header, b"count", 4, file=file):
        raise CorruptFile(CodedText("bag-chunk-info-damaged", file=file.name, at=file.at))
    numbers = struct.unpack(f"<{len(data) // 4}I", data)
    counts = dict(zip(numbers[::2], numbers[1::2], strict=True))
    first, last = (_time(header, name, file) for name in (b"start_time", b"end_time"))
    return _Info(_uint(header, b"chunk_pos", 8, file=file), first, last, counts)


def _chunk_at(file: RecordFile, info: _Info, index_at: int) -> ChunkRef:
    file.seek(info.offset)
    header = _header(file, _CHUNK)
    length = file.uint(4, "chunk")
    if length > index_at - file.at:
        raise CorruptFile(
            CodedText(
                "bag-chunk-long",
                file=file.name,
                at=file.at,
                index_at=index_at - file.at,
                length=length,
            )
        )
    return ChunkRef(
        file.at,
        length,
        _uint(header, b"size", 4, file=file),
        _compression(header),
        info.t_first_ns,
        info.t_last_ns,
        info.counts,
        frozenset(info.counts),
    )


# -- without an index


def _found_chunks(file: RecordFile) -> list[ChunkRef]:
    """Chunks one after the other, up to the first invalid record."""
    found: list[ChunkRef] = []
    file.seek(min(len(_MAGIC), file.size))
    while file.left > 8:
        try:
            header = _header(file)
            length = file.uint(4, "record")
        except CorruptFile:
            break
        if _op(header) == _CHUNK:
            here = min(length, file.left)
            size = int.from_bytes(header.get(b"size", b""), "little")
            chunk = ChunkRef(file.at, here, size, _compression(header), 0, 0, partial=here < length)
            found.append(chunk)
        if length > file.left:
            break
        file.seek(file.at + length)
    return found


# -- records


def _load(file: RecordFile, chunk: ChunkRef, topics: dict[int, Topic]) -> ChunkMessages:
    """Read a chunk; connections found in it are added to ``topics``."""

    def read(messages: ChunkMessages, where: str) -> int:
        at = 0
        while (record := _record_at(messages.data, at)) is not None:
            header, start, at = record
            op = _op(header)
            if op == _MESSAGE:
                _add_message(messages, header, start, stop=at)
            elif op == _CONNECTION and len(topics) < MAX_TOPICS:
                number = int.from_bytes(header.get(b"conn", b""), "little")
                about = _fields(messages.data[start:at])
                if number not in topics and about is not None:
                    topics[number] = _topic(header, about)
        return at

    return load_chunk(file, chunk, read)


def _add_message(messages: ChunkMessages, header: Fields, start: int, *, stop: int) -> None:
    conn, time = header.get(b"conn", b""), header.get(b"time", b"")
    if len(conn) != 4 or len(time) != 8 or stop - start > MAX_MESSAGE_BYTES:
        messages.rejected += 1
        return
    seconds, nanoseconds = struct.unpack("<II", time)
    t_ns = seconds * 1_000_000_000 + nanoseconds
    messages.add(t_ns, int.from_bytes(conn, "little"), start=start, stop=stop)


def _record_at(chunk: bytes, at: int) -> tuple[Fields, int, int] | None:
    """Header of the record at an offset of a chunk, start and stop of its data."""
    if at + 8 > len(chunk):
        return None
    start = at + 4 + int.from_bytes(chunk[at : at + 4], "little")
    if start + 4 > len(chunk):
        return None
    header = _fields(chunk[at + 4 : start])
    stop = start + 4 + int.from_bytes(chunk[start : start + 4], "little")
    return None if not header or stop > len(chunk) else (header, start + 4, stop)


def _header(file: RecordFile, op: int | None = None) -> Fields:
    at = file.at
    length = file.uint(4, "record header")
    header = _fields(file.take(length, "record header", most=MAX_RECORD_HEADER_BYTES))
    if not header or (op is not None and _op(header) != op):
        kind = "one that is damaged" if not header else f"one of kind {_op(header)}"
        expected = "a record" if op is None else f"a record of kind {op}"
        raise CorruptFile(
            CodedText("bag-record-kind", file=file.name, expected=expected, at=at, kind=kind)
        )
    return header


def _fields(data: bytes) -> Fields | None:
    """Fields ``name=value`` of a record header, each with its length in front."""
    found: Fields = {}
    at = 0
    while at < len(data):
        length = int.from_bytes(data[at : at + 4], "little")
        name, sign, value = data[at + 4 : at + 4 + length].partition(b"=")
        at += 4 + length
        if not sign or at > len(data):
            return None
        found[name] = value
    return found


def _op(header: Fields) -> int:
    return int.from_bytes(header.get(b"op", b"\0"), "little")


def _compression(header: Fields) -> str:
    return header.get(b"compression", b"none").decode("latin1")


def _uint(header: Fields, name: bytes, size: int, *, file: RecordFile) -> int:
    value = header.get(name, b"")
    if len(value) != size:
        raise CorruptFile(
            CodedText(
                "bag-record-header",
                file=file.name,
                at=file.at,
                size=size,
                name=name.decode(),
                count=len(value),
            )
        )
    return int.from_bytes(value, "little")


def _time(header: Fields, name: bytes, file: RecordFile) -> int:
    both = _uint(header, name, 8, file=file)
    return (both & 0xFFFF_FFFF) * 1_000_000_000 + (both >> 32)
