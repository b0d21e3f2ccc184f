"""``events.jsonl``: the events of a worker (`recon4.model.events`), one JSON object per line.

The file is appended to and not needed to resume.
"""

from __future__ import annotations

import contextlib
import json
import logging
import time
from collections.abc import Mapping
from pathlib import Path

import msgspec

from recon4.errors import Cancelled, StoreError
from recon4.findings.wording import whole_text
from recon4.locales.coded import CodedText
from recon4.model.events import KINDS, Event, Remarked, RunStarted, WorkProgress
from recon4.model.plain import to_plain
from recon4.store.json_files import parse_object
from recon4.untrusted.typed import as_type
from recon4_app.jobs.folder import beat
from recon4_app.jobs.tuning import EVENT_LIMITS

log = logging.getLogger("recon4.job")

MANY = frozenset({"edge", "nodes", "poses", "verdicts"})
"""Events the viewer draws; they are too many for the text log."""


class EventWriter:
    """A `recon4.progress.Progress` that writes lines, and stops the run once a file appears.

    It renews the heartbeat only when work advances, so that a worker whose work hangs is found.
    """

    def __init__(self, folder: Path) -> None:
        self._file = (folder / "events.jsonl").open("ab", buffering=0)
        self._file.write(b"\n")  # ends a line that a killed worker left half written
        self._stop, self._heartbeat = folder / "cancel", folder / "heartbeat"
        self._beat_due_s = 0.0
        self._what, self._unit = "", ""
        self._done, self._total = 0, 0
        self._began_s = self._due_s = 0.0
        self._write(RunStarted())

    def start(self, what: str, total: int, unit: str) -> None:
        """Begin a piece of work of ``total`` units (0 = unknown)."""
        self._what, self._unit, self._done, self._total = what, unit, 0, total
        self._began_s = time.monotonic()
        log.info("%s: %s %s", what, total or "?", unit)
        self._beat()
        self._report()

    def advance(self, done: int = 1) -> None:
        """Count ``done`` more finished units.

        Raises:
            Cancelled: If the server requested to stop.
        """
        self._done += done
        if done > 0:
            self._beat()
        if time.monotonic() >= self._due_s or self._done == self._total:
            self._report()

    def event(self, event: Event) -> None:
        """Write an event of a stage."""
        self._beat()
        if isinstance(event, Remarked):
            log.info("warning %s", whole_text(event.finding))
        elif event.kind not in MANY:
            shown = [value for name, value in _facts(event).items() if name != "key"]
            log.info("%s %s", event.kind, " ".join(str(v) for v in shown if v is not None))
        self._write(event)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _beat(self) -> None:
        now_s = time.monotonic()
        if now_s >= self._beat_due_s:
            self._beat_due_s = now_s + EVENT_LIMITS.every_s
            with contextlib.suppress(OSError):  # the work itself reports a full disk
                beat(self._heartbeat)

    def _report(self) -> None:
        now_s = time.monotonic()
        self._due_s = now_s + EVENT_LIMITS.every_s
        self._write(
            WorkProgress(
                what=self._what,
                done=self._done,
                total=self._total,
                unit=self._unit,
                seconds=round(now_s - self._began_s, 3),
            )
        )
        if self._stop.exists():
            raise Cancelled(CodedText("job-stopped"))

    def _write(self, event: Event) -> None:
        line = {"t": round(time.time(), 3), **_facts(event), "kind": event.kind}
        self._file.write(json.dumps(line).encode() + b"\n")


def _facts(event: Event) -> dict[str, object]:
    """The fields of an event as JSON values, without its time."""
    fields: dict[str, object] = to_plain(event)
    del fields["t"]
    return fields


def read_events(path: Path, offset: int) -> tuple[list[Event], int]:
    """Events written since a byte offset, and the offset for the next call.

    A line still being written is left for the next call. Lines that a kill has cut, malformed ones
    and unknown kinds are skipped.
    """
    try:
        with path.open("rb") as file:
            file.seek(offset)
            data = file.read(EVENT_LIMITS.max_bytes)
    except FileNotFoundError:
        return [], offset
    whole = data[: data.rfind(b"\n") + 1]
    if not whole and len(data) == EVENT_LIMITS.max_bytes:
        whole = data  # a line longer than any of ours
    found = (_parse(line) for line in whole.splitlines())
    return [event for event in found if event is not None], offset + len(whole)


def _parse(line: bytes) -> Event | None:
    try:
        return event_of(parse_object(line, "an event"))
    except StoreError:
        return None


def event_of(fields: Mapping[str, object]) -> Event | None:
    """The record of an event's JSON object; None if it is malformed or of an unknown kind."""
    record = KINDS.get(str(fields.get("kind")))
    if record is None:
        return None
    try:
        return as_type(fields, record)
    except msgspec.ValidationError:
        return None
