"""Lines of text logs, plain or compressed with bzip2 or gzip, within limits."""

from __future__ import annotations

import bz2
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.limits import MAX_RATIO, RATIO_FLOOR_BYTES
from recon4.recording.report import ImportReport
from recon4.untrusted.bounded import open_regular
from recon4.untrusted.limits import LIMITS

MAX_LOG_BYTES = 4 << 30
"""A log of eight hours at 40 Hz with 1081 beams has 8 GB; decompressed logs are smaller."""
MAX_LOG_LINES = 15_000_000
"""Such a log has 12 million; more are empty lines that keep a reader busy."""
_PIECE = 1 << 20
_COMPRESSED_PIECE = 1 << 16
"""What is behind the end of a stream is copied: with larger pieces a file of many short streams
takes minutes."""
_BZIP2, _GZIP = b"BZh", b"\x1f\x8b"


def log_lines(path: Path, report: ImportReport) -> Iterator[bytes]:
    """Lines without their ends; what is left of a file that is cut off is read and reported.

    Raises:
        CorruptFile: If the file cannot be read, has a line that is too long, more than
            `MAX_LOG_LINES`, or becomes larger than `MAX_LOG_BYTES`, or `MAX_RATIO` times its
            compressed size.
    """
    with open_regular(path) as file:
        rest, number, total = b"", 0, 0
        most = _largest(path, file)
        for piece in _pieces(file, path.name, report):
            total += len(piece)
            if total > most:
                raise CorruptFile(CodedText("text-large", file=path.name, most=most))
            *lines, rest = (rest + piece).split(b"\n")
            for line in lines:
                number += 1
                yield line
            if number > MAX_LOG_LINES:
                raise CorruptFile(
                    CodedText("text-lines-many", file=path.name, max_log_lines=MAX_LOG_LINES)
                )
            if len(rest) > LIMITS.line_bytes:
                raise CorruptFile(
                    CodedText(
                        "text-line-long", file=path.name, line=number + 1, limit=LIMITS.line_bytes
                    )
                )
        if rest.strip():
            yield rest


def first_lines(path: Path, count: int) -> list[bytes]:
    """At most ``count`` lines from the beginning; none where the file is no text log.

    Raises:
        CorruptFile: If the file cannot be read.
    """
    found: list[bytes] = []
    try:
        for line in log_lines(path, ImportReport()):
            found.append(line)
            if len(found) >= count:
                break
    except CorruptFile:
        return found
    return found


def _largest(path: Path, file: BinaryIO) -> int:
    size = path.stat().st_size
    head = file.read(3)
    file.seek(0)
    if head.startswith((_BZIP2, _GZIP)):
        return min(MAX_LOG_BYTES, max(RATIO_FLOOR_BYTES, MAX_RATIO * size))
    return MAX_LOG_BYTES


def _pieces(file: BinaryIO, name: str, report: ImportReport) -> Iterator[bytes]:
    """The content, decompressed."""
    head = file.read(3)
    file.seek(0)
    if head.startswith(_BZIP2):
        yield from _decompressed(file, bz2.BZ2Decompressor, magic=_BZIP2, name=name, report=report)
    elif head.startswith(_GZIP):
        yield from _decompressed(file, _Gzip, magic=_GZIP, name=name, report=report)
    else:
        while piece := file.read(_PIECE):
            yield piece


class _Gzip:
    """Decompressor of one gzip stream with the interface of bz2's."""

    def __init__(self) -> None:
        self._stream = zlib.decompressobj(wbits=31)

    @property
    def eof(self) -> bool:
        return self._stream.eof

    @property
    def unused_data(self) -> bytes:
        return self._stream.unused_data

    @property
    def needs_input(self) -> bool:
        return not self._stream.unconsumed_tail

    def decompress(self, data: bytes, max_length: int) -> bytes:
        return self._stream.decompress(self._stream.unconsumed_tail + data, max_length)


def _decompressed(
    file: BinaryIO, new_decoder: Callable[[], Any], *, magic: bytes, name: str, report: ImportReport
) -> Iterator[bytes]:
    """The content of all streams: parallel compressors write several, one after the other."""
    data = b""
    while True:
        decoder = new_decoder()
        yield from _one_stream(file, decoder, data, name=name, report=report)
        if not decoder.eof:
            return
        data = decoder.unused_data
        if len(data) < len(magic):
            data += file.read(_COMPRESSED_PIECE)
        if data.startswith(magic):
            continue
        if data.strip(b"\0"):
            report.outcome = "lossy"
            report.count("files_damaged")
            report.warn(FindingKind.FILE_REST_UNREAD, name=name)
        return


def _one_stream(
    file: BinaryIO, decoder: Any, data: bytes, *, name: str, report: ImportReport
) -> Iterator[bytes]:
    """The content of a stream that begins with ``data``; it may end without the stream's end."""
    while not decoder.eof:
        if decoder.needs_input and not data:
            data = file.read(_COMPRESSED_PIECE)
            if not data:
                report.outcome = "lossy"
                report.count("files_cut")
                report.warn(FindingKind.FILE_SALVAGED, name=name)
                return
        try:
            piece = decoder.decompress(data, max_length=_PIECE)
        except (OSError, ValueError, EOFError, zlib.error) as error:
            report.outcome = "lossy"
            report.count("files_damaged")
            report.warn(FindingKind.FILE_SALVAGED, name=name, error=error)
            return
        data = b""
        if piece:
            yield piece
