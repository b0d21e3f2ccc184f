"""Recordings of many small compressed pieces, each harmless: together they become terabytes.

Made by the libraries that recorders use; the pieces are then repeated.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import zstandard
from rosbags.rosbag2 import CompressionFormat, CompressionMode, Writer
from rosbags.typesys import Stores, get_typestore

from tests.security.fuzz.seeds_recordings import seed_db3

PIECE = 15 << 20
"""Below every limit of a single piece [bytes]."""


def db3_many_messages(path: Path) -> None:
    """10 000 messages of 600 bytes that become 15 MiB each: 150 GiB from 7 MB."""
    writer = Writer(path, version=9)
    writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
    with writer:
        kind, store = "sensor_msgs/msg/PointCloud2", get_typestore(Stores.ROS2_HUMBLE)
        connection = writer.add_connection("/points", kind, typestore=store)
        writer.write(connection, 1_700_000_000_000_000_000, bytes(PIECE))
    with closing(sqlite3.connect(next(path.glob("*.db3")))) as database:
        database.execute(
            "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 10000) "
            "INSERT INTO messages(topic_id, timestamp, data) SELECT topic_id, timestamp + i, data "
            "FROM messages, n"
        )
        database.commit()


def db3_many_files(path: Path) -> None:
    """A bag of 100 files of 16 kB that become 15 MiB each: 1.6 GB on the disk from 1.6 MB."""
    path.mkdir()
    packed = zstandard.compress(seed_db3() + bytes(PIECE))
    names = [f"bag.db3.{k}.db3.zstd" for k in range(100)]
    for name in names:
        (path / name).write_bytes(packed)
    (path / "metadata.yaml").write_text(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
        f"  relative_file_paths: [{', '.join(names)}]\n  duration: {{nanoseconds: 1}}\n"
        "  starting_time: {nanoseconds_since_epoch: 1}\n  message_count: 18\n"
        "  topics_with_message_count: []\n  compression_format: zstd\n  compression_mode: FILE\n"
    )
