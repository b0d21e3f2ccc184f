"""Compile the kernels once, before the first worker reads a user's file.

A confined process must not write code that other processes load, so what it compiles is lost with
it (`recon4.system.compile_kernels`). A server of a new installation begins with that at once; a
worker waits for it, outside its confinement.
"""

from __future__ import annotations

import contextlib
import logging
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from recon4.errors import Cancelled
from recon4.sandbox.private_cache import is_compiled
from recon4_app.jobs.events import EventWriter
from recon4_app.jobs.folder import beat
from recon4_app.jobs.tuning import COMPILING_TIMES

log = logging.getLogger("recon4.job")


@contextmanager
def compiling_beside() -> Iterator[None]:
    """Compile the kernels in another process meanwhile, unless they are; it ends with the block."""
    if is_compiled():
        yield
        return
    child = _start()
    os.setpriority(os.PRIO_PROCESS, child.pid, COMPILING_TIMES.niceness)
    try:
        yield
    finally:
        child.terminate()
        child.wait()


def compile_kernels_once(folder: Path) -> None:
    """Compile the kernels unless they are, or wait for who does; a failure is only logged.

    Args:
        folder: Of the job: its heartbeat is renewed meanwhile, and its status says what is done.
    """
    if is_compiled():
        return
    log.info("compiling the kernels: once after an installation, some minutes")
    _say(folder)
    heartbeat = folder / "heartbeat"
    child = _start()
    deadline_s = time.monotonic() + COMPILING_TIMES.within_s
    while time.monotonic() < deadline_s:
        beat(heartbeat)
        with contextlib.suppress(subprocess.TimeoutExpired):
            if child.wait(COMPILING_TIMES.beat_every_s):
                break
            return
    child.kill()
    child.wait()
    log.warning("the kernels could not be compiled ahead; every job compiles its own")


def _say(folder: Path) -> None:
    """The status of the job is what is compiled, until its work begins."""
    with contextlib.closing(EventWriter(folder)) as events, contextlib.suppress(Cancelled):
        events.start("compile", 0, "kernels")


def _start() -> subprocess.Popen[bytes]:
    command = [sys.executable, "-P", "-m", "recon4", "compile"]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
