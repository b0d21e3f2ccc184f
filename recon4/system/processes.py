"""Child processes that end with their parent, and leftovers of a parent that was killed.

A parent killed with SIGKILL cleans nothing up. So each child that must not outlive its parent
watches its *lifeline*: the read end of a pipe (or socket) whose other end only the parent holds.
The kernel closes that end with the parent, whatever ended it. ``PR_SET_PDEATHSIG`` is not used:
it fires when the parent's *thread* that started the child ends, not when the process does.
"""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import multiprocessing
import os
import select
import signal
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.system.tuning import PROCESSES

_F_SETSIG = 10
"""Linux; the module `fcntl` lacks it."""
_BOOT_ID = Path("/proc/sys/kernel/random/boot_id")
_UNKNOWN = ""


def die_with_parent(lifeline: int | None = None) -> None:
    """End this process with SIGKILL as soon as its parent has ended; call it first in a child.

    On Linux the kernel sends the signal, so that neither native code that holds the interpreter
    lock nor a blocked signal mask keeps the child alive. Elsewhere a thread waits.

    Args:
        lifeline: Read end of a pipe or socket whose other end only the parent holds and nobody
            writes to (``stdin=PIPE`` makes one: 0). None: the sentinel that `multiprocessing`
            gives each child it spawns.

    Raises:
        StoreError: If there is no lifeline: the process is no child of `multiprocessing`.
    """
    if lifeline is None:
        parent = multiprocessing.parent_process()
        if parent is None:
            raise StoreError("die_with_parent() outside a multiprocessing child needs a lifeline")
        lifeline = int(parent.sentinel)
    if sys.platform == "linux":
        fcntl.fcntl(lifeline, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(lifeline, _F_SETSIG, signal.SIGKILL)
        fcntl.fcntl(lifeline, fcntl.F_SETFL, fcntl.fcntl(lifeline, fcntl.F_GETFL) | os.O_ASYNC)
    else:
        threading.Thread(target=_wait_and_die, args=(lifeline,), daemon=True).start()
    if select.select([lifeline], [], [], 0.0)[0]:  # the parent had ended before
        os.kill(os.getpid(), signal.SIGKILL)


def _wait_and_die(lifeline: int) -> None:
    select.select([lifeline], [], [])
    os.kill(os.getpid(), signal.SIGKILL)


@dataclass(frozen=True, slots=True)
class ChildRegister:
    """Who the children of a server are, on disk: one empty file ``PID-START_TIME-BOOT`` each.

    The second net below `die_with_parent`. A process is recognized by number *and* start time
    and boot, so one that got the number of a dead child is never taken for it.
    """

    folder: Path

    def add(self, pid: int) -> None:
        """Remember a child that was just started."""
        identity = process_identity(pid)
        if identity:
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            (self.folder / identity).touch(mode=0o600)

    def remove(self, pid: int) -> None:
        """Forget a child that has ended."""
        for path in self.folder.glob(f"{pid}-*"):
            path.unlink(missing_ok=True)

    def end_leftovers(self) -> list[int]:
        """End what a killed server left running; only while no other server uses the folder.

        Returns:
            The numbers of the processes that were killed.
        """
        killed = []
        for path in sorted(self.folder.glob("*-*")):
            number = path.name.partition("-")[0]
            if number.isdigit() and process_identity(int(number)) == path.name:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(int(number), signal.SIGKILL)
                    killed.append(int(number))
            path.unlink(missing_ok=True)
        return killed


def process_identity(pid: int) -> str:
    """``PID-START_TIME-BOOT`` of a process that runs; empty if none does or there is no /proc."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        boot = _BOOT_ID.read_text().strip()
    except OSError:
        return _UNKNOWN
    state, start_ticks = fields[0], fields[19]
    return _UNKNOWN if state in "ZX" else f"{pid}-{start_ticks}-{boot}"


async def first_line(process: asyncio.subprocess.Process, *, within_s: float) -> bytes:
    """Read the first line of a child's output.

    Args:
        process: The child, with a pipe as output.
        within_s: How long the child may take [s]; time in which it was ready to run but other
            programs had the processors does not count.

    Returns:
        The line; empty if the child ended without one, or took too long.
    """
    assert process.stdout is not None
    began_s = time.monotonic()
    line = asyncio.ensure_future(process.stdout.readline())
    try:
        while time.monotonic() - began_s - waited_for_processor_s(process.pid) < within_s:
            done, _ = await asyncio.wait({line}, timeout=min(PROCESSES.looks_every_s, within_s))
            if done:
                return line.result()
        return b""
    finally:
        line.cancel()


def waited_for_processor_s(pid: int) -> float:
    """Time the first thread of a process was ready to run but did not [s]; 0 if unknown."""
    try:
        return int(Path(f"/proc/{pid}/schedstat").read_text("ascii").split()[1]) / 1e9
    except (OSError, ValueError, IndexError):
        return 0.0
