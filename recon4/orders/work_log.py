"""Which workers make the parts of an order: what the page of a job shows, and lines of its log."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from recon4.executors.executor import Say
from recon4.orders.on_worker import PartTask, make_part, worker_name
from recon4.untrusted.names import visible


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerRecord:
    """What one worker has done of a job."""

    name: str
    """Its computer and process."""
    part: str = ""
    """What it makes now; empty = nothing."""
    made: int = 0
    """Parts that it has made."""
    failed: int = 0
    """Parts that it could not make."""
    seconds: float = 0.0
    """Time for these parts together [s]."""


@dataclass(frozen=True, slots=True)
class PartReport:
    """What a worker says of a part; sent back to who ordered it."""

    worker: str
    """Computer and process."""
    seconds: float
    """Time that it took [s]."""
    failure: str
    """Why it could not be made; empty = it is made."""


def report_part(task: PartTask, say: Say) -> PartReport:
    """Make a part on a worker, and say who it is before."""
    began_s, name = time.monotonic(), worker_name()
    say(str(task.item), name)
    failure = make_part(task, say)
    return PartReport(name, time.monotonic() - began_s, failure)


@dataclass(slots=True)
class WorkLog:
    """Who works; several threads report to it."""

    changed: Callable[[tuple[WorkerRecord, ...]], object]
    """Receives all workers after each change."""
    log: Callable[[str], object]
    """Receives lines about workers."""
    _records: dict[str, WorkerRecord] = field(default_factory=dict)
    _makes: dict[str, str] = field(default_factory=dict)
    """Part of the present order by its number -> the worker that makes it; empty = it has ended."""
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def order(self) -> None:
        """An order begins."""
        with self._lock:
            self._makes.clear()

    def begins(self, item: str, worker: str, part: str) -> None:
        """A worker begins a part; a line that arrives after the part has ended is too late."""
        with self._lock:
            before, name = self._makes.get(item), visible(worker)
            if before == "":
                return
            self._makes[item] = name
            if before and before != name:  # it was killed, or is out of reach
                self._change(before, part="")
            if name not in self._records:
                self.log(f"{name} makes parts")
            self._change(name, part=part)
            self._tell()

    def ends(self, item: str, report: PartReport) -> None:
        """A worker has ended a part."""
        with self._lock:
            self._makes[item] = ""
            name = visible(report.worker)
            known = self._records.get(name) or WorkerRecord(name=name)
            self._change(
                name,
                part="",
                made=known.made + (not report.failure),
                failed=known.failed + bool(report.failure),
                seconds=round(known.seconds + report.seconds, 3),
            )
            self._tell()

    def lost(self, item: str) -> None:
        """A part has ended without a word of its worker."""
        with self._lock:
            if name := self._makes.get(item):
                self._change(name, part="")
            self._makes[item] = ""
            self._tell()

    def over(self) -> None:
        """The order is over: nobody works any more."""
        with self._lock:
            for name, record in sorted(self._records.items()):
                self._change(name, part="")
                failed = f", {record.failed} failed" if record.failed else ""
                self.log(f"{name}: {record.made} parts in {record.seconds:.1f} s{failed}")
            self._tell()

    def _change(self, name: str, **changes: Any) -> None:
        known = self._records.get(name) or WorkerRecord(name=name)
        self._records[name] = replace(known, **changes)

    def _tell(self) -> None:
        self.changed(tuple(self._records[name] for name in sorted(self._records)))
