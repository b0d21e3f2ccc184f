"""Run mutants through the real readers in a child, and count how it ends."""

from __future__ import annotations

import contextlib
import json
import selectors
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

ROOT = Path(__file__).parents[3]
HANG_S = 10.0
START_S = 120.0
"""The child imports the readers and reads the seeds before the first mutant."""
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


def fuzz(kind: str, *, count: int, seed: int, first: int = 0, hang_s: float = HANG_S) -> Tally:
    """Read ``count`` mutants of a kind, from number ``first`` on.

    Args:
        kind: Name of one of ``KINDS``.
        count: How many.
        seed: Other seeds give other mutants.
        first: Number of the first one.
        hang_s: A reader that takes longer hangs [s].
    """
    tally = Tally(kind, seed)
    number, stop = first, first + count
    with tempfile.TemporaryDirectory(prefix="fuzz-", dir=_fast_folder()) as place:
        while number < stop:
            batch = range(number, min(stop, number + BATCH))
            number = _batch(tally, batch, Path(place), hang_s=hang_s)
    return tally


def _batch(tally: Tally, batch: range, place: Path, *, hang_s: float) -> int:
    """Read with one child until it is done or dies; returns the next number to read."""
    running = -1
    first, stop = batch.start, batch.stop
    with tempfile.TemporaryFile() as errors, tempfile.TemporaryDirectory(dir=place) as folder:
        arguments = [tally.kind, str(tally.seed), str(first), str(stop), folder]
        with _child(arguments, errors) as child:
            for line in _lines(child, hang_s):
                if "start" in line:
                    running = line["start"]
                    continue
                tally.add(line["number"], line["outcome"], line["words"], line["how"])
                if line["number"] == stop - 1:
                    return stop
            hung = child.poll() is None
            child.kill()
            code = child.wait()
        words = _tail(errors)
        assert running >= 0, f"the child did not get to its first mutant:\n{words}"
        if hung:
            tally.add(running, "HANG", f"more than {hang_s:g} s", "")
        elif "memory allocation" in words or code == -signal.SIGKILL:
            tally.add(running, "MEMORY", words[-200:], "")
        else:
            tally.add(running, "CRASH", f"exit code {code}: {words[-200:]}", "")
    return running + 1


@contextlib.contextmanager
def _child(arguments: list[str], errors: IO[bytes]) -> Iterator[subprocess.Popen[bytes]]:
    child = subprocess.Popen(
        [sys.executable, "-m", "tests.security.fuzz.child", *arguments],
        cwd=ROOT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=errors,
    )
    try:
        yield child
    finally:
        child.kill()
        child.wait()
        if child.stdout is not None:
            child.stdout.close()


def _lines(child: subprocess.Popen[bytes], hang_s: float) -> Iterator[dict[str, Any]]:
    """What the child says, until it is done, dead, or silent for too long."""
    assert child.stdout is not None
    patience_s, rest = START_S, b""
    with selectors.DefaultSelector() as selector:
        selector.register(child.stdout, selectors.EVENT_READ)
        while selector.select(patience_s):
            data = child.stdout.read1(1 << 16)  # type: ignore[attr-defined]
            if not data:
                child.wait()
                return
            *lines, rest = (rest + data).split(b"\n")
            yield from (json.loads(line) for line in lines)
            patience_s = hang_s


def _tail(errors: IO[bytes]) -> str:
    errors.seek(0)
    return errors.read()[-2000:].decode("utf-8", "replace")


def _fast_folder() -> str | None:
    return "/dev/shm" if Path("/dev/shm").is_dir() else None
