"""MCAP files: the summary at the end of the file, or a scan of all records without it."""

from __future__ import annotations

import io
import struct
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, TypeVar

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.formats.bag_clock import chunks_going_on, say_steps
from recon4.recording.formats.chunks import (
    MAX_TIME_NS,
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
    MAX_TOPICS,
    RecordFile,
    clean_name,
    definition_text,
)
from recon4.recording.report import ImportReport

MAGIC = b"\x89MCAP0\r\n"
_ROS = ("ros1msg", "ros2msg")
"""Encodings of definitions in ROS's language."""
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK = 2, 3, 4, 5, 6
_CHUNK_INDEX, _STATISTICS = 8, 11
_RECORD = struct.Struct("<BQ")
_MESSAGE_HEAD = struct.Struct("<HIQQ")
_CHUNK_HEAD = struct.Struct("<QQQI")
_FOOTER_BYTES = _RECORD.size + 20 + len(MAGIC)
_MAX_SUMMARY_BYTES = 64 << 20
_RUN_BYTES = 8 << 20
"""Messages outside of chunks are read in runs of at most this size."""

_T = TypeVar("_T")


class Mcap:
    """One MCAP file that is open."""

    ros1 = False

    def __init__(self, file: RecordFile, report: ImportReport) -> None:
        """Read the summary.

        Raises:
            CorruptFile: If it is damaged or not complete, see `scan`.
        """
        self._file, self.report = file, report
        self.index = _summary(file)

    @classmethod
    def scan(cls, file: RecordFile, report: ImportReport) -> tuple[Mcap, bool]:
        """Read a file without a complete summary, record by record; and whether it is whole."""
        mcap = cls.__new__(cls)
        mcap._file, mcap.report = file, report
        topics = _Topics()
        file.restart_budget()
        found, whole = _found_chunks(file, topics)
        chunks = survey(found, lambda chunk: _load(file, chunk, topics))
        whole = whole and len(chunks) == len(found)
        for chunk in chunks:
            for number, count in chunk.counts.items():
                if number in topics.channels:
                    topics.channels[number].msgcount += count
        mcap.index = BagIndex.of_chunks(topics.channels, chunks)
        return mcap, whole

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
        known = _Topics()
        known.channels = self.index.topics
        return _load(self._file, chunk, known)


class _Topics:
    """Schemas and channels found so far."""

    def __init__(self) -> None:
        self.types: dict[int, str] = {}
        self.definitions: dict[int, str] = {}
        self.channels: dict[int, Topic] = {}

    def add(self, op: int, body: bytes, where: str) -> None:
        """Add a schema or a channel."""
        from mcap.data_stream import ReadDataStream
        from mcap.records import Channel, Schema

        def read(kind: Any) -> Any:
            return kind.read(ReadDataStream(io.BytesIO(body)))

        if op == _SCHEMA:
            schema = _parsed(lambda: read(Schema), where)
            self.types[schema.id] = clean_name(schema.name)
            if schema.encoding in _ROS:
                self.definitions[schema.id] = definition_text(schema.data)
        elif op == _CHANNEL and len(self.channels) < MAX_TOPICS:
            channel = _parsed(lambda: read(Channel), where)
            kind = self.types.get(channel.schema_id, "")
            text = self.definitions.get(channel.schema_id, "")
            topic = Topic(clean_name(channel.topic), kind, definition=text)
            self.channels.setdefault(channel.id, topic)


def _parsed(read: Callable[[], _T], where: str) -> _T:
    """Decode the bytes of a record with the library.

    Raises:
        CorruptFile: If it cannot be read.
    """
    try:
        return read()
    except Exception as error:  # EndOfFile, struct.error, UnicodeDecodeError, MemoryError …
        raise CorruptFile(
            CodedText("mcap-record-unreadable", where=where, why=repr(error))
        ) from error


# -- summary


