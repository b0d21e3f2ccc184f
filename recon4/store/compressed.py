"""Bytes compressed with Zstandard; what they are expanded to is known before."""

from __future__ import annotations

from recon4.errors import StoreError
from recon4.store.tuning import PACKING
from recon4.untrusted.limits import LIMITS


def compress(data: bytes | bytearray | memoryview) -> bytes:
    """A frame of Zstandard, which states the size and a checksum of its content."""
    import zstandard

    return zstandard.ZstdCompressor(level=PACKING.level, write_checksum=True).compress(data)


def expand(data: bytes, size: int, where: str) -> bytes:
    """The content of a frame of Zstandard.

    Args:
        data: What `compress` returned.
        size: Bytes of the content.
        where: File and part of it, for errors.

    Raises:
        StoreError: If the frame is damaged or has another size. No more than `expansion` times its
            bytes are expanded (at least `free_bytes`).
    """
    import zstandard

    if size > LIMITS.expansion * len(data) + LIMITS.free_bytes:
        raise StoreError(
            f"{where}: expected at most {LIMITS.expansion} times the packed size, "
            f"got {size} bytes from {len(data)}"
        )
    try:
        stated = zstandard.frame_content_size(data)
        if stated != size:
            raise StoreError(f"{where}: expected {size} packed bytes, got {stated}")
        return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    except zstandard.ZstdError as error:
        raise StoreError(f"{where}: damaged: {error}") from error
