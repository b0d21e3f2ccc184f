"""Processes one walk in a process of its own: confined, ended with its parent, resumable."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import IO

from recon4.batch.tuning import BATCH
from recon4.batch.walks import WalkTask
from recon4.executors.executor import Say


@dataclass(frozen=True, slots=True)
class WalkOutcome:
    """How the process of a walk ended; the results are files of its project."""

    exit_code: int
    complaint: str
    """What it complained of; empty if it was done."""


def process_walk(task: WalkTask, say: Say) -> WalkOutcome:
    """Run ``recon4 process`` on a walk; a project that exists is continued.

    Args:
        task: The walk.
        say: Receives the lines of progress.

    Raises:
        Cancelled: If the receiver of the lines requests to stop; the process is ended.
    """
    command = [sys.executable, "-P", "-m", "recon4.batch.child", "process", task.recording]
    with subprocess.Popen(
        [*command, "--out", task.out, *task.options],
        stdin=subprocess.PIPE,  # its lifeline
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,  # Ctrl-C is for the batch
        text=True,
        errors="replace",
    ) as process:
        assert process.stderr is not None
        try:
            last = _forward(process.stderr, task.name, say)
        except BaseException:
            process.terminate()
            raise
        return WalkOutcome(process.wait(), _complaint(process.returncode, last))


def _forward(lines: IO[str], name: str, say: Say) -> Iterable[str]:
    last: deque[str] = deque(maxlen=BATCH.last_lines)
    for line in lines:
        text = line.rstrip()
        last.append(text)
        say(name, text)
    return last


def _complaint(exit_code: int, last: Iterable[str]) -> str:
    if exit_code == 0:
        return ""
    if exit_code < 0:
        return (
            f"ended by {signal.Signals(-exit_code).name}"
            + (": too little memory?" if exit_code == -signal.SIGKILL else "")
            + "; the same command goes on after its last finished stage"
        )
    own = [line.removeprefix("recon4: ") for line in last if line.startswith("recon4: ")]
    return own[-1] if own else (list(last) or ["no message"])[-1]
