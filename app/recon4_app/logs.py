"""The log of a process: one line a record, without control characters, limited in rate and size.

Anyone who reaches the port can cause log records: a malformed request, a failed handshake. Records
that repeat are counted instead of written, and files rotate, so that a client cannot fill the disk.
"""

from __future__ import annotations

import json
import logging
import threading
import time
from collections import Counter, OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from logging.handlers import RotatingFileHandler
from pathlib import Path

from recon4_app.tuning import LOGS


def printable(text: str) -> str:
    """The text with control and formatting characters written as escapes, on one line.

    A line feed would forge a record, an escape sequence would act on the terminal, and U+202E
    would show the rest of the line backwards.
    """
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


class RepeatFilter(logging.Filter):
    """Drops records that repeat too often; the next one written has their count."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._clock = clock
        self._written: OrderedDict[object, tuple[int, int]] = OrderedDict()
        self._dropped: Counter[object] = Counter()
        self._lock = threading.Lock()
        self.dropped = 0
        """Records dropped since the start."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether to write a record; the result is the same for every handler."""
        known: bool | None = getattr(record, "is_written", None)
        if known is None:
            known = record.is_written = self._judge(record)
        return known

    def _judge(self, record: logging.LogRecord) -> bool:
        kind = (record.name, record.levelno, str(record.msg))
        minute = int(self._clock() // 60.0)
        with self._lock:
            allowed = self._count(kind, minute) <= LOGS.repeats_a_minute
            allowed = allowed and self._count(record.name, minute) <= LOGS.records_a_minute
            if not allowed:
                self._dropped[kind] += 1
                self.dropped += 1
                return False
            if repeated := self._dropped.pop(kind, 0):
                record.msg = f"{record.getMessage()} ({repeated} more like this were not written)"
                record.args = ()
        return True

    def _count(self, key: object, minute: int) -> int:
        then, count = self._written.get(key, (minute, 0))
        count = count + 1 if then == minute else 1
        self._written[key] = (minute, count)
        self._written.move_to_end(key)
        while len(self._written) > LOGS.max_kinds:
            forgotten, _ = self._written.popitem(last=False)
            self._dropped.pop(forgotten, None)
        return count


class LineFormatter(logging.Formatter):
    """For people: time, level, logger and message on one line, a traceback below it."""

    def format(self, record: logging.LogRecord) -> str:
        """One record."""
        at = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(record.created))
        message = printable(record.getMessage()[: LOGS.max_message_chars])
        lines = [f"{at} {record.levelname} {record.name}: {message}"]
        if record.exc_info:
            lines += map(printable, self.formatException(record.exc_info).splitlines())
        return "\n".join(lines)


class JsonFormatter(logging.Formatter):
    """For programs: one JSON object a line."""

    def format(self, record: logging.LogRecord) -> str:
        """One record."""
        fields = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname,
            "logger": record.name,
            "message": printable(record.getMessage()[: LOGS.max_message_chars]),
        }
        if record.exc_info:
            trace = self.formatException(record.exc_info).splitlines()
            fields["exception"] = "\n".join(map(printable, trace))
        return json.dumps(fields)


class QuietRotatingFile(RotatingFileHandler):
    """A rotating log file whose own failures, such as a full disk, cause no further output."""

    failures = 0
    """Records that could not be written."""

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802 - name of the library
        """Count."""
        self.failures += 1

    def close(self) -> None:
        """Close; records that a full disk cannot take are lost."""
        with suppress(OSError):
            super().close()


class Logs:
    """The log handlers of a process, with counts of dropped records."""

    def __init__(self, file: Path | None = None, *, level: int = logging.WARNING) -> None:
        """Prepare.

        Args:
            file: Also write JSON there, rotated; None = only to the standard error output.
            level: Less severe records are not written.
        """
        self._filter = RepeatFilter()
        self._level = level
        self._handlers: list[logging.Handler] = [logging.StreamHandler()]
        self._handlers[0].setFormatter(LineFormatter())
        self._file: QuietRotatingFile | None = None
        if file is not None:
            self._file = QuietRotatingFile(
                file,
                maxBytes=LOGS.max_log_bytes,
                backupCount=LOGS.kept_logs - 1,
                encoding="utf-8",
                delay=True,
            )
            self._file.setFormatter(JsonFormatter())
            self._handlers.append(self._file)

    @property
    def dropped(self) -> int:
        """Records not written because they repeated."""
        return self._filter.dropped

    @property
    def failures(self) -> int:
        """Records the file could not take."""
        return 0 if self._file is None else self._file.failures

    @contextmanager
    def installed(self) -> Iterator[None]:
        """Install the handlers at the root logger for the duration."""
        root = logging.getLogger()
        before = root.level
        root.setLevel(self._level)
        if self._file is not None:
            Path(self._file.baseFilename).parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        for handler in self._handlers:
            handler.addFilter(self._filter)
            root.addHandler(handler)
        try:
            yield
        finally:
            root.setLevel(before)
            for handler in self._handlers:
                root.removeHandler(handler)
                handler.close()


def rotate_grown(
    path: Path, *, max_bytes: int = LOGS.max_log_bytes, kept: int = LOGS.kept_logs
) -> bool:
    """Rotate a log that another process appends to, by copying and truncating it.

    A worker and the native libraries in it write to an inherited descriptor, so renaming the file
    would change nothing. What they write between copy and truncation is lost: some lines at most.

    Args:
        path: The log; it need not exist.
        max_bytes: It is rotated when it has grown beyond this.
        kept: Files kept, the present one included.

    Returns:
        Whether it was rotated.
    """
    try:
        if path.stat().st_size <= max_bytes:
            return False
    except FileNotFoundError:
        return False
    numbered = [path.with_name(f"{path.name}.{number}") for number in range(1, kept)]
    for older, newer in zip(reversed(numbered[1:]), reversed(numbered[:-1]), strict=True):
        if newer.exists():
            newer.replace(older)
    if numbered:
        _copy_end(path, numbered[0], max_bytes)
    with path.open("r+b") as file:
        file.truncate(0)
    return True


def _copy_end(source: Path, target: Path, max_bytes: int) -> None:
    """Copy the last bytes of a file; one that grew fast is not kept whole."""
    with source.open("rb") as reading, target.open("wb") as writing:
        size = reading.seek(0, 2)
        reading.seek(max(0, size - max_bytes))
        left = max_bytes
        while left > 0 and (piece := reading.read(min(1 << 20, left))):
            writing.write(piece)
            left -= len(piece)
