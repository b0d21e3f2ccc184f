"""Merges the chunks of a bag into one stream of messages by time, with bounded memory.

The index of single messages inside a bag is not used: it may point anywhere and as often as it
likes. Every chunk is decompressed once and its messages are read one after the other.
"""

from __future__ import annotations

import heapq
from array import array
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from zlib import crc32

import numpy as np

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.limits import (
    MAX_CHUNK_BYTES,
    RATIO_FLOOR_BYTES,
    RecordFile,
    decompress,
    decompress_partly,
)
from recon4.recording.report import ImportReport

MAX_OPEN_BYTES = 256 << 20
"""Overlapping chunks open at the same time; beyond it the oldest are finished first."""
MAX_TIME_NS = 2**62
"""Later times count as damage."""
MESSAGE_BYTES = 32
"""Memory of a waiting message in addition to its bytes."""

RawMessage = tuple[str, str, int, bytes]
"""Topic, type, time [ns], bytes."""
Message = tuple[int, int, bytes]
"""Time [ns], connection, bytes."""
_Head = tuple[int, int, Message, Iterator[Message], int]
"""Time of the next message of an open chunk, place of the chunk, the message, those that follow,
bytes that the chunk holds."""


@dataclass(slots=True)
class Topic:
    """A topic of a bag."""

    topic: str
    msgtype: str
    """ROS 2 spelling, as ``sensor_msgs/msg/Imu``."""
    msgcount: int = 0
    definition: str = ""
    """Of the type, in ROS's language; empty = the file has none."""


@dataclass(frozen=True, slots=True)
class RecorderStep:
    """Where the clock of the recorder was set back."""

    offset: int
    """Of the chunk in the file; of a table, the row."""
    first: int
    """Number in the chunk of the first message after it."""
    shift_ns: int
    """What is added to this and all later times, so that they go on [ns]."""
    t_ns: int
    """Its time that goes on [ns]."""


@dataclass(frozen=True, slots=True)
class ChunkRef:
    """Location of a chunk and its index entry."""

    offset: int
    """Offset of its first byte after the header."""
    length: int
    """Bytes in the file."""
    size: int
    """Bytes when decompressed."""
    compression: str
    t_first_ns: int
    t_last_ns: int
    counts: dict[int, int] = field(default_factory=dict)
    """Connection -> number of messages; connections of unknown count are missing."""
    connections: frozenset[int] | None = None
    """Those with messages in it; None = not known, it is read for every topic."""
    crc: int = 0
    """Of the decompressed bytes; 0 = not known."""
    partial: bool = False
    """Whether it is truncated; its existing part is read."""

    def has(self, wanted: set[int]) -> bool:
        """Whether it may contain messages of some connections."""
        return self.connections is None or not wanted.isdisjoint(self.connections)


@dataclass(slots=True)
class ChunkMessages:
    """Offsets of the messages of a decompressed chunk."""

    data: bytes
    t_ns: array[int] = field(default_factory=lambda: array("q"))
    connection: array[int] = field(default_factory=lambda: array("q"))
    start: array[int] = field(default_factory=lambda: array("q"))
    stop: array[int] = field(default_factory=lambda: array("q"))
    rejected: int = 0
    """Number of messages that are too large or have an invalid header."""

    def add(self, t_ns: int, connection: int, *, start: int, stop: int) -> None:
        """Remember a message."""
        self.t_ns.append(t_ns)
        self.connection.append(connection)
        self.start.append(start)
        self.stop.append(stop)

    def go_on(self, offset: int, steps: Sequence[RecorderStep]) -> None:
        """Move the times behind places where the recorder was set back.

        Args:
            offset: Of this chunk.
            steps: In the order of the file.
        """
        times = np.frombuffer(self.t_ns, np.int64)
        for step in steps:
            if offset >= step.offset:
                times[step.first if offset == step.offset else 0 :] += step.shift_ns

    @property
    def bytes_held(self) -> int:
        return len(self.data) + MESSAGE_BYTES * len(self.t_ns)

    def in_order(self, wanted: set[int], mirror_ns: int = 0) -> Iterator[Message]:
        """Time, connection and bytes of the messages of some connections, by time.

        Args:
            wanted: The connections.
            mirror_ns: See `BagIndex`.
        """
        order = np.argsort(np.frombuffer(self.t_ns, np.int64), kind="stable")
        for k in array("q", (order[::-1] if mirror_ns else order).tobytes()):
            if self.connection[k] in wanted:
                data = self.data[self.start[k] : self.stop[k]]
                t_ns = mirror_ns - self.t_ns[k] if mirror_ns else self.t_ns[k]
                yield t_ns, self.connection[k], data


