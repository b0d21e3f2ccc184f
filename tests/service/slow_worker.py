"""A worker with real stages of which the second waits at a gate (a FIFO) the test opens."""

from __future__ import annotations

import ctypes
import errno
import logging
import os
import resource
import select
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.errors import EmptyRecording
from recon4.progress import Progress
from recon4.sandbox import Policy
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.project import Project
from recon4.store.stage import Input, Stage, StageContext, StageRunner
from recon4.system.stopping import end_process
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.limits import worker_policy
from recon4_app.jobs.worker import main, titled


def take_memory(_: Path) -> None:
    _ = np.ones((1 << 40) // 8)


def fill_disk(_: Path) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


def leave_a_child(_: Path) -> None:
    subprocess.Popen(["sleep", "600"])
    os.kill(os.getpid(), signal.SIGKILL)


def tell_limits(_: Path) -> None:
    names = ("RLIMIT_DATA", "RLIMIT_NOFILE", "RLIMIT_CORE")
    status = Path("/proc/self/status").read_text()
    limits = {name: resource.getrlimit(getattr(resource, name)) for name in names}
    logging.getLogger("recon4.job").info("%s %s", limits, status[status.index("NoNewPrivs") :][:20])


def keep_busy(recording: Path) -> None:
    """All processors, until the test says that it has seen enough."""
    idle = recording / "idle"
    spin = f"import os\nwhile not os.path.exists({str(idle)!r}): pass"
    spinning = [subprocess.Popen([sys.executable, "-c", spin]) for _ in range(os.cpu_count() or 1)]
    _note(recording, "busy")
    for one in spinning:
        one.wait()


def hang_in_python(_: Path) -> None:
    while True:
        pass


def hang_in_c_with_the_gil(_: Path) -> None:
    """No thread of Python runs any more."""
    ctypes.PyDLL(None).pause()


DEEDS = {
    "hang": hang_in_python,
    "hang in C": hang_in_c_with_the_gil,
    "busy": keep_busy,
    "crash": lambda _: os.kill(os.getpid(), signal.SIGSEGV),
    "memory": take_memory,
    "full": fill_disk,
    "child": leave_a_child,
    "limits": tell_limits,
}
"""Word written to the gate -> what happens to the worker, which gets the recording."""


def work(folder: JobFolder, progress: Progress) -> None:
    request = folder.request()
    root, inputs = request.project, request.inputs
    with titled(root, inputs.title):
        _process(root, Path(inputs.recordings[0]), progress)


def _process(root: Path, recording: Path, progress: Progress) -> None:
    if recording.is_file():
        raise EmptyRecording(f"{recording.name} holds no points; record again")
    with Project.open(root) as project:
        runner = StageRunner(project, Settings(), progress)
        given = Input(str(recording), recording)
        frames = runner.run(Stage("frames", 1, ReadsNothing, _frames), recording=given)
        runner.run(Stage("odometry", 1, ReadsNothing, _odometry), recording=given, frames=frames)
    (root / "summary.json").write_text("{}")


def _frames(context: StageContext, *, recording: Path) -> None:
    _note(recording, "frames")
    context.progress.start("Reading", 10, "frames")
    context.progress.advance(10)
    (context.out / "report.json").write_text("{}")


def _odometry(context: StageContext, *, recording: Path, frames: Path) -> None:
    _note(recording, "odometry")
    context.progress.start("Odometry", 100, "multiframes")
    gate = os.open(recording / "gate", os.O_RDWR)
    while not select.select([gate], [], [], 0.02)[0]:
        context.progress.advance(0)
    word = os.read(gate, 100).decode()
    os.close(gate)
    DEEDS.get(word, lambda _: None)(recording)
    context.progress.advance(100)
    _note(recording, "finished")
    (context.out / "done.txt").write_text("done")


def _note(recording: Path, what: str) -> None:
    with (recording / "ran").open("a") as file:
        file.write(f"{what}\n")


def policy(folder: JobFolder) -> Policy:
    """It also starts processes, and notes in the recording what it did."""
    recordings = [Path(path) for path in folder.request().inputs.recordings]
    return replace(worker_policy(folder), processes=True).adding(write=recordings)


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), work, policy))
