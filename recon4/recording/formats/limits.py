"""Limits of recordings: sizes are checked before memory is allocated or work is done."""

from __future__ import annotations

import bz2
import io
import os
from pathlib import Path
from typing import Any, Self

from recon4.errors import CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText

MAX_CHUNK_BYTES = 128 << 20
"""A chunk of a bag, compressed or not; recorders write less than 5 MB."""
MAX_MESSAGE_BYTES = 64 << 20
"""One message, compressed or not; a cloud of 128 beams x 2048 columns has 12 MB."""
MAX_RECORD_HEADER_BYTES = 1 << 20
MAX_TOPICS = 10_000
MAX_DEFINITION_CHARACTERS = 64 * 1024
"""Of a type of messages; the longest ones have some kilobytes."""
MAX_RATIO = 200
"""Largest expansion of a compressed byte, beyond `RATIO_FLOOR_BYTES`."""
RATIO_FLOOR_BYTES = 16 << 20
TOTAL_FLOOR_BYTES = 256 << 20
"""As `RATIO_FLOOR_BYTES`, for all that a recording has compressed, see `Budget`."""
_PIECE = 1 << 20


class Budget:
    """Bytes that the chunks, messages or files of a recording may become in one pass through it.

    Each of them alone may be harmless: ten thousand of 15 MiB are not.
    """

    def __init__(self, compressed: int) -> None:
        """Start a pass through files of ``compressed`` bytes."""
        self._compressed = compressed
        self._most = max(TOTAL_FLOOR_BYTES, MAX_RATIO * compressed)
        self._spent = 0

    def charge(self, size: int, where: str) -> None:
        """Count decompressed bytes.

        Raises:
            CorruptFile: If there are more than `MAX_RATIO` times the compressed ones.
        """
        self._spent += size
        if self._spent > self._most:
            raise CorruptFile(
                CodedText(
                    "unpacked-large-all", where=where, compressed=self._compressed, most=self._most
                )
            )


class RecordFile:
    """A file that is read record by record; use as a context manager.

    Every length is checked against the file and a limit before anything is allocated.
    """

    def __init__(self, path: Path) -> None:
        """Open a file.

        Raises:
            EmptyRecording: If it has no bytes.
        """
        self.name = path.name
        self._file = path.open("rb")
        self.size = os.fstat(self._file.fileno()).st_size
        self.budget = Budget(self.size)
        if not self.size:
            self._file.close()
            raise EmptyRecording(CodedText("file-empty", name=path.name))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    @property
    def at(self) -> int:
        """Offset of the next byte."""
        return self._file.tell()

    @property
    def left(self) -> int:
        """Bytes behind the offset."""
        return max(0, self.size - self.at)

    def seek(self, offset: int) -> None:
        """Go to an offset.

        Raises:
            CorruptFile: If the file does not have it.
        """
        if not 0 <= offset <= self.size:
            raise CorruptFile(
                CodedText("offset-beyond", name=self.name, size=self.size, offset=offset)
            )
        self._file.seek(offset)

    def take(self, length: int, what: str, *, most: int = MAX_CHUNK_BYTES) -> bytes:
        """Read exactly ``length`` bytes.

        Args:
            length: Number of bytes, as in the file.
            what: What they are, for the message.
            most: More than that is damage or an attack.

        Raises:
            CorruptFile: If it is too much, or the file ends before.
        """
        if length > min(most, self.left):
            raise CorruptFile(
                CodedText(
                    "length-beyond",
                    name=self.name,
                    what=what,
                    at=self.at,
                    most=min(most, self.left),
                    length=length,
                )
            )
        return self._file.read(length)

    def restart_budget(self) -> None:
        """Start a new pass through the file."""
        self.budget = Budget(self.size)

    def uint(self, size: int, what: str) -> int:
        """Read an unsigned little-endian integer of ``size`` bytes."""
        return int.from_bytes(self.take(size, what), "little")


def decompress(how: str, data: bytes, *, expected: int, where: str) -> bytes:
    """Decompress a chunk whose size is known from its header.

    Args:
        how: ``bz2``, ``lz4``, ``zstd``, or empty or ``none``.
        data: Compressed bytes.
        expected: How many bytes they must become.
        where: File and offset, for the message.

    Raises:
        CorruptFile: If they would become more than is allowed, or other than expected.
    """
    check_ratio(len(data), expected, where)
    found = decompress_partly(how, data, most=expected + 1, where=where)
    if len(found) != expected:
        more = "more" if len(found) > expected else f"{len(found)}"
        raise CorruptFile(CodedText("unpacked-size", where=where, expected=expected, more=more))
    return found


def check_ratio(compressed: int, size: int, where: str) -> None:
    """Refuse a chunk with too large a decompressed size.

    Raises:
        CorruptFile: If it does.
    """
    most = min(MAX_CHUNK_BYTES, max(RATIO_FLOOR_BYTES, MAX_RATIO * compressed))
    if size > most:
        raise CorruptFile(
            CodedText("unpacked-large", where=where, compressed=compressed, most=most, size=size)
        )


def is_zstd(data: bytes) -> bool:
    """Whether data begin as those compressed by zstd; a message of ROS 2 never does."""
    return data[:4] == b"\x28\xb5\x2f\xfd"


def decompress_partly(how: str, data: bytes, *, most: int, where: str) -> bytes:
    """Decompress possibly damaged bytes as far as possible, at most ``most`` bytes.

    Raises:
        CorruptFile: If the kind of compression is unknown.
    """
    if how in {"", "none"}:
        return data[:most]
    if how == "zstd":
        return _zstd(data, most)
    if how == "bz2":
        return _inflate(bz2.BZ2Decompressor(), data, most)
    if how == "lz4":
        import lz4.frame

        return _inflate(lz4.frame.LZ4FrameDecompressor(), data, most)
    raise CorruptFile(CodedText("compression-unknown", where=where, how=how[:40]))


def _inflate(decoder: Any, data: bytes, most: int) -> bytes:
    """Decompress one stream; bytes after it are not part of the chunk."""
    found, at = bytearray(), 0
    while len(found) < most and not decoder.eof:
        piece = data[at : at + _PIECE] if decoder.needs_input else b""
        at += len(piece)
        if decoder.needs_input and not piece:
            break
        try:
            found += decoder.decompress(piece, max_length=min(_PIECE, most - len(found)))
        except (OSError, ValueError, RuntimeError, EOFError):
            break
    return bytes(found)


def _zstd(data: bytes, most: int) -> bytes:
    import zstandard

    # A window is allocated before the first byte comes out.
    decoder = zstandard.ZstdDecompressor(max_window_size=MAX_CHUNK_BYTES)
    found = bytearray()
    with decoder.stream_reader(io.BytesIO(data)) as stream:
        while len(found) < most:
            try:
                piece = stream.read(min(_PIECE, most - len(found)))
            except zstandard.ZstdError:
                break
            if not piece:
                break
            found += piece
    return bytes(found)


def definition_text(text: bytes | str) -> str:
    """The definition of a message from a file; none that is longer than any real one."""
    whole = text.decode("utf-8", "replace") if isinstance(text, bytes) else text
    return whole if len(whole) <= MAX_DEFINITION_CHARACTERS else ""


def clean_name(name: bytes | str) -> str:
    """A name from a file without control characters, at most 256 characters long."""
    text = name.decode("utf-8", "replace") if isinstance(name, bytes) else name
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text[:256])