Load = Callable[[ChunkRef], ChunkMessages]


@dataclass(slots=True)
class BagIndex:
    """Contents of a bag, from its index or a scan of the file."""

    topics: dict[int, Topic]
    """Number of the connection to its topic."""
    chunks: list[ChunkRef]

    start_time: int = 2**63 - 1
    """Time of the first message [ns]."""
    end_time: int = 0
    """End of the last message [ns]."""
    mirror_ns: int = 0
    """Messages are given from the last to the first, at this time less their own [ns]; 0 = in their
    order."""

    steps: tuple[RecorderStep, ...] = ()
    """Where the recorder was set back; the times of the chunks go on."""
    find_step: Callable[[int, ChunkMessages], RecorderStep | None] | None = None
    """Finds a place within a chunk, by its offset, where it was; None = all are known."""

    @classmethod
    def of_chunks(cls, topics: dict[int, Topic], chunks: list[ChunkRef]) -> BagIndex:
        """An index whose times are those of its chunks."""
        filled = [chunk for chunk in chunks if chunk.t_first_ns <= chunk.t_last_ns]
        first = min((chunk.t_first_ns for chunk in filled), default=2**63 - 1)
        last = max((chunk.t_last_ns + 1 for chunk in filled), default=0)
        return cls(topics, chunks, first, last)

    @property
    def message_count(self) -> int:
        return sum(topic.msgcount for topic in self.topics.values())


def survey(chunks: Sequence[ChunkRef], load: Load) -> list[ChunkRef]:
    """Fill in times and counts of chunks by reading them; damaged ones are left out."""
    found = []
    for chunk in chunks:
        try:
            messages = load(chunk)
        except CorruptFile:
            continue
        if len(messages.t_ns):
            counts = Counter(messages.connection)
            found.append(
                ChunkRef(
                    chunk.offset,
                    chunk.length,
                    chunk.size,
                    chunk.compression,
                    min(messages.t_ns),
                    max(messages.t_ns),
                    dict(counts),
                    frozenset(counts),
                    chunk.crc,
                    chunk.partial,
                )
            )
    return found


def load_chunk(
    file: RecordFile, chunk: ChunkRef, read: Callable[[ChunkMessages, str], int]
) -> ChunkMessages:
    """Decompress a chunk and read its records.

    Args:
        file: The bag.
        chunk: Of its index.
        read: Adds the messages, given also the place for reports of damage; returns the end of the
            last complete record.

    Raises:
        CorruptFile: If bytes are missing or differ from the checksum.
    """
    where = f"{file.name}: chunk at byte {chunk.offset}"
    file.budget.charge(chunk.size, where)
    file.seek(chunk.offset)
    data = file.take(chunk.length, "chunk", most=MAX_CHUNK_BYTES)
    if chunk.partial:
        most = min(MAX_CHUNK_BYTES, max(RATIO_FLOOR_BYTES, chunk.size))
        raw = decompress_partly(chunk.compression, data, most=most, where=where)
    else:
        raw = decompress(chunk.compression, data, expected=chunk.size, where=where)
    if chunk.crc and not chunk.partial and crc32(raw) != chunk.crc:
        raise CorruptFile(
            CodedText("mcap-checksum", where=where, crc=f"{chunk.crc:08x}", raw=f"{crc32(raw):08x}")
        )
    messages = ChunkMessages(raw)
    at = read(messages, where)
    if at < len(raw) and not chunk.partial:
        raise CorruptFile(CodedText("chunk-records-end", where=where, count=len(raw), at=at))
    return messages


