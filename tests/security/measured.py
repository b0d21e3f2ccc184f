"""Calls readers in a child under a memory limit, and measures what they take."""

from __future__ import annotations

import multiprocessing
import os
import resource
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

Call = tuple[Callable[..., object], tuple[Any, ...]]
"""A function and its arguments."""
LIMIT_BYTES = 1 << 30
DEADLINE_S = 10.0


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a call ended."""

    error: str
    """Name of the error's class; empty = it returned."""
    words: str
    refused: bool
    """The error is one of ours."""
    seconds: float
    """Time of the processor: a busy computer fails no test."""
    peak_bytes: int
    """Resident memory at its highest, beyond that before the call."""


def assert_refused(outcome: Outcome, words: str) -> None:
    assert outcome.refused, f"{outcome.error}: {outcome.words}"
    assert words in outcome.words
    assert len(outcome.words) < 1000
    assert outcome.seconds <= DEADLINE_S
    assert outcome.peak_bytes <= LIMIT_BYTES


class MeasuredChild:
    """A child that may take `LIMIT_BYTES` beyond what it has after its imports."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def call(self, function: Callable[..., object], *arguments: Any) -> Outcome:
        """Call a function of a module in the child; a generator is read to its end."""
        self._connection.send((function, arguments))
        if not self._connection.poll(60.0):
            raise AssertionError(f"{function.__name__} does not end within 60 s")
        outcome: Outcome = self._connection.recv()
        return outcome


@contextmanager
def measured_child(*warm_up: Call) -> Iterator[MeasuredChild]:
    """Start a child; ``warm_up`` calls import libraries and load kernels before it is limited."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    child = context.Process(target=_serve, args=(theirs, warm_up), daemon=True)
    child.start()
    theirs.close()
    try:
        yield MeasuredChild(ours)
    finally:
        ours.close()
        child.join(10.0)
        child.kill()
        child.join()


def _serve(connection: Connection, warm_up: tuple[Call, ...]) -> None:
    warnings.simplefilter("ignore")
    for function, arguments in warm_up:
        _measure(function, arguments)
    limit = _status("VmSize") + LIMIT_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    try:
        while True:
            function, arguments = connection.recv()
            connection.send(_measure(function, arguments))
    except EOFError:
        return


def _measure(function: Callable[..., object], arguments: tuple[Any, ...]) -> Outcome:
    from recon4.errors import Recon4Error

    Path("/proc/self/clear_refs").write_text("5", "ascii")  # the peak starts from here
    before, start = _status("VmRSS"), time.process_time()
    error: BaseException | None = None
    try:
        found = function(*arguments)
        for _ in found if isinstance(found, Iterator) else ():
            pass
    except Exception as raised:
        error = raised
    return Outcome(
        type(error).__name__ if error else "",
        str(error) if error else "",
        isinstance(error, Recon4Error),
        time.process_time() - start,
        _status("VmHWM") - before,
    )


def _status(key: str) -> int:
    lines = Path(f"/proc/{os.getpid()}/status").read_text("ascii").splitlines()
    return next(int(line.split()[1]) << 10 for line in lines if line.startswith(f"{key}:"))
