"""What a run says while it runs, as one JSON object a line in ``events.jsonl``.

The file is for whoever watches from another process (the server, ``tail -f``). It is appended to,
never rewritten, and not needed to resume: what is finished stands in the ledger.
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from types import TracebackType
from typing import Any

from recon4.errors import StoreError
from recon4.progress import Progress
from recon4.store.atomic import raise_if_full

FILE_NAME = "events.jsonl"
_EVERY_S = 0.5


class EventLog:
    """Passes everything on to another watcher and writes it down (format: ``docs/stages.md``)."""

    def __init__(self, root: Path, onward: Progress) -> None:
        """Begin a run in the project's file.

        Raises:
            StoreError: If the file cannot be written.
        """
        self._path = root / FILE_NAME
        self._onward = onward
        self._what, self._unit = "", ""
        self._done, self._total = 0, 0
        self._began_s, self._written_s = 0.0, 0.0
        try:
            self._file = self._path.open("ab", buffering=0)
        except OSError as error:
            raise StoreError(f"cannot write {self._path}: {error.strerror}") from error
        if self._file.tell():
            self._file.write(b"\n")  # closes a line that a killed run left torn; readers skip it

    def start(self, what: str, total: int, unit: str) -> None:
        """Begin a piece of work."""
        self._flush_progress()
        self._onward.start(what, total, unit)
        self._what, self._unit, self._done, self._total = what, unit, 0, total
        self._began_s = time.monotonic()
        self._write_progress()

    def advance(self, done: int = 1) -> None:
        """Count; written down at most twice a second."""
        self._onward.advance(done)
        self._done += done
        if time.monotonic() - self._written_s >= _EVERY_S:
            self._write_progress()

    def event(self, kind: str, **facts: object) -> None:
        """Write it down at once."""
        self._flush_progress()
        self._onward.event(kind, **facts)
        self._write(kind, facts)

    def close(self) -> None:
        """Write the last count and close the file."""
        try:
            self._flush_progress()
        finally:
            self._file.close()

    def _flush_progress(self) -> None:
        if self._what:
            self._write_progress()
            self._what = ""

    def _write_progress(self) -> None:
        self._written_s = time.monotonic()
        facts = {"what": self._what, "done": self._done, "total": self._total, "unit": self._unit}
        self._write("progress", facts | {"seconds": round(self._written_s - self._began_s, 3)})

    def _write(self, kind: str, facts: dict[str, Any]) -> None:
        line = json.dumps({"t": round(time.time(), 3), "kind": kind, **facts}, default=str)
        try:
            self._file.write(line.encode() + b"\n")
        except OSError as error:
            raise_if_full(error, self._path)
            raise StoreError(f"cannot write {self._path}: {error.strerror}") from error

    def __enter__(self) -> EventLog:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self.close()


def read_events(root: Path, offset: int = 0) -> tuple[list[dict[str, Any]], int]:
    """Events written since a byte offset, and the offset to ask from next time.

    A line still being written is left for the next call; a torn one is skipped. A run begins with
    an event of kind ``run``.
    """
    path = root / FILE_NAME
    if not path.is_file():
        return [], 0
    with path.open("rb") as file:
        file.seek(offset)
        whole, _, _ = file.read().rpartition(b"\n")
    events = []
    for line in whole.splitlines():
        try:
            found = json.loads(line)
        except ValueError:
            continue
        if isinstance(found, dict):
            events.append(found)
    return events, offset + len(whole) + bool(whole)
