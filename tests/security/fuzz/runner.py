"""Run mutants through the real readers in a child, and count how it ends."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

ROOT = Path(__file__).parents[3]
HANG_S = 10.0
START_S = 600.0
"""The child imports the readers and reads the seeds before the first mutant."""
STARVED_S = 600.0
"""A reader that is ready to run but gets no processor on a busy computer does not hang."""
BATCH = 2500
"""Mutants of one child: what a library leaks stays small against the limit of memory."""
GOOD = ("ok", "rejected", "salvaged")


@dataclass(frozen=True, slots=True)
class Finding:
    """A mutant that ended as none may."""

    number: int
    outcome: str
    words: str
    how: str


@dataclass(slots=True)
class Tally:
    """How the mutants of a kind ended."""

    kind: str
    seed: int
    outcomes: Counter[str] = field(default_factory=Counter)
    findings: list[Finding] = field(default_factory=list)

    @property
    def mutants(self) -> int:
        """How many were read."""
        return sum(self.outcomes.values())

    def add(self, number: int, outcome: str, words: str, how: str) -> None:
        """Count one."""
        self.outcomes[outcome] += 1
        if outcome not in GOOD:
            self.findings.append(Finding(number, outcome, words, how))


class Readers:
    """The process with the readers; a context manager."""

    def __init__(self) -> None:
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - closed by __exit__
        self._child = subprocess.Popen(
            [sys.executable, "-m", "tests.security.fuzz.child"],
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        )
        self._rest = b""
        self._lines: list[bytes] = []
        self._next(START_S)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._child.kill()
        self._child.wait()
        for stream in (self._child.stdin, self._child.stdout, self._errors):
            if stream is not None:
                stream.close()

    def read(self, tally: Tally, batch: range, folder: Path, *, hang_s: float) -> int:
        """Read mutants until the batch is done or its process dies; the next number to read."""
        assert self._child.stdin is not None
        request = {"kind": tally.kind, "seed": tally.seed, "folder": str(folder)}
        request |= {"first": batch.start, "stop": batch.stop}
        began = self._errors.seek(0, os.SEEK_END)
        self._child.stdin.write(json.dumps(request).encode() + b"\n")
        self._child.stdin.flush()
        pid, running, hung = 0, -1, False
        since = used_s = 0.0
        wait_s: float = START_S
        while True:
            line = self._next(wait_s)
            if line is None:
                assert pid, f"the readers do not start: {self._tail(began)}"
                if (wait_s := _patience_s(pid, used_s, hang_s, time.monotonic() - since)) > 0:
                    continue
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
                hung, wait_s = True, START_S
            elif "pid" in line:
                pid, wait_s = line["pid"], hang_s
            elif "start" in line:
                running, since, used_s = line["start"], time.monotonic(), _processor_s(pid)
                wait_s = hang_s
            elif "end" in line:
                break
            else:
                tally.add(line["number"], line["outcome"], line["words"], line["how"])
        if line["end"] == 0:
            return batch.stop
        words = self._tail(began)
        assert running >= 0, f"the readers did not get to the first mutant: {words}"
        if hung:
            tally.add(running, "HANG", f"more than {hang_s:g} s", "")
        elif "memory allocation" in words:
            tally.add(running, "MEMORY", words[-200:], "")
        else:
            tally.add(running, "CRASH", f"exit code {line['end']}: {words[-200:]}", "")
        return running + 1

    def _next(self, wait_s: float) -> dict[str, Any] | None:
        """The next line; None if there is none for so long."""
        assert self._child.stdout is not None
        while not self._lines:
            ready, _, _ = select.select([self._child.stdout], [], [], wait_s)
            if not ready:
                return None
            data = os.read(self._child.stdout.fileno(), 1 << 16)
            if not data:
                raise AssertionError(f"the process with the readers is gone: {self._tail(0)}")
            *self._lines, self._rest = (self._rest + data).split(b"\n")
        found: dict[str, Any] = json.loads(self._lines.pop(0))
        return found

    def _tail(self, start: int) -> str:
        self._errors.seek(start)
        return self._errors.read()[-2000:].decode("utf-8", "replace")


def fuzz(
    kind: str,
    readers: Readers,
    *,
    count: int,
    seed: int,
    first: int = 0,
    hang_s: float = HANG_S,
) -> Tally:
    """Read ``count`` mutants of a kind, from number ``first`` on.

    Args:
        kind: Name of one of ``KINDS``.
        readers: The process that reads.
        count: How many.
        seed: Other seeds give other mutants.
        first: Number of the first one.
        hang_s: A reader that takes longer hangs [s].
    """
    tally = Tally(kind, seed)
    number, stop = first, first + count
    while number < stop:
        batch = range(number, min(stop, number + BATCH))
        with tempfile.TemporaryDirectory(prefix="fuzz-", dir=fast_folder()) as folder:
            number = readers.read(tally, batch, Path(folder), hang_s=hang_s)
    return tally


def _patience_s(pid: int, used_before_s: float, hang_s: float, waited_s: float) -> float:
    """How long a reader that has not answered may go on [s]: 0 = it hangs.

    It hangs if it sleeps, or if it used that much processor time for one file.
    """
    state = (_fields(pid) or ["R"])[0]
    left_s = hang_s - (_processor_s(pid) - used_before_s)
    return max(1.0, left_s) if state in "RDZ" and left_s > 0 and waited_s < STARVED_S else 0.0


def _processor_s(pid: int) -> float:
    """Processor time a process has used [s]."""
    fields = _fields(pid)
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK") if fields else 0.0


def _fields(pid: int) -> list[str]:
    """Of ``/proc/PID/stat``, from the state on; none if the process is gone."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return []


def fast_folder() -> str | None:
    """A folder in memory for the files of trials, if there is one."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
