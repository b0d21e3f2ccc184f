"""Hostile recordings: small files that demand unbounded memory or time. Deterministic."""

from __future__ import annotations

import bz2
import io
import sqlite3
import struct
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import lz4.frame
import zstandard

from tests.security.fuzz.seeds_recordings import seed_db3, seed_mcap

HUGE = 7 << 30
"""Size of a sparse file."""
BLOCK = bytes(64 << 20)

# -- compressed zeros


def bz2_zeros(size: int) -> bytes:
    """``size`` zeros as concatenated bz2 streams, 45 bytes a 64 MiB."""
    return bz2.compress(BLOCK) * (size // len(BLOCK))


def lz4_zeros(size: int) -> bytes:
    return lz4.frame.compress(BLOCK, store_size=False) * (size // len(BLOCK))


def zstd_zeros(size: int, *, known_size: bool = False) -> bytes:
    """One zstd frame of ``size`` zeros."""
    compressor = zstandard.ZstdCompressor().compressobj(size=size if known_size else -1)
    parts = [compressor.compress(BLOCK) for _ in range(size // len(BLOCK))]
    return b"".join([*parts, compressor.flush()])


# -- rosbag1


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
    _stretch(path)


def bag1_sparse_chunk(path: Path) -> None:
    """A plain chunk of 4 GiB of holes, with a directory that fits."""
    header = fields(op=b"\5", compression=b"none", size=struct.pack("<I", 0xFFFF_FFF0))
    whole = bytearray(bag1([plain(b"")]))
    at = whole.index(struct.pack("<I", len(header)) + header[:10])
    whole[at : at + 8 + len(header)] = (
        struct.pack("<I", len(header)) + header + struct.pack("<I", 0xFFFF_FFF0)
    )
    path.write_bytes(whole)
    _stretch(path)


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
    """200 000 messages without content (a million take 48 s and no more memory)."""
    one = message_record(0, b"")
    per_chunk = 10_000
    chunk = connection_record() + one * per_chunk
    path.write_bytes(bag1([(b"none", chunk, len(chunk))] * 20, index=(per_chunk, 1)))


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


# -- MCAP


def mcap_record(op: int, body: bytes) -> bytes:
    return struct.pack("<BQ", op, len(body)) + body


def text(value: bytes) -> bytes:
    return struct.pack("<I", len(value)) + value


def mcap(
    chunk: bytes,
    *,
    compression: bytes = b"",
    size: int | None = None,
    repeats: int = 1,
    schema: bytes = b"",
) -> bytes:
    """An MCAP file of one chunk, which the summary lists ``repeats`` times."""
    size = len(chunk) if size is None else size
    out = io.BytesIO()
    out.write(b"\x89MCAP0\r\n" + mcap_record(1, text(b"ros2") + text(b"")))
    chunk_at = out.tell()
    t_ns = 1_700_000_000_000_000_000
    body = struct.pack("<QQQI", t_ns, t_ns, size, 0) + text(compression)
    out.write(mcap_record(6, body + struct.pack("<Q", len(chunk)) + chunk))
    chunk_end = out.tell()
    out.write(mcap_record(0x0F, bytes(4)))
    summary_at = out.tell()
    kind = text(b"sensor_msgs/msg/PointCloud2") + text(b"ros2msg") + text(schema)
    out.write(mcap_record(3, struct.pack("<H", 1) + kind))
    out.write(mcap_record(4, struct.pack("<HH", 1, 1) + text(b"/points") + text(b"cdr") + bytes(4)))
    index = struct.pack("<QQQQ", t_ns, t_ns, chunk_at, chunk_end - chunk_at) + bytes(4)
    index += struct.pack("<Q", 0) + text(compression) + struct.pack("<QQ", len(chunk), size)
    out.write(mcap_record(8, index) * repeats)
    counts = struct.pack("<IHQ", 10, 1, repeats)
    figures = struct.pack("<QHIIIIQQ", repeats, 1, 1, 0, 0, repeats, t_ns, t_ns)
    out.write(mcap_record(0x0B, figures + counts))
    out.write(mcap_record(2, struct.pack("<QQI", summary_at, 0, 0)) + b"\x89MCAP0\r\n")
    return out.getvalue()


def mcap_message(data: bytes) -> bytes:
    t_ns = 1_700_000_000_000_000_000
    return mcap_record(5, struct.pack("<HIQQ", 1, 0, t_ns, t_ns) + data)


def mcap_zstd(path: Path) -> None:
    """A chunk that declares 100 bytes and has 4 GiB."""
    path.write_bytes(mcap(zstd_zeros(4 << 30), compression=b"zstd", size=100))


def mcap_zstd_honest(path: Path) -> None:
    """The same, with the declared size."""
    path.write_bytes(mcap(zstd_zeros(4 << 30, known_size=True), compression=b"zstd", size=4 << 30))


def mcap_lz4(path: Path) -> None:
    path.write_bytes(mcap(lz4_zeros(4 << 30), compression=b"lz4", size=100))


def mcap_summary_repeats(path: Path) -> None:
    """The summary lists one chunk of a message of 1 MB 100 000 times."""
    path.write_bytes(mcap(mcap_message(bytes(1 << 20)), repeats=100_000))


def mcap_schema(path: Path) -> None:
    """A definition of 60 MB."""
    path.write_bytes(mcap(mcap_message(b""), schema=b"a/b x\n" * 10_000_000))


def mcap_tiny_messages(path: Path) -> None:
    """300 000 messages without content in one chunk (two million take 40 s)."""
    path.write_bytes(mcap(mcap_message(b"") * 300_000))


def mcap_sparse_record(path: Path) -> None:
    """A record that claims 6 GiB of a sparse file of 7 GiB."""
    path.write_bytes(seed_mcap()[:200] + struct.pack("<BQ", 6, 6 << 30))
    _stretch(path)


def mcap_sparse(path: Path) -> None:
    """7 GiB of holes behind a valid head."""
    path.write_bytes(seed_mcap()[:200])
    _stretch(path)


# -- SQLite


def _database(path: Path, script: str) -> None:
    path.unlink(missing_ok=True)
    with closing(sqlite3.connect(path)) as database:
        database.executescript(script)
        database.commit()


def db3_cycle(path: Path) -> None:
    """Inner pages that name the same child 100 times each, six levels deep: 10¹² rows."""
    _database(
        path,
        f"PRAGMA page_size = 4096; {_TOPICS} CREATE TABLE messages(id INTEGER PRIMARY KEY, "
        f"topic_id INTEGER, timestamp INTEGER, data BLOB); {_ENDLESS} INSERT INTO messages "
        "SELECT i, 1, i, zeroblob(3000) FROM n LIMIT 40;",
    )
    with closing(sqlite3.connect(path)) as database:
        query = "SELECT rootpage FROM sqlite_schema WHERE name = 'messages'"
        (root,) = database.execute(query).fetchone()
    content = bytearray(path.read_bytes())
    pages = len(content) // 4096
    first_leaf = next(k for k in range(pages) if k + 1 != root and content[k * 4096] == 13) + 1
    child = first_leaf
    for level in range(6):
        number = root if level == 5 else pages + 1 + level
        page = _inner_page(child)
        at = (number - 1) * 4096
        content[at : at + 4096] = page
        child = number
    content[28:32] = (len(content) // 4096).to_bytes(4, "big")
    path.write_bytes(content)


def _inner_page(child: int, cells: int = 100) -> bytes:
    """An inner page of a table whose children are all the same page."""
    page = bytearray(4096)
    start = 4096 - 5 * cells
    page[0:12] = struct.pack(">BHHHBI", 5, 0, cells, start, 0, child)
    for k in range(cells):
        at = start + 5 * k
        page[12 + 2 * k : 14 + 2 * k] = at.to_bytes(2, "big")
        page[at : at + 5] = child.to_bytes(4, "big") + bytes([k + 1])
    return bytes(page)


_TOPICS = """
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT,
                    offered_qos_profiles TEXT);
INSERT INTO topics VALUES (1, '/points', 'sensor_msgs/msg/PointCloud2', 'cdr', '');
"""
_ENDLESS = "with recursive n(i) as (select 1 union all select i + 1 from n)"


def db3_view(path: Path) -> None:
    """``messages`` is a view that gives rows without end."""
    _database(
        path,
        f"{_TOPICS} CREATE VIEW messages AS {_ENDLESS} "
        "SELECT i AS id, 1 AS topic_id, i AS timestamp, x'00' AS data FROM n;",
    )


def db3_topics_view(path: Path) -> None:
    """``topics`` is one."""
    _database(
        path,
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
        f"data BLOB); INSERT INTO messages VALUES (1, 1, 1, x'00'); CREATE VIEW topics AS "
        f"{_ENDLESS} SELECT i AS id, '/' || i AS name, 'sensor_msgs/msg/Imu' AS type, "
        "'cdr' AS serialization_format, '' AS offered_qos_profiles FROM n;",
    )


def db3_generated(path: Path) -> None:
    """The data are a generated column of 900 MB a row."""
    _database(
        path,
        f"{_TOPICS} CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, "
        "timestamp INTEGER, data BLOB GENERATED ALWAYS AS (zeroblob(900000000)) VIRTUAL);"
        "INSERT INTO messages(topic_id, timestamp) VALUES (1, 1), (1, 2), (1, 3);",
    )


def db3_virtual(path: Path) -> None:
    """``messages`` is a virtual table over generated rows."""
    with closing(sqlite3.connect(path)) as database:
        database.executescript(_TOPICS)
        database.execute("PRAGMA writable_schema = ON")
        database.execute(
            "INSERT INTO sqlite_schema(type, name, tbl_name, rootpage, sql) VALUES ('table', "
            "'messages', 'messages', 0, 'CREATE VIRTUAL TABLE messages USING fts5(id, topic_id, "
            "timestamp, data)')"
        )
        database.commit()


def db3_blob(path: Path) -> None:
    """One message of 900 MB."""
    _database(
        path,
        f"{_TOPICS} CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, "
        "timestamp INTEGER, data BLOB); "
        "INSERT INTO messages VALUES (1, 1, 1, zeroblob(900000000));",
    )


def db3_topics_repeated(path: Path) -> None:
    """2 000 topics and 2 000 messages of one id: a join has four million rows of 64 kB."""
    _database(
        path,
        "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT, "
        "offered_qos_profiles TEXT); CREATE TABLE messages(id INTEGER, topic_id INTEGER, "
        f"timestamp INTEGER, data BLOB); {_ENDLESS} INSERT INTO topics SELECT 1, '/points', "
        "'sensor_msgs/msg/PointCloud2', 'cdr', '' FROM n LIMIT 2000; "
        f"{_ENDLESS} INSERT INTO messages SELECT i, 1, i, zeroblob(65536) FROM n LIMIT 2000;",
    )


def db3_sparse(path: Path) -> None:
    """A valid database, 7 GiB long."""
    path.write_bytes(seed_db3())
    _stretch(path)


# -- metadata.yaml


def metadata_brackets(path: Path) -> None:
    _folder(path, b"[" * 200_000)


def metadata_aliases(path: Path) -> None:
    """Nine lists of nine references each to the list before."""
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]" for k in range(1, 12)]
    _folder(path, "\n".join(lines).encode())


def metadata_indents(path: Path) -> None:
    _folder(path, b"".join(b" " * k + b"a:\n" for k in range(3000)))


def metadata_sparse(path: Path) -> None:
    _folder(path, b"rosbag2_bagfile_information:\n")
    _stretch(path / "metadata.yaml")


def metadata_file_zstd(path: Path) -> None:
    """A compressed storage file of 4 GiB of zeros behind a valid head."""
    compressor = zstandard.ZstdCompressor().compressobj()
    parts = [compressor.compress(seed_db3())]
    parts += [compressor.compress(BLOCK) for _ in range((4 << 30) // len(BLOCK))]
    text_ = (
        b"rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
        b"  relative_file_paths: [bag.db3.zstd]\n  duration: {nanoseconds: 1}\n"
        b"  starting_time: {nanoseconds_since_epoch: 1}\n  message_count: 18\n"
        b"  topics_with_message_count: []\n  compression_format: zstd\n  compression_mode: FILE\n"
    )
    _folder(path, text_)
    (path / "bag.db3").unlink()
    (path / "bag.db3.zstd").write_bytes(b"".join([*parts, compressor.flush()]))


def _folder(path: Path, metadata: bytes) -> None:
    path.mkdir()
    (path / "metadata.yaml").write_bytes(metadata)
    (path / "bag.db3").write_bytes(seed_db3())


# -- capture files

_PCAP_HEAD = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 262144, 1)


def _datagram(source: int, port: int) -> bytes:
    udp = struct.pack(">HHHH", 1000, port, 8, 0)
    ip = struct.pack(">BBHHHBBHII", 0x45, 0, 28, 0, 0, 64, 17, 0, source, 1)
    return bytes(12) + b"\x08\x00" + ip + udp


def pcap_sparse(path: Path) -> None:
    path.write_bytes(_PCAP_HEAD)
    _stretch(path)


def pcap_tiny_datagrams(path: Path) -> None:
    """A million datagrams without content in 58 MB."""
    packet = _datagram(1, 2368)
    path.write_bytes(
        _PCAP_HEAD + (struct.pack("<IIII", 1, 1, len(packet), len(packet)) + packet) * 1_000_000
    )


def pcap_many_senders(path: Path) -> None:
    """A hundred thousand senders, one datagram each."""
    parts = []
    for k in range(100_000):
        packet = _datagram(k, k % 60_000)
        parts.append(struct.pack("<IIII", 1, k, len(packet), len(packet)) + packet)
    path.write_bytes(_PCAP_HEAD + b"".join(parts))


_SECTION = struct.pack("<IIIHHqI", 0x0A0D0D0A, 28, 0x1A2B3C4D, 1, 0, -1, 28)


def pcapng_short_block(path: Path) -> None:
    """A block whose length is less than its head: a naive reader reads the whole file."""
    path.write_bytes(_SECTION + struct.pack("<II", 1, 4))
    _stretch(path)


def pcapng_long_block(path: Path) -> None:
    path.write_bytes(_SECTION + struct.pack("<II", 1, 0xFFFF_FFF0))
    _stretch(path)


def pcapng_interfaces(path: Path) -> None:
    """Two million interfaces in 40 MB."""
    path.write_bytes(_SECTION + struct.pack("<IIHHII", 1, 20, 1, 0, 0, 20) * 2_000_000)


def pcapng_sparse(path: Path) -> None:
    path.write_bytes(_SECTION + struct.pack("<IIHHII", 1, 20, 1, 0, 0, 20))
    _stretch(path)


def _stretch(path: Path) -> None:
    with path.open("r+b") as file:
        file.truncate(HUGE)


BOMBS: dict[str, tuple[Callable[[Path], None], ...]] = {
    "bag1": (
        bag1_bz2,
        bag1_bz2_honest,
        bag1_lz4,
        bag1_many_chunks,
        bag1_directory,
        bag1_connections,
        bag1_sparse,
        bag1_sparse_chunk,
        bag1_definition,
        bag1_tiny_messages,
        bag1_fields,
        bag1_overlap,
    ),
    "mcap": (
        mcap_zstd,
        mcap_zstd_honest,
        mcap_lz4,
        mcap_summary_repeats,
        mcap_schema,
        mcap_tiny_messages,
        mcap_sparse_record,
        mcap_sparse,
    ),
    "db3": (
        db3_view,
        db3_topics_view,
        db3_generated,
        db3_virtual,
        db3_blob,
        db3_topics_repeated,
        db3_sparse,
        db3_cycle,
    ),
    "metadata": (
        metadata_brackets,
        metadata_aliases,
        metadata_indents,
        metadata_sparse,
        metadata_file_zstd,
    ),
    "pcap": (pcap_sparse, pcap_tiny_datagrams, pcap_many_senders),
    "pcapng": (pcapng_short_block, pcapng_long_block, pcapng_interfaces, pcapng_sparse),
}
"""Kind of file to what builds its bombs."""
SUFFIXES = {
    "bag1": ".bag",
    "mcap": ".mcap",
    "db3": ".db3",
    "metadata": "",
    "pcap": ".pcap",
    "pcapng": ".pcapng",
}
LINEAR = {bag1_tiny_messages, mcap_tiny_messages}
"""These are honest work that grows with the file: bounded in memory, not refused."""
