"""Bounded reading of files of unknown origin.

The size of a file, the length of a line and the nesting of a document are checked before memory
is allocated for them. Errors say the file, the place, what was expected and what was found.
"""

from __future__ import annotations

import json
import math
import os
import re
import stat
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO

from recon4.errors import CorruptFile, Recon4Error
from recon4.locales.coded import CodedText, text_of
from recon4.untrusted.limits import LIMITS

Failure = type[Recon4Error]
"""Class of the error that a reader raises."""


_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")


def open_regular(path: Path, *, failure: Failure = CorruptFile) -> BinaryIO:
    """Open a regular file for reading; a pipe or a device is refused, it might never end.

    Raises:
        Recon4Error: Of the class ``failure``, if there is no such file or it cannot be opened.
    """
    try:
        # A named pipe without a writer blocks an ordinary open().
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        raise _unreadable(path, error, failure) from error
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise failure(CodedText("file-not-regular", file=path.name))
    return os.fdopen(descriptor, "rb")


def read_bytes_limited(path: Path, max_bytes: int, *, failure: Failure = CorruptFile) -> bytes:
    """Read a whole file of at most ``max_bytes``.

    Raises:
        Recon4Error: Of the class ``failure``, if it is larger or cannot be read.
    """
    with open_regular(path, failure=failure) as file:
        check_file_size(file, path, max_bytes, failure=failure)
        try:
            data = file.read(max_bytes + 1)
        except OSError as error:
            raise _unreadable(path, error, failure) from error
    if len(data) > max_bytes:  # it grew meanwhile
        raise failure(CodedText("file-grew", file=path.name, limit=max_bytes))
    return data


def check_file_size(
    file: BinaryIO, path: Path, max_bytes: int, *, failure: Failure = CorruptFile
) -> int:
    """The size of an open file [bytes], checked against the largest allowed.

    Raises:
        Recon4Error: Of the class ``failure``, if it is larger.
    """
    size = os.fstat(file.fileno()).st_size
    if size > max_bytes:
        raise failure(CodedText("file-large", file=path.name, limit=max_bytes, size=size))
    return size


def read_text_limited(path: Path, max_bytes: int, *, failure: Failure = CorruptFile) -> str:
    """Read a whole UTF-8 file of at most ``max_bytes``; a byte order mark is left out.

    Raises:
        Recon4Error: Of the class ``failure``, if it is larger, not UTF-8 or cannot be read.
    """
    return decode_text(
        read_bytes_limited(path, max_bytes, failure=failure), path.name, failure=failure
    )


def decode_text(data: bytes, name: str, *, failure: Failure = CorruptFile) -> str:
    """UTF-8 bytes as text, without a byte order mark.

    Raises:
        Recon4Error: Of the class ``failure``, naming line and offset of what is not UTF-8, or of
            a NUL byte.
    """
    _refuse_utf16(data, name, failure)
    nul = data.find(b"\0")
    if nul >= 0:
        line = data.count(b"\n", 0, nul) + 1
        raise failure(CodedText("text-nul-at", file=name, line=line, offset=nul))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise failure(
            CodedText(
                "text-not-utf8-at",
                file=name,
                line=line,
                byte=f"{data[error.start]:02x}",
                offset=error.start,
            )
        ) from error


def lines_limited(
    path: Path,
    *,
    max_line_bytes: int = LIMITS.line_bytes,
    max_bytes: int,
    failure: Failure = CorruptFile,
    on_damaged: Callable[[Recon4Error], None] | None = None,
) -> Iterator[str]:
    r"""Lines of a UTF-8 text file with their ends, one in memory at a time.

    A byte order mark is left out; ``\n``, ``\r\n`` and a lone ``\r`` inside a line are kept as
    they are.

    Args:
        path: The file.
        max_line_bytes: Longest line [bytes].
        max_bytes: Largest file [bytes].
        failure: Class of the errors.
        on_damaged: Receives the error of a line that cannot be read, which then is an empty one;
            None = the error is raised.

    Raises:
        Recon4Error: Of the class ``failure``, naming the line that is too long, holds a NUL or is
            not UTF-8, or if the file is too large.
    """
    with open_regular(path, failure=failure) as file:
        check_file_size(file, path, max_bytes, failure=failure)
        number = 0
        while line := file.readline(max_line_bytes + 1):
            number += 1
            try:
                if len(line) > max_line_bytes:
                    raise failure(
                        CodedText(
                            "text-line-long", file=path.name, line=number, limit=max_line_bytes
                        )
                    )
                text = _line(line, number, path.name, failure=failure)
            except failure as error:
                if on_damaged is None:
                    raise
                on_damaged(error)
                text = ""
                _skip_line(file, line, max_line_bytes)
            yield text


