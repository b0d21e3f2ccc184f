"""``events.jsonl``: the progress and events of a worker, one JSON object per line.

    {"t": s, "kind": "run"}                                     a worker began
    {"t": s, "kind": "progress", "what", "done", "total", "unit", "seconds"}
    {"t": s, "kind": EVENT, …}                                  any event of a stage, with its facts

``t`` is in seconds since 1970. The file is appended to and not needed to resume.
"""

from __future__ import annotations

import contextlib
import json
import logging
import time
from pathlib import Path
from typing import Any

from recon4.errors import Cancelled, StoreError
from recon4.store.json_files import parse_object

log = logging.getLogger("recon4.job")

MANY = frozenset({"edge", "nodes", "poses", "verdicts"})
"""Events the viewer draws; the log would drown in them."""
EVERY_S = 0.25
"""Counts are written, and the wish to stop is read, at most this often [s]."""


MOST_BYTES = 4 << 20
"""Read at a time."""


class EventWriter:
    """A `recon4.progress.Progress` that writes lines, and stops the run once a file appears.

    It touches the heartbeat when work advances and at no other time: a worker whose work hangs
    must look hung from outside.
    """

    def __init__(self, folder: Path) -> None:
        self._file = (folder / "events.jsonl").open("ab", buffering=0)
        self._file.write(b"\n")  # ends a line that a killed worker left half written
        self._stop, self._heartbeat = folder / "cancel", folder / "heartbeat"
        self._beat_due_s = 0.0
        self._what, self._unit = "", ""
        self._done, self._total = 0, 0
        self._began_s = self._due_s = 0.0
        self._write("run", {})

    def start(self, what: str, total: int, unit: str) -> None:
        """Begin a piece of work of ``total`` units (0 = unknown)."""
        self._what, self._unit, self._done, self._total = what, unit, 0, total
        self._began_s = time.monotonic()
        log.info("%s: %s %s", what, total or "?", unit)
        self._beat()
        self._tell()

    def advance(self, done: int = 1) -> None:
        """Say that ``done`` more units are finished.

        Raises:
            Cancelled: If the server asked to stop.
        """
        self._done += done
        if done > 0:
            self._beat()
        if time.monotonic() >= self._due_s or self._done == self._total:
            self._tell()

    def event(self, kind: str, **facts: object) -> None:
        """Say what was found."""
        self._beat()
        if kind not in MANY:
            log.info(
                "%s %s",
                kind,
                " ".join(str(value) for name, value in facts.items() if name != "key"),
            )
        self._write(kind, facts)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _beat(self) -> None:
        now_s = time.monotonic()
        if now_s >= self._beat_due_s:
            self._beat_due_s = now_s + EVERY_S
            with contextlib.suppress(OSError):  # the work itself reports a full disk
                self._heartbeat.touch()

    def _tell(self) -> None:
        now_s = time.monotonic()
        self._due_s = now_s + EVERY_S
        facts = {"what": self._what, "done": self._done, "total": self._total, "unit": self._unit}
        self._write("progress", {**facts, "seconds": round(now_s - self._began_s, 3)})
        if self._stop.exists():
            raise Cancelled("stopped on request; finished stages are kept")

    def _write(self, kind: str, facts: dict[str, Any]) -> None:
        line = json.dumps({"t": round(time.time(), 3), **facts, "kind": kind}, default=str)
        self._file.write(line.encode() + b"\n")


def read_events(path: Path, offset: int) -> tuple[list[dict[str, Any]], int]:
    """Events written since a byte offset, and the offset to ask from next time.

    A line still being written is left for the next call; one cut by a kill is skipped.
    """
    try:
        with path.open("rb") as file:
            file.seek(offset)
            data = file.read(MOST_BYTES)
    except FileNotFoundError:
        return [], offset
    whole = data[: data.rfind(b"\n") + 1]
    if not whole and len(data) == MOST_BYTES:
        whole = data  # a line longer than any of ours
    found = (_event(line) for line in whole.splitlines())
    return [event for event in found if event is not None], offset + len(whole)


def _event(line: bytes) -> dict[str, Any] | None:
    try:
        return parse_object(line, "an event")
    except StoreError:
        return None
