"""MCAP files that ask for far more memory than they have bytes."""

from __future__ import annotations

import io
import struct
from pathlib import Path

from tests.security.compressed_zeros import lz4_zeros, stretch, zstd_zeros
from tests.security.fuzz.seeds_recordings import seed_mcap


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
    """The summary lists one chunk of a message of 1 MB 30 000 times (30 GB, were each one read)."""
    path.write_bytes(mcap(mcap_message(bytes(1 << 20)), repeats=30_000))


def mcap_schema(path: Path) -> None:
    """A definition of 60 MB."""
    path.write_bytes(mcap(mcap_message(b""), schema=b"a/b x\n" * 10_000_000))


def mcap_tiny_messages(path: Path) -> None:
    """120 000 messages without content in one chunk (two million take 40 s)."""
    path.write_bytes(mcap(mcap_message(b"") * 120_000))


def mcap_sparse_record(path: Path) -> None:
    """A record that claims 6 GiB of a sparse file of 7 GiB."""
    path.write_bytes(seed_mcap()[:200] + struct.pack("<BQ", 6, 6 << 30))
    stretch(path)


def mcap_sparse(path: Path) -> None:
    """7 GiB of holes behind a valid head."""
    path.write_bytes(seed_mcap()[:200])
    stretch(path)