def _summary(file: RecordFile) -> BagIndex:
    start = _start_of_summary(file)
    file.seek(start)
    body = io.BytesIO(file.take(file.size - _FOOTER_BYTES - start, "summary"))
    topics = _Topics()
    chunks: list[ChunkRef] = []
    counts: dict[int, int] | None = None
    where = f"{file.name}: summary at byte {start}"
    while head := body.read(_RECORD.size):
        op, record = _summary_record(head, body, where)
        if op in {_SCHEMA, _CHANNEL}:
            topics.add(op, record, where)
        elif op == _CHUNK_INDEX:
            chunks.append(_parsed(partial(_chunk_index, record), where))
        elif op == _STATISTICS:
            counts = _parsed(partial(_channel_counts, record), where)
    if counts is None or not chunks or not topics.types:
        raise CorruptFile(CodedText("mcap-summary", where=where))
    require_apart(chunks, file.name, start)
    found = [_checked(file, chunk, start) for chunk in chunks]
    require_apart(found, file.name, start)
    _require_counts(topics, counts, where)
    return BagIndex.of_chunks(topics.channels, found)


def _require_counts(topics: _Topics, counts: dict[int, int], where: str) -> None:
    for number, count in counts.items():
        if number not in topics.channels:
            raise CorruptFile(CodedText("mcap-channel", where=where, number=number))
        topics.channels[number].msgcount = count


def _start_of_summary(file: RecordFile) -> int:
    """Offset of the summary, from the footer."""
    file.seek(0)
    magic = file.take(min(len(MAGIC), file.left), "magic")
    if magic != MAGIC:
        raise CorruptFile(
            CodedText("bag-magic", file=file.name, expected=repr(MAGIC), got=repr(magic))
        )
    file.seek(max(0, file.size - _FOOTER_BYTES))
    footer_at = file.at
    footer = file.take(file.left, "footer")
    op, length = _RECORD.unpack_from(footer.ljust(_RECORD.size))
    if len(footer) < _FOOTER_BYTES or footer[-8:] != MAGIC or (op, length) != (_FOOTER, 20):
        raise CorruptFile(CodedText("mcap-footer", file=file.name, footer_at=footer_at))
    start = int.from_bytes(footer[_RECORD.size : _RECORD.size + 8], "little")
    if not len(MAGIC) < start <= footer_at or footer_at - start > _MAX_SUMMARY_BYTES:
        raise CorruptFile(
            CodedText(
                "mcap-summary-place",
                file=file.name,
                max_summary_bytes=_MAX_SUMMARY_BYTES,
                footer_at=footer_at,
                start=start,
            )
        )
    return start


def _summary_record(head: bytes, body: io.BytesIO, where: str) -> tuple[int, bytes]:
    if len(head) < _RECORD.size:
        raise CorruptFile(CodedText("mcap-record-ends", where=where))
    op, length = _RECORD.unpack(head)
    left = len(body.getbuffer()) - body.tell()
    if length > left:
        raise CorruptFile(CodedText("mcap-record-long", where=where, left=left, length=str(length)))
    return op, body.read(length)


def _chunk_index(record: bytes) -> ChunkRef:
    """A chunk as the summary describes it: offset and length are those of the whole record."""
    t_first, t_last, offset, length = struct.unpack_from("<QQQQ", record)
    (offsets,) = struct.unpack_from("<I", record, 32)
    at = 36 + offsets
    numbers = [number for number, _ in struct.iter_unpack("<HQ", record[36:at])]
    (name,) = struct.unpack_from("<I", record, at + 8)
    compression = record[at + 12 : at + 12 + name].decode("latin1")
    _, size = struct.unpack_from("<QQ", record, at + 12 + name)
    known = frozenset(numbers) if numbers else None
    return ChunkRef(offset, length, size, compression, t_first, t_last, {}, known)


def _channel_counts(record: bytes) -> dict[int, int]:
    (length,) = struct.unpack_from("<I", record, 42)
    return dict(struct.iter_unpack("<HQ", record[46 : 46 + length]))


def _checked(file: RecordFile, listed: ChunkRef, end: int) -> ChunkRef:
    """The chunk at the place that the summary lists, by its own header."""
    file.seek(listed.offset)
    op, length = _RECORD.unpack(file.take(_RECORD.size, "chunk"))
    if op != _CHUNK or listed.length != _RECORD.size + length:
        raise CorruptFile(
            CodedText(
                "mcap-chunk-place",
                file=file.name,
                length=listed.length,
                offset=listed.offset,
                op=str(op),
                got=str(length),
            )
        )
    found = _chunk_head(file, length)
    if (found.t_first_ns, found.size) != (listed.t_first_ns, listed.size):
        raise CorruptFile(
            CodedText(
                "mcap-chunk-differs",
                file=file.name,
                offset=listed.offset,
                size=listed.size,
                t_first_ns=listed.t_first_ns,
                got_size=found.size,
                got_first_ns=found.t_first_ns,
            )
        )
    if found.t_last_ns > MAX_TIME_NS or found.offset > end:
        raise CorruptFile(CodedText("mcap-chunk-times", file=file.name, offset=listed.offset))
    return ChunkRef(
        found.offset,
        found.length,
        found.size,
        found.compression,
        found.t_first_ns,
        found.t_last_ns,
        {},
        listed.connections,
        found.crc,
    )


