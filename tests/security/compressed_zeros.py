"""Zeros that compress to little, and files stretched by holes."""

from __future__ import annotations

import bz2
from pathlib import Path

import lz4.frame
import zstandard

HUGE = 7 << 30
"""Size of a sparse file."""
BLOCK = bytes(64 << 20)


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


def stretch(path: Path) -> None:
    with path.open("r+b") as file:
        file.truncate(HUGE)
