"""Functions that tests run on workers of a cluster."""

from __future__ import annotations

import os
import resource
import signal
import threading
import time
from pathlib import Path

from recon4.errors import CorruptFile
from recon4.executors.executor import Say
from recon4.orders.on_worker import PartTask, make_part


def double(task: int, say: Say) -> int:
    say(str(task), "doubled")
    return 2 * task


def refuse(task: str, say: Say) -> str:
    raise CorruptFile(f"{task}: damaged")


def die_first(task: str, say: Say) -> str:
    """End this worker as a power cut does; the next one to try returns who was killed."""
    killed = Path(task)
    if not killed.exists():
        killed.write_text(str(os.getpid()), "ascii")
        os.kill(os.getpid(), signal.SIGKILL)
    return killed.read_text("ascii")


def always_die(task: str, say: Say) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def until_stopped(task: str, say: Say) -> None:
    """Say something for ever; when that is refused, leave a file. An empty name ends at once."""
    pause = threading.Event()
    try:
        while task:
            say(task, "runs")
            pause.wait(0.05)
    finally:
        if task:
            Path(task).write_text("stopped", "ascii")


def make_part_and_die_once(task: PartTask, say: Say) -> str:
    """End the worker when it has made its first part, before anybody hears of it."""
    failure = make_part(task, say)
    killed = Path(task.project) / "killed"
    if not killed.exists():
        killed.write_text(str(task.item), "ascii")
        os.kill(os.getpid(), signal.SIGKILL)
    return failure


def make_part_with_full_disk(task: PartTask, say: Say) -> str:
    """Make a part; the first worker that comes can write no file of more than 4 KiB."""
    full = Path(task.project) / "full"
    try:
        full.touch(exist_ok=False)
        full.write_text(str(os.getpid()), "ascii")
        _, most = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, most))  # its makers inherit it
    except FileExistsError:
        pass
    return make_part(task, say)


def make_part_slowly(task: PartTask, say: Say) -> str:
    """Make a part, on the first worker that comes ten times as slowly as on others."""
    slow = Path(task.project) / "slow"
    try:
        slow.touch(exist_ok=False)
        slow.write_text(str(os.getpid()), "ascii")
    except FileExistsError:
        pass
    began_s = time.monotonic()
    failure = make_part(task, say)
    if slow.read_text("ascii") == str(os.getpid()):
        threading.Event().wait(9.0 * (time.monotonic() - began_s))
    return failure
