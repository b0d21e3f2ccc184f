"""Bytes compressed with Zstandard; what they are expanded to is known before."""

from __future__ import annotations

from recon4.errors import StoreError
from recon4.store.arrays import FREE_BYTES, MAX_RATIO
from recon4.store.tuning import PACKING


def compress(data: bytes | bytearray | memoryview) -> bytes:
    """A frame of Zstandard, which states the size of its content."""
    import zstandard

    return zstandard.ZstdCompressor(level=PACKING.level).compress(data)


def expand(data: bytes, size: int, where: str) -> bytes:
    """The content of a frame of Zstandard.

    Args:
        data: What `compress` returned.
        size: Bytes of the content.
        where: File and part of it, for errors.

    Raises:
        StoreError: If the frame is damaged or has another size. No more than `MAX_RATIO` times
            its bytes are expanded (at least `FREE_BYTES`).
    """
    import zstandard

    if size > MAX_RATIO * len(data) + FREE_BYTES:
        raise StoreError(
            f"{where}: expected at most {MAX_RATIO} times the packed size, "
            f"got {size} bytes from {len(data)}"
        )
    try:
        stated = zstandard.frame_content_size(data)
        if stated != size:
            raise StoreError(f"{where}: expected {size} packed bytes, got {stated}")
        return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    except zstandard.ZstdError as error:
        raise StoreError(f"{where}: damaged: {error}") from error
