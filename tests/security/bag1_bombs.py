"""rosbag1 files that ask for far more memory than they have bytes."""

from __future__ import annotations

import bz2
import struct
from pathlib import Path

from tests.security.compressed_zeros import bz2_zeros, lz4_zeros, stretch


def fields(**values: bytes) -> bytes:
    """A record header."""
    parts = [name.encode() + b"=" + value for name, value in values.items()]
    return b"".join(struct.pack("<I", len(part)) + part for part in parts)


def record(header: bytes, data: bytes) -> bytes:
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def connection_record(number: int = 0, definition: bytes = b"", topic: bytes = b"/points") -> bytes:
    conn = struct.pack("<I", number)
    about = fields(
        topic=topic, type=b"sensor_msgs/PointCloud2", md5sum=b"*", message_definition=definition
    )
    return record(fields(op=b"\7", conn=conn, topic=topic), about)


def message_record(number: int, data: bytes, seconds: int = 1_700_000_000) -> bytes:
    stamp = struct.pack("<II", seconds, 0)
    return record(fields(op=b"\2", conn=struct.pack("<I", number), time=stamp), data)


def bag1(
    chunks: list[tuple[bytes, bytes, int]],
    *,
    connections: list[bytes] | None = None,
    index: tuple[int, int] = (1, 1),
    connection_count: int | None = None,
) -> bytes:
    """A rosbag1 file.

    Args:
        chunks: Compression, bytes and claimed size of every chunk.
        connections: Connection records.
        index: Entries in the index of a chunk; how often the directory lists a chunk.
        connection_count: What the file header claims.
    """
    entries, repeats = index
    connections = [connection_record()] if connections is None else connections
    body, infos = b"", b""
    stamp = struct.pack("<II", 1_700_000_000, 0)
    one = struct.pack("<I", 1)
    start = 13 + 4096
    for compression, data, size in chunks:
        at = struct.pack("<Q", start + len(body))
        header = fields(op=b"\5", compression=compression, size=struct.pack("<I", size))
        body += record(header, data)
        head = fields(op=b"\4", ver=one, conn=bytes(4), count=struct.pack("<I", entries))
        body += record(head, (stamp + bytes(4)) * entries)
        info = fields(op=b"\6", ver=one, chunk_pos=at, start_time=stamp, end_time=stamp, count=one)
        infos += record(info, bytes(4) + struct.pack("<I", entries)) * repeats
    header = fields(
        op=b"\3",
        index_pos=struct.pack("<Q", start + len(body)),
        conn_count=struct.pack("<I", connection_count or len(connections)),
        chunk_count=struct.pack("<I", len(chunks) * repeats),
    )
    padding = 4096 - 8 - len(header)
    head = struct.pack("<I", len(header)) + header + struct.pack("<I", padding) + b" " * padding
    return b"#ROSBAG V2.0\n" + head + body + b"".join(connections) + infos


def plain(data: bytes) -> tuple[bytes, bytes, int]:
    """A chunk that is not compressed."""
    return b"none", data, len(data)


def bag1_bz2(path: Path) -> None:
    """9 kB that decompress to 4 GiB."""
    path.write_bytes(bag1([(b"bz2", bz2_zeros(4 << 30), 768 * 1024)]))


def bag1_bz2_honest(path: Path) -> None:
    """The same, with the size the header must have."""
    path.write_bytes(bag1([(b"bz2", bz2_zeros(4 << 30), 0xFFFF_FFFF)]))


def bag1_lz4(path: Path) -> None:
    path.write_bytes(bag1([(b"lz4", lz4_zeros(4 << 30), 768 * 1024)]))


def bag1_many_chunks(path: Path) -> None:
    """Ten thousand chunks, each below any limit of one chunk: 160 GiB in all."""
    chunk = bz2.compress(bytes(15 << 20))
    path.write_bytes(bag1([(b"bz2", chunk, 15 << 20)] * 10_000))


def bag1_directory(path: Path) -> None:
    """The directory lists one chunk of 50 000 index entries 20 000 times: 10⁹ entries."""
    path.write_bytes(
        bag1([plain(connection_record() + message_record(0, b""))], index=(50_000, 20_000))
    )


def bag1_connections(path: Path) -> None:
    """A header that declares 4 billion connections."""
    path.write_bytes(
        bag1(
            [plain(message_record(0, b""))],
            connections=[connection_record(k) for k in range(60_000)],
            connection_count=0xFFFF_FFFF,
        )
    )


def bag1_sparse(path: Path) -> None:
    """A record of nearly 4 GiB in a sparse file of 7 GiB."""
    whole = bag1([plain(message_record(0, b""))])
    path.write_bytes(whole[: 13 + 4096] + struct.pack("<I", 0xFFFF_FFF0))
    stretch(path)


def bag1_sparse_chunk(path: Path) -> None:
    """A plain chunk of 4 GiB of holes, with a directory that fits."""
    header = fields(op=b"\5", compression=b"none", size=struct.pack("<I", 0xFFFF_FFF0))
    whole = bytearray(bag1([plain(b"")]))
    at = whole.index(struct.pack("<I", len(header)) + header[:10])
    whole[at : at + 8 + len(header)] = (
        struct.pack("<I", len(header)) + header + struct.pack("<I", 0xFFFF_FFF0)
    )
    path.write_bytes(whole)
    stretch(path)


def bag1_definition(path: Path) -> None:
    """A message definition of 60 MB that nests without end."""
    definition = b"a/b x\n" * 10_000_000
    path.write_bytes(
        bag1(
            [plain(message_record(0, b""))],
            connections=[connection_record(definition=definition)],
        )
    )


def bag1_tiny_messages(path: Path) -> None:
    """80 000 messages without content (a million take 48 s and no more memory)."""
    one = message_record(0, b"")
    per_chunk = 10_000
    chunk = connection_record() + one * per_chunk
    path.write_bytes(bag1([(b"none", chunk, len(chunk))] * 8, index=(per_chunk, 1)))


def bag1_fields(path: Path) -> None:
    """One cloud whose list of fields has three million entries."""
    field = struct.pack("<I", 0) + struct.pack("<IBI", 0, 7, 1)
    count = 3_000_000
    data = struct.pack("<III", 0, 1_700_000_000, 0) + struct.pack("<I", 0)
    data += struct.pack("<III", 1, 1, count) + field * count + bytes(30)
    chunk = connection_record() + message_record(0, data)
    path.write_bytes(bag1([(b"none", chunk, len(chunk))]))


def bag1_overlap(path: Path) -> None:
    """A cloud of 8 MB whose 200 fields share the same bytes: 13 GB once they are columns."""
    names = [b"x", b"y", b"z"] + [b"f%d" % k for k in range(197)]
    field_list = b"".join(
        struct.pack("<I", len(n)) + n + struct.pack("<IBI", 0, 8, 1) for n in names
    )
    points = 1_000_000
    data = struct.pack("<III", 0, 1_700_000_000, 0) + struct.pack("<I", 0)
    data += struct.pack("<III", 1, points, len(names)) + field_list + b"\0"
    data += struct.pack("<III", 8, 8 * points, 8 * points) + bytes(8 * points) + b"\1"
    chunk = connection_record() + message_record(0, data)
    path.write_bytes(bag1([(b"none", chunk, len(chunk))]))