def _chunk_head(file: RecordFile, length: int) -> ChunkRef:
    """Header of a chunk record whose body starts here; the file may end before the body does."""
    end = file.at + length
    t_first, t_last, size, crc = _CHUNK_HEAD.unpack(file.take(_CHUNK_HEAD.size, "chunk header"))
    name = file.take(file.uint(4, "compression"), "compression", most=32).decode("latin1")
    data = file.uint(8, "chunk")
    if file.at + data != end:
        raise CorruptFile(
            CodedText("mcap-chunk-size", file=file.name, at=file.at, end=end - file.at, data=data)
        )
    here = min(data, file.left)
    return ChunkRef(file.at, here, size, name, t_first, t_last, crc=crc, partial=here < data)


# -- without a summary


def _found_chunks(file: RecordFile, topics: _Topics) -> tuple[list[ChunkRef], bool]:
    """Chunks and runs of messages up to the footer or the damage; whether the footer is there."""
    found: list[ChunkRef] = []
    file.seek(min(len(MAGIC), file.size))
    try:
        while file.left:
            at = file.at
            op, length = _RECORD.unpack(file.take(_RECORD.size, "record"))
            end = file.at + length
            if op == _FOOTER:
                return found, end + len(MAGIC) == file.size
            if op == _CHUNK:
                found.append(_chunk_head(file, length))
            elif op in {_SCHEMA, _CHANNEL}:
                topics.add(op, file.take(length, "record"), f"{file.name}: record at byte {at}")
            elif op == _MESSAGE:
                _extend_run(found, at, end, file=file)
            elif not op:
                break  # an opcode of 0 is not allowed: holes of a sparse file
            if end > file.size:
                break
            file.seek(end)
    except CorruptFile:
        pass
    return found, False


def _extend_run(found: list[ChunkRef], at: int, end: int, *, file: RecordFile) -> None:
    """Add a message outside of a chunk to the run before it, or begin a new one."""
    if end > file.size:
        return
    last = found[-1] if found else None
    follows = last is not None and last.compression == _RUN and last.offset + last.length == at
    if last is not None and follows and end - last.offset <= _RUN_BYTES:
        size = end - last.offset
        found[-1] = ChunkRef(last.offset, size, size, _RUN, 0, 0)
        return
    found.append(ChunkRef(at, end - at, end - at, _RUN, 0, 0))


_RUN = "none"
"""Compression of a run of records; that of a chunk is empty, lz4 or zstd."""

# -- chunks


def _load(file: RecordFile, chunk: ChunkRef, topics: _Topics) -> ChunkMessages:
    return load_chunk(file, chunk, partial(_read_records, topics))


def _read_records(topics: _Topics, messages: ChunkMessages, where: str) -> int:
    """Add the messages of a chunk; returns the end of the last complete record."""
    raw, at = messages.data, 0
    while at + _RECORD.size <= len(raw):
        op, length = _RECORD.unpack_from(raw, at)
        start, stop = at + _RECORD.size, at + _RECORD.size + length
        if stop > len(raw):
            break
        if op == _MESSAGE:
            _add_message(messages, start, stop)
        elif op in {_SCHEMA, _CHANNEL}:
            topics.add(op, raw[start:stop], where)
        at = stop
    return at


def _add_message(messages: ChunkMessages, start: int, stop: int) -> None:
    if not _MESSAGE_HEAD.size <= stop - start <= MAX_MESSAGE_BYTES:
        messages.rejected += 1
        return
    number, _, t_ns, _ = _MESSAGE_HEAD.unpack_from(messages.data, start)
    if t_ns > MAX_TIME_NS:
        messages.rejected += 1
        return
    messages.add(t_ns, number, start=start + _MESSAGE_HEAD.size, stop=stop)
