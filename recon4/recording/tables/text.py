"""Text of tables that people wrote: any usual encoding and line ending, in bounded pieces.

Surveying software writes UTF-8 with and without a byte order mark, UTF-16 (Excel's *Unicode text*)
and the code page of its computer. Only names and comments depend on it: numbers are ASCII in all
of them, so that a byte that cannot be decoded is harmless unless it stands in a number.
"""

from __future__ import annotations

import codecs
import io
import re
from collections.abc import Iterator
from pathlib import Path

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.tables.tuning import TABLES
from recon4.untrusted.bounded import check_file_size, open_regular
from recon4.untrusted.limits import LIMITS

_BLANKS = re.compile("[\u00a0\u2007\u2009\u202f]")
"""Blanks that spreadsheets put between groups of digits; an ordinary one means the same."""


def text_encoding(head: bytes) -> str:
    """Name of the encoding of a text that begins with these bytes."""
    if head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    half = len(head) // 2
    for encoding, zeros in (("utf-16-le", head[1::2]), ("utf-16-be", head[0::2])):
        # ASCII in UTF-16 without a byte order mark: every second byte is zero, no other one.
        if half and zeros[:half].count(0) == half and head.count(0) == half:
            return encoding
    try:
        codecs.getincrementaldecoder("utf-8")().decode(head)  # the last character may be cut
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def table_head(path: Path) -> str:
    """The first lines of a table, whole ones unless there is only one.

    Raises:
        CorruptFile: If it holds a NUL byte, so that it is no text, or cannot be opened.
    """
    with open_regular(path) as file:
        data = file.read(TABLES.head_bytes)
        whole = not file.read(1)
    text = decode_table(data, path.name)
    end = max(text.rfind("\n"), text.rfind("\r")) + 1
    return universal(text if whole or not end else text[:end])


def table_blocks(path: Path, *, max_bytes: int) -> Iterator[str]:
    r"""Whole lines of a table, about `BLOCK_CHARACTERS` at a time; every line ends with ``\n``.

    Raises:
        CorruptFile: If the file is too large, a line is longer than `LIMITS.line_bytes`, or there
            is a NUL byte.
    """
    with open_regular(path) as file:
        check_file_size(file, path, max_bytes)
        encoding = text_encoding(file.read(TABLES.head_bytes))
        file.seek(0)
        reader = io.TextIOWrapper(file, encoding, errors="replace", newline=None)
        number = 1
        while block := reader.read(TABLES.block_characters):
            block += reader.readline(LIMITS.line_bytes + 1)
            _check_lines(block, number, path.name)
            number += block.count("\n")
            yield _BLANKS.sub(" ", block)


def decode_table(data: bytes, name: str) -> str:
    """Bytes of a table as text.

    Raises:
        CorruptFile: Naming the line with a NUL byte.
    """
    text = data.decode(text_encoding(data[: TABLES.head_bytes]), errors="replace").lstrip("\ufeff")
    _refuse_nul(text, 1, name)
    return _BLANKS.sub(" ", text)


def universal(text: str) -> str:
    r"""Text whose lines end with ``\n``."""
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _check_lines(block: str, number: int, name: str) -> None:
    _refuse_nul(block, number, name)
    start = 0
    while len(block) - start > LIMITS.line_bytes:
        end = block.rfind("\n", start, start + LIMITS.line_bytes + 1)
        if end < 0:
            line = number + block.count("\n", 0, start)
            raise CorruptFile(
                CodedText("text-line-long", file=name, line=line, limit=LIMITS.line_bytes)
            )
        start = end + 1


def _refuse_nul(text: str, number: int, name: str) -> None:
    at = text.find("\0")
    if at >= 0:
        line = number + text.count("\n", 0, at)
        raise CorruptFile(CodedText("text-nul", file=name, line=line))
