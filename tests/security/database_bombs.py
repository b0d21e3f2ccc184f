"""Bags of SQLite, and their metadata.yaml, that ask for too much work or memory."""

from __future__ import annotations

import sqlite3
import struct
from contextlib import closing
from pathlib import Path

import zstandard

from tests.security.compressed_zeros import BLOCK, stretch
from tests.security.fuzz.seeds_recordings import seed_db3

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
    stretch(path)


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
    stretch(path / "metadata.yaml")


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