def _skip_line(file: BinaryIO, line: bytes, piece: int) -> None:
    """Read to the end of a line whose beginning was read."""
    while line and not line.endswith(b"\n"):
        line = file.readline(piece)


def text_blocks(
    path: Path, *, block_bytes: int, max_bytes: int, failure: Failure = CorruptFile
) -> Iterator[str]:
    """Whole lines of a UTF-8 text file, as many as fit into ``block_bytes`` at a time.

    Raises:
        Recon4Error: Of the class ``failure``, as `lines_limited`; a line longer than
            `LIMITS.line_bytes` is refused.
    """
    with open_regular(path, failure=failure) as file:
        check_file_size(file, path, max_bytes, failure=failure)
        number, rest = 1, b""
        while data := file.read(block_bytes):
            data = rest + data
            end = data.rfind(b"\n") + 1
            block, rest = data[:end], data[end:]
            if len(rest) > LIMITS.line_bytes:
                line = number + block.count(b"\n")
                raise failure(
                    CodedText("text-line-long", file=path.name, line=line, limit=LIMITS.line_bytes)
                )
            if block:
                yield _block(block, number, path.name, failure=failure)
                number += block.count(b"\n")
        if rest:
            yield _block(rest, number, path.name, failure=failure)


def parse_float(text: str) -> float:
    """A number as tables have it; Python's own ``1_000`` is refused.

    Raises:
        ValueError: If it is no number.
    """
    if "_" in text or not text.isascii():
        raise ValueError(f"expected a number, got {text[:40]!r}")
    return float(text)


def parse_json(
    text: str | bytes, name: str, *, failure: Failure = CorruptFile, finite: bool = False
) -> Any:
    """Parse JSON of unknown origin.

    Args:
        text: The document; bytes are UTF-8.
        name: What it is, for the error.
        failure: Class of the error.
        finite: Also refuse NaN and numbers that are too large for a computer.

    Raises:
        Recon4Error: Of the class ``failure``, if it is no JSON, nested deeper than `LIMITS.depth`
            or has text that cannot be written as UTF-8 (a lone surrogate).
    """
    if isinstance(text, bytes):
        text = decode_text(text, name, failure=failure)
    try:
        check = _finite if finite else None
        value = json.loads(text, parse_constant=check, parse_float=check)
    except ValueError as error:
        raise failure(CodedText("json-invalid", file=name, why=text_of(error))) from error
    except RecursionError as error:
        raise failure(CodedText("json-deep", file=name, limit=LIMITS.depth)) from error
    _check_depth(value, name, failure)
    if _SURROGATE.search(text):
        _check_surrogates(value, name, failure)
    return value


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(CodedText("not-finite", got=text[:40]))
    return value


def _check_depth(value: Any, name: str, failure: Failure) -> None:
    level = [value]
    for _ in range(LIMITS.depth + 1):
        level = [
            child
            for item in level
            if isinstance(item, (dict, list))
            for child in (item.values() if isinstance(item, dict) else item)
        ]
        if not level:
            return
    raise failure(CodedText("json-deep", file=name, limit=LIMITS.depth))


def _check_surrogates(value: Any, name: str, failure: Failure) -> None:
    try:
        json.dumps(value, ensure_ascii=False).encode("utf-8")
    except UnicodeEncodeError as error:
        raise failure(CodedText("json-surrogate", file=name, why=str(error))) from error


def _block(block: bytes, number: int, name: str, *, failure: Failure) -> str:
    try:
        if b"\0" not in block:
            return block.decode("utf-8-sig" if number == 1 else "utf-8")
    except UnicodeDecodeError:
        pass
    for k, line in enumerate(block.splitlines(keepends=True)):
        _line(line, number + k, name, failure=failure)
    raise failure(CodedText("text-not-utf8-behind", file=name, line=number))


def _line(line: bytes, number: int, name: str, *, failure: Failure) -> str:
    if number == 1:
        _refuse_utf16(line, name, failure)
    if b"\0" in line:
        raise failure(CodedText("text-nul", file=name, line=number))
    try:
        return line.decode("utf-8-sig" if number == 1 else "utf-8")
    except UnicodeDecodeError as error:
        raise failure(
            CodedText(
                "text-not-utf8",
                file=name,
                line=number,
                byte=f"{line[error.start]:02x}",
                column=error.start + 1,
            )
        ) from error


def _refuse_utf16(data: bytes, name: str, failure: Failure) -> None:
    if data.startswith(_UTF16):
        raise failure(CodedText("text-utf16", file=name))


def _unreadable(path: Path, error: Exception, failure: Failure) -> Recon4Error:
    reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return failure(f"{path.name[:200]}: cannot be read: {reason}")