class ChunkStream:
    """Streams the messages of some topics of a bag."""

    def __init__(self, name: str, index: BagIndex, load: Load, *, report: ImportReport) -> None:
        self._name, self._index, self._report = name, index, report
        self._load = load
        self._first_damage: CorruptFile | None = None
        self._loaded = 0
        self._found: Counter[int] = Counter()

    def messages(self, topics: set[str]) -> Iterator[RawMessage]:
        """Messages in order of time.

        Raises:
            CorruptFile: If not one chunk can be read.
        """
        names = self._index.topics
        wanted = {number for number, topic in names.items() if topic.topic in topics}
        chunks = [chunk for chunk in self._index.chunks if chunk.has(wanted)]
        for t_ns, number, data in self._merged(chunks, wanted):
            yield names[number].topic, names[number].msgtype, t_ns, data
        if self._first_damage is not None and not self._loaded:
            self._report.outcome = "nothing"
            raise self._first_damage
        missing = sum(max(0, names[k].msgcount - self._found[k]) for k in wanted)
        if missing:
            self._report.outcome = "lossy"
            self._report.count("messages_missing", missing)
            self._report.warn(
                FindingKind.MESSAGES_MISSING,
                name=self._name,
                indexed=sum(names[k].msgcount for k in wanted),
                missing=missing,
            )

    def _merged(self, chunks: list[ChunkRef], wanted: set[int]) -> Iterator[Message]:
        """Messages of all chunks by time; a chunk is open from its first to its last message."""
        heap: list[_Head] = []
        held, mirror_ns = 0, self._index.mirror_ns
        ordered = sorted(chunks, key=_from_end if mirror_ns else _by_time)
        for place, chunk in enumerate(ordered):
            first_ns = mirror_ns - chunk.t_last_ns if mirror_ns else chunk.t_first_ns
            while heap and (heap[0][0] < first_ns or held > MAX_OPEN_BYTES):
                yield heap[0][2]
                held -= _advance(heap)
            messages = self._read(chunk)
            if messages is not None:
                stream = messages.in_order(wanted, mirror_ns)
                first = next(stream, None)
                if first is not None:
                    held += messages.bytes_held
                    heapq.heappush(heap, (first[0], place, first, stream, messages.bytes_held))
        while heap:
            yield heap[0][2]
            _advance(heap)

    def _read(self, chunk: ChunkRef) -> ChunkMessages | None:
        try:
            messages = self._load(chunk)
        except CorruptFile as error:
            self._damaged(error)
            return None
        messages.go_on(chunk.offset, self._index.steps)
        self._go_on_within(chunk.offset, messages)
        self._loaded += 1
        found = Counter(messages.connection)
        self._found += found
        unknown = sum(n for k, n in found.items() if k not in self._index.topics)
        if messages.rejected or unknown:
            self._report.outcome = "lossy"
            self._report.count("messages_corrupt", messages.rejected + unknown)
            self._report.warn(FindingKind.MESSAGES_DAMAGED, name=self._name)
        return messages

    def _go_on_within(self, offset: int, messages: ChunkMessages) -> None:
        """Find where the recorder was set back within a chunk: its times and all later go on."""
        index = self._index
        while index.find_step and not index.mirror_ns:
            step = index.find_step(offset, messages)
            if step is None:
                return
            messages.go_on(offset, (step,))
            index.steps = tuple(sorted((*index.steps, step), key=lambda one: one.offset))

    def _damaged(self, error: CorruptFile) -> None:
        self._first_damage = self._first_damage or error
        self._report.outcome = "lossy"
        self._report.count("chunks_damaged")
        self._report.warn(FindingKind.CHUNK_LEFT_OUT, error=error)


def _by_time(chunk: ChunkRef) -> tuple[int, int]:
    return chunk.t_first_ns, chunk.offset


def _from_end(chunk: ChunkRef) -> tuple[int, int]:
    return -chunk.t_last_ns, -chunk.offset


def _advance(heap: list[_Head]) -> int:
    """Replace the first message by the next of its chunk; bytes freed if there is none."""
    _, place, _, stream, size = heap[0]
    following = next(stream, None)
    if following is None:
        heapq.heappop(heap)
        return size
    heapq.heapreplace(heap, (following[0], place, following, stream, size))
    return 0


def require_apart(chunks: Sequence[ChunkRef], name: str, end: int) -> None:
    """Check that chunks do not overlap: an index must not list one twice.

    Raises:
        CorruptFile: If two overlap or one reaches beyond ``end``.
    """
    at = 0
    for chunk in sorted(chunks, key=lambda chunk: chunk.offset):
        if chunk.offset < at or chunk.offset + chunk.length > end:
            raise CorruptFile(
                CodedText(
                    "chunk-index",
                    name=name,
                    offset=chunk.offset,
                    at=at,
                    end=end,
                    length=chunk.length,
                )
            )
        at = chunk.offset + chunk.length
